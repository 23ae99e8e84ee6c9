//! The FPGA families, and how designs are synthesised for each.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::Area;
use crate::afu::Spec;
use crate::hdl::verilog::Memories;
use crate::hdl::{DelayModel, Primitive};

/// An FPGA family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Target {
    /// Lattice ECP5: placed and routed in an LFE5U-85F, speed grade 8.
    Ecp5,
    /// Lattice iCE40: placed and routed in an HX8K if nextpnr-ice40 is installed.
    Ice40,
    /// Intel Cyclone V: counted only.
    Cyclonev,
    /// AMD 7 series: counted only.
    Xilinx,
}

/// A name that is not one of a [`Target`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown target `{0}`: use ecp5, ice40, cyclonev, xilinx")]
pub struct TargetError(String);

impl Target {
    /// All targets.
    pub const ALL: [Self; 4] = [Self::Ecp5, Self::Ice40, Self::Cyclonev, Self::Xilinx];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ecp5 => "ecp5",
            Self::Ice40 => "ice40",
            Self::Cyclonev => "cyclonev",
            Self::Xilinx => "xilinx",
        }
    }

    /// The Yosys command that maps to the family.
    pub(super) const fn synthesis(self) -> &'static str {
        match self {
            Self::Ecp5 => "synth_ecp5",
            Self::Ice40 => "synth_ice40",
            Self::Cyclonev => "synth_intel_alm -family cyclonev",
            Self::Xilinx => "synth_xilinx -family xc7",
        }
    }

    /// nextpnr's name for the architecture and the options of the device; `None` if the family cannot be routed.
    pub(crate) const fn router(self) -> Option<(&'static str, &'static [&'static str])> {
        match self {
            Self::Ecp5 => {
                Some(("ecp5", &["--85k", "--speed", "8", "--package", "CABGA381", "--lpf-allow-unconstrained"]))
            }
            Self::Ice40 => Some(("ice40", &["--hx8k", "--package", "ct256", "--pcf-allow-unconstrained"])),
            Self::Cyclonev | Self::Xilinx => None,
        }
    }

    /// The resources of the device that is routed for, if SCPUs fit in it: those of the LFE5U-85F, by its data sheet.
    pub const fn capacity(self) -> Option<Area> {
        match self {
            Self::Ecp5 => Some(Area { luts: 83_640, ffs: 83_640, dsps: 156, brams: 208 }),
            Self::Ice40 | Self::Cyclonev | Self::Xilinx => None,
        }
    }

    /// The delay of each operation, and how multiplier blocks are written. The model of the ECP5 is fitted to its
    /// router. It also serves the other families, whose synthesis finds the registers of multiplier blocks.
    pub fn delays(self) -> DelayModel {
        match self {
            Self::Ecp5 => DelayModel::ecp5()
                .with_registered_multipliers(Some(Primitive::Mult18x18d))
                .with_registered_tables(Some(Primitive::Dp16kd))
                .with_adders(Primitive::Ccu2c),
            Self::Ice40 => DelayModel::ecp5(),
            Self::Cyclonev | Self::Xilinx => DelayModel::default(),
        }
    }

    /// The kinds of memory that the family has.
    pub(super) const fn memories(self) -> Memories {
        match self {
            Self::Ecp5 => Memories::BlocksAndLuts,
            Self::Ice40 => Memories::Blocks,
            Self::Cyclonev | Self::Xilinx => Memories::Any,
        }
    }

    /// An AFU for this family only. `None` if the Verilog would be the same as for any family, because the family has
    /// no delays and no blocks of its own here.
    pub fn specialise(self, spec: Spec) -> Option<Spec> {
        let its = Spec { delays: self.delays(), target: Some(self.name()), memories: self.memories(), ..spec };
        let is_general = its.delays == DelayModel::default() && its.memories == Memories::default();
        (!is_general).then_some(its)
    }

    /// The device, for people.
    pub const fn device(self) -> &'static str {
        match self {
            Self::Ecp5 => "LFE5U-85F speed 8",
            Self::Ice40 => "iCE40 HX8K",
            Self::Cyclonev => "Cyclone V (ALUTs)",
            Self::Xilinx => "7 series",
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Target {
    type Err = TargetError;

    fn from_str(text: &str) -> Result<Self, TargetError> {
        Self::ALL.into_iter().find(|target| target.name() == text).ok_or_else(|| TargetError(text.to_owned()))
    }
}
