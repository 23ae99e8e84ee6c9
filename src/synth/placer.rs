//! The placers of nextpnr.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::{Target, floorplan};

/// How nextpnr places cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Placer {
    /// HeAP: wires as springs, with weights by timing; nextpnr's own choice.
    #[default]
    Heap,
    /// Cells as charges that spread over the device. Wires are shorter, which helps a large design.
    Static,
    /// The same, with sites for multiplier blocks and block memories that are chosen before, by how data flow between
    /// them. The sites of the ECP5 are known; for another family it is `static`.
    Floorplan,
}

/// A name that is not one of a [`Placer`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown placer `{0}`: use heap, static, floorplan")]
pub struct PlacerError(String);

impl Placer {
    /// All placers.
    pub const ALL: [Self; 3] = [Self::Heap, Self::Static, Self::Floorplan];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Heap => "heap",
            Self::Static => "static",
            Self::Floorplan => "floorplan",
        }
    }

    /// False for a floorplan if the sites of the family's device are not known.
    pub fn serves(self, target: Target) -> bool {
        self != Self::Floorplan || floorplan::knows(target)
    }

    /// nextpnr's options for it. Those of its own choice are left out, so routes that are kept stay valid.
    pub(super) const fn options(self) -> &'static [&'static str] {
        match self {
            Self::Heap => &[],
            Self::Static | Self::Floorplan => &["--placer", "static"],
        }
    }
}

impl fmt::Display for Placer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Placer {
    type Err = PlacerError;

    fn from_str(text: &str) -> Result<Self, PlacerError> {
        Self::ALL.into_iter().find(|placer| placer.name() == text).ok_or_else(|| PlacerError(text.to_owned()))
    }
}
