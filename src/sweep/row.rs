//! One AFU's figures, whatever it was sent.

use serde::{Deserialize, Serialize};

use super::{PairsRow, Size, SpheresRow};
use crate::synth::Area;

/// A simulated AFU, as the store keeps it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Simulated {
    /// Its figures, without area.
    pub row: Row,
    /// What they took on the machine that simulated: no two runs are alike in this.
    pub host: HostSeconds,
}

/// What an AFU took on the machine that simulated it. It begins with the fields of its [`Size`], as columns of a CSV.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HostSeconds {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lanes: Option<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    deciders: Option<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    box_bits: Option<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scpus: Option<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    interval: Option<u32>,
    /// Seconds to build the model. They include Verilator's runtime only if the user's folder did not have it yet.
    build_seconds: f64,
    /// Seconds of the simulation.
    simulation_seconds: f64,
}

impl HostSeconds {
    pub fn new(size: Size, build_seconds: f64, simulation_seconds: f64) -> Self {
        let Size { lanes, deciders, box_bits, scpus, interval } = size;
        Self { lanes, deciders, box_bits, scpus, interval, build_seconds, simulation_seconds }
    }
}

/// One AFU's figures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Row {
    /// Of an AFU that was sent pairs.
    Pairs(PairsRow),
    /// Of one that was sent spheres.
    Spheres(SpheresRow),
}

impl Row {
    /// What distinguishes the AFU from the others of its sweep.
    pub fn size(&self) -> Size {
        match self {
            Self::Pairs(row) => row.size(),
            Self::Spheres(row) => row.size(),
        }
    }

    /// Whether there was neither a mismatch nor a failed check.
    pub fn passed(&self) -> bool {
        match self {
            Self::Pairs(row) => row.passed(),
            Self::Spheres(row) => row.passed(),
        }
    }

    /// The row with an area, if that is known: of one SCPU, or of the whole AFU that is sent spheres.
    pub(super) fn with_area(self, area: Option<Area>) -> Self {
        match (self, area) {
            (Self::Pairs(row), Some(area)) => Self::Pairs(row.with_area(area)),
            (Self::Spheres(row), Some(area)) => Self::Spheres(row.with_area(area)),
            (row, None) => row,
        }
    }

    /// The row of the table for people.
    pub(super) fn cells(&self) -> Vec<String> {
        match self {
            Self::Pairs(row) => row.cells().to_vec(),
            Self::Spheres(row) => row.cells().to_vec(),
        }
    }
}
