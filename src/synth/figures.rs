//! What came out, as JSON keeps it.

use serde::{Deserialize, Serialize};

use super::{Area, Target, Trimmed};
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
    /// What was measured, as in `add` or `scpu`.
    pub unit: String,
    /// Its arithmetic.
    pub profile: Profile,
    /// Of an operator that has several: its architecture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub architecture: Option<Architecture>,
    /// Of an SCPU or an AFU: cycles from one pair to the next in one SCPU.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<u32>,
    /// The module's name in Verilog.
    pub module: String,
    /// The family.
    pub target: Target,
    /// The clock that stages were cut for, MHz.
    pub asked_mhz: f64,
    /// The clock that the delay model promised, MHz; nothing where no stages were cut.
    pub modelled_mhz: Option<f64>,
    /// The clock after place and route, MHz: the median of the seeds'. Nothing where it was only counted.
    pub clock_mhz: Option<f64>,
    /// Cycles from inputs to outputs; nothing where it is not a pipeline.
    pub latency_cycles: Option<u32>,
    /// The same in nanoseconds, at [`Figures::clock_mhz`].
    pub latency_ns: Option<f64>,
    /// Its area, without the wrapper's.
    #[serde(flatten)]
    pub area: Area,
    /// The wrapper's own area, which was subtracted.
    pub wrapper: Area,
    /// Registers of the wrapper that synthesis removed: those of unused inputs and of constant outputs.
    pub trimmed: Trimmed,
    /// Each seed's run, in the order asked for.
    pub seeds: Vec<Seed>,
    /// The slowest path between two registers, of the seed whose clock is the median.
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
    /// The signal, with the instances it is in: what a cell computes, or contributes to.
    pub signal: String,
    /// The stage it stands in, counted from 0.
    pub stage: Option<u32>,
    /// Time on wires to it, ns.
    pub routing_ns: f64,
    /// Time in cells, ns.
    pub logic_ns: f64,
}

/// What the programs say of themselves.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tools {
    /// Yosys.
    pub yosys: String,
    /// nextpnr, where it was used.
    pub nextpnr: Option<String>,
}

impl Figures {
    /// Whether the clock that was asked for was reached; nothing where it was only counted.
    pub fn meets(&self) -> Option<bool> {
        self.clock_mhz.map(|clock| clock >= self.asked_mhz)
    }
}
