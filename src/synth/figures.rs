//! The figures of a unit, as they are in the JSON.

use serde::{Deserialize, Serialize};

use super::{Area, Placer, Target, Trimmed};
use crate::config::Profile;
use crate::operator::Architecture;

/// The schema of the JSON.
pub const SCHEMA: &str = "contact-afu/synth/1";

/// A unit's figures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// [`SCHEMA`].
    pub schema: String,
    /// The version of this crate.
    pub version: String,
    /// The kind of unit, such as `add` or `scpu`.
    pub unit: String,
    /// The arithmetic of the unit.
    pub profile: Profile,
    /// The architecture, if the operator has several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub architecture: Option<Architecture>,
    /// The initiation interval of an SCPU or an AFU, in cycles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<u32>,
    /// The module's name in Verilog.
    pub module: String,
    /// The family.
    pub target: Target,
    /// The placer; `None` if cells were only counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub placer: Option<Placer>,
    /// The clock that stages were cut for, MHz.
    pub asked_mhz: f64,
    /// The clock that the delay model predicts, MHz; `None` if no stages were cut.
    pub modelled_mhz: Option<f64>,
    /// The clock after place and route in MHz, the median over the seeds; `None` if cells were only counted.
    pub clock_mhz: Option<f64>,
    /// Cycles from inputs to outputs; `None` if the unit is not a pipeline.
    pub latency_cycles: Option<u32>,
    /// The same latency in nanoseconds, at [`Figures::clock_mhz`].
    pub latency_ns: Option<f64>,
    /// The area of the unit, without the wrapper's.
    #[serde(flatten)]
    pub area: Area,
    /// The wrapper's own area, which was subtracted.
    pub wrapper: Area,
    /// Registers of the wrapper that synthesis removed: those of unused inputs and of constant outputs.
    pub trimmed: Trimmed,
    /// The run of each seed, in the given order.
    pub seeds: Vec<Seed>,
    /// The critical path between two registers, for the seed with the median clock.
    pub critical: Vec<Hop>,
    /// SHA-256 of the Verilog that was synthesised, wrapper and all.
    pub verilog_sha256: String,
    /// The programs.
    pub tools: Tools,
}

/// A run of the placer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seed {
    /// The seed.
    pub seed: u32,
    /// The clock reached, MHz.
    pub clock_mhz: f64,
}

/// A part of a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hop {
    /// The signal, with the names of its instances, that a cell computes or contributes to.
    pub signal: String,
    /// The stage of the signal, counted from 0.
    pub stage: Option<u32>,
    /// Routing delay to the signal, ns.
    pub routing_ns: f64,
    /// Logic delay, ns.
    pub logic_ns: f64,
}

/// The versions of the programs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tools {
    /// Yosys.
    pub yosys: String,
    /// nextpnr, if it was used.
    pub nextpnr: Option<String>,
}

impl Figures {
    /// True if the requested clock was reached; `None` if cells were only counted.
    pub fn meets(&self) -> Option<bool> {
        self.clock_mhz.map(|clock| clock >= self.asked_mhz)
    }
}
