//! The figures of one AFU that was sent pairs.

use serde::{Deserialize, Serialize};

use super::Size;
use crate::config::Config;
use crate::report::table::{figure, grouped};
use crate::report::tally::Tally;
use crate::synth::Area;
use crate::verify::Verdict;

/// The figures of one AFU that was sent pairs. The columns of the CSV and the keys of the JSON are these fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairsRow {
    /// Sphere Collision Processing Units.
    pub scpus: u32,
    /// Cycles from one pair to the next in one SCPU.
    pub interval: u32,
    /// Pairs sent.
    pub pairs: u64,
    /// Pairs that touch.
    pub contacts: u64,
    /// Records that differ from the reference kernel's.
    pub mismatches: u64,
    /// Other checks that failed: status, counters, unused bits.
    #[serde(rename = "unmet")]
    pub failed_checks: u64,
    /// Clock cycles from start to done.
    pub cycles: u64,
    /// Clock cycles per pair; `None` without pairs.
    pub cycles_per_pair: Option<f64>,
    /// Pairs per second at the clock.
    pub pairs_per_second: Option<f64>,
    /// Throughput as a share of the link limit, 0 to 1.
    pub efficiency: Option<f64>,
    /// Bytes of the lines read.
    pub bytes_read: u64,
    /// Bytes of the lines written.
    pub bytes_written: u64,
    /// Cycles from the first line of pairs in to the first line of contacts out.
    pub latency_cycles: Option<u64>,
    /// The clock, MHz.
    pub clock_mhz: f64,
    /// LUTs of one SCPU on an ECP5 as Yosys counts them; `None` if they were not counted.
    #[serde(default)]
    pub scpu_luts: Option<u64>,
    /// Flip-flops of one SCPU, likewise.
    #[serde(default)]
    pub scpu_ffs: Option<u64>,
    /// Multiplier blocks of one SCPU, likewise.
    #[serde(default)]
    pub scpu_dsps: Option<u64>,
    /// SHA-256 of the Verilog.
    pub rtl_sha256: String,
}

impl PairsRow {
    /// The row of a job with this verdict.
    pub(super) fn of(config: &Config, rtl_sha256: &str, verdict: &Verdict) -> Self {
        let tally = Tally::of(verdict, config);
        let cycles_per_pair = tally.cycles_per_pair();
        Self {
            scpus: config.scpus,
            interval: config.interval,
            pairs: tally.pairs,
            contacts: tally.flows.contacts(),
            mismatches: tally.mismatches,
            failed_checks: verdict.failed_checks.len() as u64,
            cycles: tally.cycles,
            cycles_per_pair,
            pairs_per_second: cycles_per_pair.map(|cycles| 1e6 * config.clock_mhz / cycles),
            efficiency: tally.efficiency(),
            bytes_read: tally.bytes_read,
            bytes_written: tally.bytes_written,
            latency_cycles: tally.latency_cycles,
            clock_mhz: config.clock_mhz,
            scpu_luts: None,
            scpu_ffs: None,
            scpu_dsps: None,
            rtl_sha256: rtl_sha256.to_owned(),
        }
    }

    /// What distinguishes the AFU from the others of its sweep.
    pub fn size(&self) -> Size {
        Size { scpus: Some(self.scpus), interval: Some(self.interval), ..Size::default() }
    }

    /// The row with the area of one SCPU.
    pub(super) fn with_area(self, area: Area) -> Self {
        let Area { luts, ffs, dsps, .. } = area;
        Self { scpu_luts: Some(luts), scpu_ffs: Some(ffs), scpu_dsps: Some(dsps), ..self }
    }

    /// Whether there was neither a mismatch nor a failed check.
    pub fn passed(&self) -> bool {
        self.mismatches == 0 && self.failed_checks == 0
    }

    /// The heading of the table for people.
    pub(super) const HEADING: [&'static str; 11] = [
        "SCPUs",
        "interval",
        "pairs",
        "mismatches",
        "cycles",
        "cycles per pair",
        "M pairs/s",
        "of link limit",
        "latency, cycles",
        "LUT per SCPU",
        "DSP per SCPU",
    ];

    /// The row of the table for people.
    pub(super) fn cells(&self) -> [String; 11] {
        let count = |count: Option<u64>| count.map_or_else(|| "-".to_owned(), grouped);
        [
            self.scpus.to_string(),
            self.interval.to_string(),
            grouped(self.pairs),
            grouped(self.mismatches),
            grouped(self.cycles),
            figure(self.cycles_per_pair, 3),
            figure(self.pairs_per_second.map(|pairs| pairs / 1e6), 1),
            self.efficiency.map_or_else(|| "-".to_owned(), |share| format!("{:.1} %", 100.0 * share)),
            count(self.latency_cycles),
            count(self.scpu_luts),
            count(self.scpu_dsps),
        ]
    }
}
