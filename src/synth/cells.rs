//! Cells by kind, as Yosys counts them, and the area that they take.

use std::collections::BTreeMap;
use std::ops::Sub;

use serde::{Deserialize, Serialize};

use super::Target;

/// The number of cells of each type.
pub(super) type Cells = BTreeMap<String, u64>;

/// The area of a unit on a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Area {
    /// LUTs, including those of carry chains and small memories; ALUTs on Cyclone V.
    pub luts: u64,
    /// Flip-flops.
    pub ffs: u64,
    /// Multiplier blocks.
    pub dsps: u64,
    /// Block memories.
    pub brams: u64,
}

impl Area {
    /// The number of `unit` that fit; the resource that runs out first decides.
    pub fn fits(&self, unit: &Self) -> u64 {
        let pairs = [(self.luts, unit.luts), (self.ffs, unit.ffs), (self.dsps, unit.dsps), (self.brams, unit.brams)];
        pairs.into_iter().filter(|(_, each)| *each > 0).map(|(all, each)| all / each).min().unwrap_or(0)
    }
}

impl Sub for Area {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            luts: self.luts.saturating_sub(other.luts),
            ffs: self.ffs.saturating_sub(other.ffs),
            dsps: self.dsps.saturating_sub(other.dsps),
            brams: self.brams.saturating_sub(other.brams),
        }
    }
}

/// The area of cells after synthesis. LUTs of chains and memories are counted by the number that they occupy.
pub(super) fn area(target: Target, cells: &Cells) -> Area {
    let mut area = Area::default();
    for (name, &count) in cells {
        let is = |prefix: &str| name.starts_with(prefix);
        match target {
            Target::Ecp5 => match name.as_str() {
                "LUT4" => area.luts += count,
                "CCU2C" => area.luts += 2 * count,
                "TRELLIS_DPR16X4" => area.luts += 4 * count,
                "TRELLIS_FF" => area.ffs += count,
                "DP16KD" | "PDPW16KD" => area.brams += count,
                _ if is("MULT") => area.dsps += count,
                _ => {}
            },
            Target::Ice40 => match name.as_str() {
                "SB_LUT4" => area.luts += count,
                "SB_MAC16" => area.dsps += count,
                "SB_RAM40_4K" => area.brams += count,
                _ if is("SB_DFF") => area.ffs += count,
                _ => {}
            },
            Target::Cyclonev => match name.as_str() {
                "MISTRAL_FF" => area.ffs += count,
                "MISTRAL_M10K" => area.brams += count,
                // An inverter is absorbed; an MLAB bit takes a LUT.
                "MISTRAL_MLAB" => area.luts += count,
                _ if is("MISTRAL_ALUT") => area.luts += count,
                _ if is("MISTRAL_MUL") => area.dsps += count,
                _ => {}
            },
            Target::Xilinx => match name.as_str() {
                "LUT1" | "LUT2" | "LUT3" | "LUT4" | "LUT5" | "LUT6" | "SRL16E" | "SRLC32E" => area.luts += count,
                "RAM32M" | "RAM64M" => area.luts += 4 * count,
                "RAM32X1D" | "RAM64X1D" => area.luts += 2 * count,
                "RAM128X1D" => area.luts += 4 * count,
                "FDRE" | "FDSE" | "FDCE" | "FDPE" => area.ffs += count,
                _ if is("DSP48") => area.dsps += count,
                _ if is("RAMB") => area.brams += count,
                _ => {}
            },
        }
    }
    area
}

/// The area of a placed design, from nextpnr's kinds of sites; `None` if a kind is unknown.
pub(super) fn placed(target: Target, used: &Cells) -> Option<Area> {
    let count = |name: &str| used.get(name).copied().unwrap_or(0);
    match target {
        Target::Ecp5 => Some(Area {
            luts: count("TRELLIS_COMB"),
            ffs: count("TRELLIS_FF"),
            dsps: count("MULT18X18D"),
            brams: count("DP16KD"),
        }),
        // A logic cell holds a LUT and a flip-flop: they are counted before placement.
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(list: &[(&str, u64)]) -> Cells {
        list.iter().map(|(name, count)| ((*name).to_owned(), *count)).collect()
    }

    #[test]
    fn what_runs_out_first_decides_how_many_fit() {
        let device = Area { luts: 100, ffs: 100, dsps: 9, brams: 5 };
        assert_eq!(device.fits(&Area { luts: 10, ffs: 20, dsps: 2, brams: 0 }), 4);
        assert_eq!(device.fits(&Area { luts: 60, ffs: 20, dsps: 2, brams: 0 }), 1);
        assert_eq!(device.fits(&Area { luts: 101, ..Area::default() }), 0);
    }

    #[test]
    fn cells_are_counted_by_what_they_occupy() {
        let ecp5 = cells(&[
            ("$scopeinfo", 1),
            ("CCU2C", 65),
            ("LUT4", 526),
            ("PFUMX", 68),
            ("TRELLIS_DPR16X4", 1),
            ("TRELLIS_FF", 508),
            ("MULT18X18D", 4),
            ("DP16KD", 2),
        ]);
        assert_eq!(area(Target::Ecp5, &ecp5), Area { luts: 526 + 130 + 4, ffs: 508, dsps: 4, brams: 2 });
        let cyclone =
            cells(&[("MISTRAL_ALUT6", 10), ("MISTRAL_ALUT_ARITH", 5), ("MISTRAL_FF", 7), ("MISTRAL_MUL27X27", 1)]);
        assert_eq!(area(Target::Cyclonev, &cyclone), Area { luts: 15, ffs: 7, dsps: 1, brams: 0 });
        let xilinx = cells(&[("LUT6", 3), ("CARRY4", 9), ("FDRE", 4), ("DSP48E1", 2), ("RAMB18E1", 1), ("RAM32M", 1)]);
        assert_eq!(area(Target::Xilinx, &xilinx), Area { luts: 7, ffs: 4, dsps: 2, brams: 1 });
        let ice40 = cells(&[("SB_LUT4", 3), ("SB_CARRY", 9), ("SB_DFF", 4), ("SB_DFFE", 2)]);
        assert_eq!(area(Target::Ice40, &ice40), Area { luts: 3, ffs: 6, dsps: 0, brams: 0 });
    }
}
