//! What a simulated job came to: counts that add up over jobs, and the figures that follow from them.

use serde::{Deserialize, Serialize};

use crate::config::Config;
use crate::query::Flow;
use crate::verify::Verdict;

/// Contacts and others, as the AFU's own flags tell them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Flows {
    /// No contact (Flow 1).
    pub fake: u64,
    /// Contacts of coincident centres (Flow 2).
    #[serde(rename = "grazing")]
    pub coincident: u64,
    /// Contacts with a normal of their own (Flow 3).
    pub real: u64,
    /// Not pairs of spheres.
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
    /// What came back.
    pub flows: Flows,
    /// Pairs that the AFU left to the host, which settled them: their flows are the host's.
    pub unsettled: u64,
    /// Records that differ from the reference kernel's.
    pub mismatches: u64,
    /// Clock cycles from start to done.
    pub cycles: u64,
    /// The fewest cycles in which the link can carry the lines that went over it.
    pub limit_cycles: f64,
    /// Cycles from the first line of pairs to the first line of contacts; of several jobs, the first one's.
    pub latency_cycles: Option<u64>,
    /// Bytes of the lines read.
    pub bytes_read: u64,
    /// Bytes of the lines written.
    pub bytes_written: u64,
    /// Seconds the simulation took.
    pub host_seconds: f64,
}

impl Tally {
    /// Of a job through an AFU of this configuration.
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

    /// Both together.
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

    /// The link limit, cycles per pair.
    pub(crate) fn limit_per_pair(&self) -> Option<f64> {
        per(self.limit_cycles, self.pairs)
    }

    /// Bytes read a pair: of the lines, so what the last one has over counts.
    pub(crate) fn read_per_pair(&self) -> Option<f64> {
        per(self.bytes_read as f64, self.pairs)
    }

    /// Bytes written a pair.
    pub(crate) fn written_per_pair(&self) -> Option<f64> {
        per(self.bytes_written as f64, self.pairs)
    }

    /// The share of the link's limit that was reached, 0 to 1.
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
    fn a_job_of_no_pairs_has_no_figures_a_pair() {
        let none = Tally { cycles: 12, ..Tally::default() };
        assert_eq!((none.cycles_per_pair(), none.limit_per_pair(), none.efficiency()), (None, None, None));
        let some = Tally { pairs: 100, cycles: 88, limit_cycles: 50.0, ..Tally::default() };
        assert_eq!(none.plus(&some).cycles_per_pair(), Some(1.0));
        assert_eq!(some.plus(&none).efficiency(), Some(0.5));
    }
}
