//! Judgements, counted.

use super::Judgement;
use serde::{Deserialize, Serialize};

/// How many answers were wrong in which way, and the largest errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// Pairs answered.
    pub pairs: u64,
    /// Pairs that truly touch.
    pub contacts: u64,
    /// Contacts not found.
    pub missed: u64,
    /// Contacts that are none.
    #[serde(rename = "false")]
    pub false_hits: u64,
    /// Answers with an infinity or a NaN where the truth is finite.
    pub non_finite: u64,
    /// Answers whose normal is no unit vector.
    pub normal: u64,
    /// Answers whose normal points elsewhere.
    pub direction: u64,
    /// Answers with a wrong depth.
    pub depth: u64,
    /// Answers with a wrong position.
    pub position: u64,
    /// Gross failures.
    #[serde(rename = "BAD")]
    pub bad: u64,
    /// Pairs that the engine's own arithmetic did not settle.
    pub unsettled: u64,
    /// The largest finite error of a depth, in its units in the last place of binary32.
    pub depth_ulps: f64,
    /// The largest finite error of a normal's component, in units of 1.
    pub normal_ulps: f64,
    /// The largest finite error of a position's component, in units of what makes it.
    pub position_ulps: f64,
}

impl Tally {
    /// Counts one more judgement, of a pair that touches or not.
    pub fn add(&mut self, is_contact: bool, found: &Judgement) {
        self.pairs += 1;
        self.contacts += u64::from(is_contact);
        for (count, counts) in [
            (&mut self.missed, found.missed),
            (&mut self.false_hits, found.false_hit),
            (&mut self.non_finite, found.non_finite),
            (&mut self.normal, found.normal),
            (&mut self.direction, found.direction),
            (&mut self.depth, found.depth),
            (&mut self.position, found.position),
            (&mut self.bad, found.bad),
            (&mut self.unsettled, found.unsettled),
        ] {
            *count += u64::from(counts);
        }
        let [depth, normal, position] = found.ulps.map(|ulps| if ulps.is_finite() { ulps } else { 0.0 });
        self.raise([depth, normal, position]);
    }

    /// Both together. Counts end at the largest number: a file of results may say anything.
    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        self.pairs = self.pairs.saturating_add(other.pairs);
        self.contacts = self.contacts.saturating_add(other.contacts);
        self.missed = self.missed.saturating_add(other.missed);
        self.false_hits = self.false_hits.saturating_add(other.false_hits);
        self.non_finite = self.non_finite.saturating_add(other.non_finite);
        self.normal = self.normal.saturating_add(other.normal);
        self.direction = self.direction.saturating_add(other.direction);
        self.depth = self.depth.saturating_add(other.depth);
        self.position = self.position.saturating_add(other.position);
        self.bad = self.bad.saturating_add(other.bad);
        self.unsettled = self.unsettled.saturating_add(other.unsettled);
        self.raise([other.depth_ulps, other.normal_ulps, other.position_ulps]);
        self
    }

    fn raise(&mut self, [depth, normal, position]: [f64; 3]) {
        self.depth_ulps = self.depth_ulps.max(depth);
        self.normal_ulps = self.normal_ulps.max(normal);
        self.position_ulps = self.position_ulps.max(position);
    }

    /// The counts, in the order of [`Tally::HEADING`].
    pub fn counts(&self) -> [u64; 9] {
        [
            self.missed,
            self.false_hits,
            self.non_finite,
            self.normal,
            self.direction,
            self.depth,
            self.position,
            self.bad,
            self.unsettled,
        ]
    }

    /// What the counts are of.
    pub const HEADING: [&'static str; 9] =
        ["missed", "false", "non-finite", "normal", "direction", "depth", "position", "BAD", "unsettled"];
}
