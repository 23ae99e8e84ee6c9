//! What a simulated job came to: counts that add up over jobs, and the figures that follow from them.

use serde::{Deserialize, Serialize};

use crate::kernel::{ContactRecord, Flow};

/// Contacts and others, as the AFU's own flags tell them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Flows {
    /// No contact (Flow 1).
    pub fake: u64,
    /// Contacts of coincident centres (Flow 2).
    pub grazing: u64,
    /// Contacts with a normal of their own (Flow 3).
    pub real: u64,
    /// Not pairs of spheres.
    pub invalid: u64,
}

impl Flows {
    /// Counts records; flags that are no flow count nowhere (they are mismatches).
    pub fn of(records: &[ContactRecord]) -> Self {
        let count = |flow| records.iter().filter(|record| record.flow() == Some(flow)).count() as u64;
        Self {
            fake: count(Flow::Fake),
            grazing: count(Flow::Grazing),
            real: count(Flow::Real),
            invalid: count(Flow::Invalid),
        }
    }

    /// Pairs that touch.
    pub fn contacts(&self) -> u64 {
        self.grazing + self.real
    }
}

/// Counts of one job, or of several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Pairs sent.
    pub pairs: u64,
    /// What came back.
    pub flows: Flows,
    /// Records that differ from the reference kernel's.
    pub mismatches: u64,
    /// Clock cycles from start to done.
    pub cycles: u64,
    /// Cycles of that in which the link was all that anyone waited for: the least it allows.
    pub limit_cycles: f64,
    /// Bytes of the lines read.
    pub bytes_read: u64,
    /// Bytes of the lines written.
    pub bytes_written: u64,
    /// Seconds the simulation took.
    pub host_seconds: f64,
}

impl Tally {
    /// Both together.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            pairs: self.pairs + other.pairs,
            flows: Flows {
                fake: self.flows.fake + other.flows.fake,
                grazing: self.flows.grazing + other.flows.grazing,
                real: self.flows.real + other.flows.real,
                invalid: self.flows.invalid + other.flows.invalid,
            },
            mismatches: self.mismatches + other.mismatches,
            cycles: self.cycles + other.cycles,
            limit_cycles: self.limit_cycles + other.limit_cycles,
            bytes_read: self.bytes_read + other.bytes_read,
            bytes_written: self.bytes_written + other.bytes_written,
            host_seconds: self.host_seconds + other.host_seconds,
        }
    }

    /// Clock cycles a pair; none without pairs.
    pub fn cycles_per_pair(&self) -> Option<f64> {
        per(self.cycles as f64, self.pairs)
    }

    /// The least number of cycles a pair that the link allows.
    pub fn limit_per_pair(&self) -> Option<f64> {
        per(self.limit_cycles, self.pairs)
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
    fn records_are_counted_by_their_flags() {
        let record = |flags| ContactRecord([0, 0, 0, 0, 0, 0, 0, flags]);
        let flows = Flows::of(&[2, 2, 5, 7, 7, 7, 8, 0, 99].map(record));
        assert_eq!(flows, Flows { fake: 2, grazing: 1, real: 3, invalid: 1 });
        assert_eq!(flows.contacts(), 4);
    }

    #[test]
    fn a_job_of_no_pairs_has_no_figures_a_pair() {
        let none = Tally { cycles: 12, ..Tally::default() };
        assert_eq!((none.cycles_per_pair(), none.limit_per_pair(), none.efficiency()), (None, None, None));
        let some = Tally { pairs: 100, cycles: 88, limit_cycles: 50.0, ..Tally::default() };
        assert_eq!(none.plus(&some).cycles_per_pair(), Some(1.0));
        assert_eq!(some.plus(&none).efficiency(), Some(0.5));
    }
}
