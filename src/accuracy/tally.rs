//! Counts of judgements.

use super::Judgement;
use serde::{Deserialize, Serialize};

/// Counts of wrong answers by kind, and the largest errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// The number of pairs answered.
    pub pairs: u64,
    /// The number of pairs that really touch.
    pub contacts: u64,
    /// Contacts not found.
    pub missed: u64,
    /// False positives.
    #[serde(rename = "false")]
    pub false_hits: u64,
    /// Answers with an infinity or a NaN where the truth is finite.
    pub non_finite: u64,
    /// Answers whose normal is not a unit vector.
    pub normal: u64,
    /// Answers whose normal has a wrong direction.
    pub direction: u64,
    /// Answers with a wrong depth.
    pub depth: u64,
    /// Answers with a wrong position.
    pub position: u64,
    /// Gross failures. The key in JSON keeps its old name until the schema changes.
    #[serde(rename = "BAD")]
    pub bad: u64,
    /// Pairs that the engine's own arithmetic did not decide.
    pub unsettled: u64,
    /// The largest finite error of a depth, in its units in the last place of binary32.
    pub depth_ulps: f64,
    /// The largest finite error of a normal's component, in units of 1.
    pub normal_ulps: f64,
    /// The largest finite error of a position's component, in units of the largest number that it is computed from.
    pub position_ulps: f64,
}

impl Tally {
    /// Counts one more judgement of a pair, which touches or not.
    pub fn add(&mut self, is_contact: bool, found: &Judgement) {
        let Judgement { missed, false_hit, non_finite, normal, direction, depth, position, bad, unsettled, .. } =
            *found;
        let wrong = [missed, false_hit, non_finite, normal, direction, depth, position, bad, unsettled];
        for (count, counts) in self.each().into_iter().zip([true, is_contact].into_iter().chain(wrong)) {
            *count += u64::from(counts);
        }
        self.raise(found.ulps.map(|ulps| if ulps.is_finite() { ulps } else { 0.0 }));
    }

    /// The sum of both. Counts saturate, because a file of results may contain any number.
    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        for (count, more) in self.each().into_iter().zip(other.counts()) {
            *count = count.saturating_add(more);
        }
        self.raise([other.depth_ulps, other.normal_ulps, other.position_ulps]);
        self
    }

    fn raise(&mut self, [depth, normal, position]: [f64; 3]) {
        self.depth_ulps = self.depth_ulps.max(depth);
        self.normal_ulps = self.normal_ulps.max(normal);
        self.position_ulps = self.position_ulps.max(position);
    }

    /// The pairs, the contacts, and the counts in the order of [`Tally::HEADING`].
    pub fn counts(&self) -> [u64; 11] {
        { *self }.each().map(|count| *count)
    }

    fn each(&mut self) -> [&mut u64; 11] {
        let Self { pairs, contacts, missed, false_hits, non_finite, normal, direction, depth, position, .. } = self;
        let Self { bad, unsettled, .. } = self;
        [pairs, contacts, missed, false_hits, non_finite, normal, direction, depth, position, bad, unsettled]
    }

    /// Names of the counts that follow those of pairs and contacts.
    pub const HEADING: [&'static str; 9] =
        ["missed", "false", "non-finite", "normal", "direction", "depth", "position", "gross", "unsettled"];
}
