//! The answer of an engine to a pair, in numbers that are wide enough for every engine.

use crate::query::ContactRecord;

/// An engine's answer to a pair. Without a hit its numbers mean nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// True if the bodies touch.
    pub hit: bool,
    /// Where.
    pub position: [f64; 3],
    /// The direction that parts them, pointing into the first.
    pub normal: [f64; 3],
    /// How deep they overlap.
    pub depth: f64,
    /// True if the engine's own arithmetic did not decide the pair, so that this answer came from the fallback.
    pub unsettled: bool,
}

impl From<ContactRecord> for Answer {
    fn from(record: ContactRecord) -> Self {
        Self {
            hit: record.is_contact(),
            position: record.position().map(f64::from),
            normal: record.normal().map(f64::from),
            depth: record.depth().into(),
            unsettled: false,
        }
    }
}
