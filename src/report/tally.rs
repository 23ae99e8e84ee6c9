//! The counts of a simulated job, which add up over jobs, and the figures derived from them.

use serde::{Deserialize, Serialize};

use crate::config::Config;
use crate::query::Flow;
use crate::verify::Verdict;

/// The number of pairs of each kind, by the flags that the AFU wrote.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Flows {
    /// No contact (Flow 1).
    pub fake: u64,
    /// Contacts of coincident centres (Flow 2).
    #[serde(rename = "grazing")]
    pub coincident: u64,
    /// Contacts with a defined normal (Flow 3).
    pub real: u64,
    /// Invalid pairs: an infinity, a NaN or a negative radius.
    pub invalid: u64,
}

impl Flows {
    /// Pairs that touch.
    pub fn contacts(&self) -> u64 {
        self.coincident + self.real
    }
}

/// Counts of one job, or of several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Pairs sent.
    pub pairs: u64,
    /// The pairs by kind.
    pub flows: Flows,
    /// Pairs that the AFU left unsettled. The host resolved them, and `flows` counts its answers.
    pub unsettled: u64,
    /// Records that differ from the reference kernel's.
    pub mismatches: u64,
    /// Clock cycles from start to done.
    pub cycles: u64,
    /// The link limit: the minimum number of cycles for the lines that were transferred.
    pub limit_cycles: f64,
    /// Cycles from the first line of pairs to the first line of contacts. Of several jobs, the first one's.
    pub latency_cycles: Option<u64>,
    /// Bytes of the lines read.
    pub bytes_read: u64,
    /// Bytes of the lines written.
    pub bytes_written: u64,
    /// Seconds of simulation.
    pub host_seconds: f64,
}

impl Tally {
    /// The counts of a job on an AFU with this configuration.
    pub fn of(verdict: &Verdict, config: &Config) -> Self {
        let flows = verdict.flows(config);
        let of = |flow: Flow| flows[flow as usize];
        let outcome = &verdict.outcome;
        Self {
            pairs: verdict.pairs as u64,
            flows: Flows {
                fake: of(Flow::Fake),
                coincident: of(Flow::Coincident),
                real: of(Flow::Real),
                invalid: of(Flow::Invalid),
            },
            unsettled: verdict.unsettled,
            mismatches: verdict.mismatches.len() as u64,
            cycles: outcome.cycles,
            limit_cycles: outcome.limit_cycles,
            latency_cycles: outcome.latency_cycles,
            bytes_read: outcome.bytes_read,
            bytes_written: outcome.bytes_written,
            host_seconds: verdict.seconds,
        }
    }

    /// The sum of both.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            pairs: self.pairs + other.pairs,
            flows: Flows {
                fake: self.flows.fake + other.flows.fake,
                coincident: self.flows.coincident + other.flows.coincident,
                real: self.flows.real + other.flows.real,
                invalid: self.flows.invalid + other.flows.invalid,
            },
            unsettled: self.unsettled + other.unsettled,
            mismatches: self.mismatches + other.mismatches,
            cycles: self.cycles + other.cycles,
            limit_cycles: self.limit_cycles + other.limit_cycles,
            latency_cycles: self.latency_cycles.or(other.latency_cycles),
            bytes_read: self.bytes_read + other.bytes_read,
            bytes_written: self.bytes_written + other.bytes_written,
            host_seconds: self.host_seconds + other.host_seconds,
        }
    }

    /// Clock cycles per pair; `None` without pairs.
    pub fn cycles_per_pair(&self) -> Option<f64> {
        per(self.cycles as f64, self.pairs)
    }

    /// The link limit in cycles per pair; `None` without pairs.
    pub(crate) fn limit_per_pair(&self) -> Option<f64> {
        per(self.limit_cycles, self.pairs)
    }

    /// Bytes read per pair. Whole lines count, so the padding of the last line is included.
    pub(crate) fn read_per_pair(&self) -> Option<f64> {
        per(self.bytes_read as f64, self.pairs)
    }

    /// Bytes written per pair, with the padding of the last line.
    pub(crate) fn written_per_pair(&self) -> Option<f64> {
        per(self.bytes_written as f64, self.pairs)
    }

    /// Throughput as a share of the link limit, 0 to 1; `None` without pairs.
    pub fn efficiency(&self) -> Option<f64> {
        (self.pairs > 0 && self.cycles > 0).then(|| self.limit_cycles / self.cycles as f64)
    }
}

fn per(amount: f64, pairs: u64) -> Option<f64> {
    (pairs > 0).then(|| amount / pairs as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_job_without_pairs_has_no_figures_per_pair() {
        let none = Tally { cycles: 12, ..Tally::default() };
        assert_eq!((none.cycles_per_pair(), none.limit_per_pair(), none.efficiency()), (None, None, None));
        let some = Tally { pairs: 100, cycles: 88, limit_cycles: 50.0, ..Tally::default() };
        assert_eq!(none.plus(&some).cycles_per_pair(), Some(1.0));
        assert_eq!(some.plus(&none).efficiency(), Some(0.5));
    }
}
