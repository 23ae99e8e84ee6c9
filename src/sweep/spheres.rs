//! The figures of one AFU that was sent spheres.

use serde::{Deserialize, Serialize};

use super::Size;
use crate::afu::Predicted;
use crate::config::Config;
use crate::report::table::{figure, grouped};
use crate::synth::Area;
use crate::verify::SpheresVerdict;

/// The figures of one AFU that was sent spheres. The columns of the CSV and the keys of the JSON are these fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpheresRow {
    /// Boxes of spheres that are compared in a cycle.
    pub lanes: u32,
    /// Kernels that decide candidates.
    pub deciders: u32,
    /// Bits of each number of a box.
    pub box_bits: u32,
    /// SCPUs that compute contacts; `None` if only the numbers of the spheres come back.
    pub scpus: Option<u32>,
    /// Cycles from one contact to the next in one SCPU, likewise.
    pub interval: Option<u32>,
    /// Spheres sent.
    pub spheres: u64,
    /// Pairs whose boxes meet.
    pub candidates: u64,
    /// Pairs that touch.
    pub contacts: u64,
    /// Contacts that differ from those of the software.
    pub mismatches: u64,
    /// Checks that failed.
    #[serde(rename = "unmet")]
    pub failed_checks: u64,
    /// Clock cycles from start to done.
    pub cycles: u64,
    /// Clock cycles per sphere; `None` without spheres.
    pub cycles_per_sphere: Option<f64>,
    /// Nanoseconds per sphere at the clock, likewise.
    pub ns_per_sphere: Option<f64>,
    /// Candidates per sphere, likewise.
    pub candidates_per_sphere: Option<f64>,
    /// Throughput as a share of the link limit, 0 to 1.
    pub efficiency: Option<f64>,
    /// Bytes of the lines read.
    pub bytes_read: u64,
    /// Bytes of the lines written.
    pub bytes_written: u64,
    /// Clock cycles that the cycle model predicts over the same link.
    pub predicted_cycles: u64,
    /// The stage that the model finds slowest.
    pub slowest_stage: String,
    /// The clock, MHz.
    pub clock_mhz: f64,
    /// LUTs of the whole AFU on an ECP5 as Yosys counts them; `None` if they were not counted.
    #[serde(default)]
    pub luts: Option<u64>,
    /// Flip-flops, likewise.
    #[serde(default)]
    pub ffs: Option<u64>,
    /// Multiplier blocks, likewise.
    #[serde(default)]
    pub dsps: Option<u64>,
    /// Block memories, likewise.
    #[serde(default)]
    pub brams: Option<u64>,
    /// SHA-256 of the Verilog.
    pub rtl_sha256: String,
}

impl SpheresRow {
    /// The row of a job with this verdict, for which the model says this.
    pub(super) fn of(config: &Config, rtl_sha256: &str, verdict: &SpheresVerdict, predicted: &Predicted) -> Self {
        let Size { scpus, interval, .. } = Size::of(config);
        let (outcome, search) = (&verdict.outcome, &config.search);
        let candidates = u64::from(outcome.candidates.unwrap_or_default());
        let each = |value: f64| (verdict.spheres > 0).then(|| value / verdict.spheres as f64);
        Self {
            lanes: search.lanes,
            deciders: search.deciders,
            box_bits: search.box_bits,
            scpus,
            interval,
            spheres: verdict.spheres,
            candidates,
            contacts: outcome.contacts.into(),
            mismatches: verdict.mismatches,
            failed_checks: verdict.failed_checks.len() as u64,
            cycles: outcome.cycles,
            cycles_per_sphere: each(outcome.cycles as f64),
            ns_per_sphere: each(outcome.cycles as f64 * config.cycle_ns()),
            candidates_per_sphere: each(candidates as f64),
            efficiency: (outcome.cycles > 0).then(|| outcome.efficiency()),
            bytes_read: outcome.bytes_read,
            bytes_written: outcome.bytes_written,
            predicted_cycles: predicted.cycles,
            slowest_stage: predicted.slowest().to_owned(),
            clock_mhz: config.clock_mhz,
            luts: None,
            ffs: None,
            dsps: None,
            brams: None,
            rtl_sha256: rtl_sha256.to_owned(),
        }
    }

    /// What distinguishes the AFU from the others of its sweep.
    pub fn size(&self) -> Size {
        Size {
            lanes: Some(self.lanes),
            deciders: Some(self.deciders),
            box_bits: Some(self.box_bits),
            scpus: self.scpus,
            interval: self.interval,
        }
    }

    /// The row with the area of the AFU.
    pub(super) fn with_area(self, area: Area) -> Self {
        let Area { luts, ffs, dsps, brams } = area;
        Self { luts: Some(luts), ffs: Some(ffs), dsps: Some(dsps), brams: Some(brams), ..self }
    }

    /// Whether there was neither a mismatch nor a failed check.
    pub fn passed(&self) -> bool {
        self.mismatches == 0 && self.failed_checks == 0
    }

    /// The heading of the table, in the terminal and on the page.
    pub(super) const HEADING: [&'static str; 18] = [
        "lanes",
        "deciders",
        "bits",
        "SCPUs",
        "interval",
        "candidates",
        "contacts",
        "mismatches",
        "cycles",
        "model",
        "slowest",
        "per sphere",
        "ns per sphere",
        "of link limit",
        "LUT",
        "FF",
        "DSP",
        "block RAM",
    ];

    /// The row of that table.
    pub(super) fn cells(&self) -> [String; 18] {
        let count = |count: Option<u64>| count.map_or_else(|| "-".to_owned(), grouped);
        [
            self.lanes.to_string(),
            self.deciders.to_string(),
            self.box_bits.to_string(),
            count(self.scpus.map(u64::from)),
            count(self.interval.map(u64::from)),
            grouped(self.candidates),
            grouped(self.contacts),
            grouped(self.mismatches),
            grouped(self.cycles),
            grouped(self.predicted_cycles),
            self.slowest_stage.clone(),
            figure(self.cycles_per_sphere, 3),
            figure(self.ns_per_sphere, 2),
            self.efficiency.map_or_else(|| "-".to_owned(), |share| format!("{:.1} %", 100.0 * share)),
            count(self.luts),
            count(self.ffs),
            count(self.dsps),
            count(self.brams),
        ]
    }
}

#[cfg(test)]
impl SpheresRow {
    /// A row for tests: 100 spheres in 400 cycles.
    pub(super) fn example(lanes: u32, box_bits: u32, candidates: u64) -> Self {
        Self {
            lanes,
            deciders: 4,
            box_bits,
            scpus: None,
            interval: None,
            spheres: 100,
            candidates,
            contacts: 30,
            mismatches: 0,
            failed_checks: 0,
            cycles: 400,
            cycles_per_sphere: Some(4.0),
            ns_per_sphere: Some(20.0),
            candidates_per_sphere: Some(candidates as f64 / 100.0),
            efficiency: Some(0.5),
            bytes_read: 1600,
            bytes_written: 128,
            predicted_cycles: 200,
            slowest_stage: "near".to_owned(),
            clock_mhz: 200.0,
            luts: None,
            ffs: None,
            dsps: None,
            brams: None,
            rtl_sha256: String::new(),
        }
    }
}
