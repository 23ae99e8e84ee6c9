//! The answer of an engine to a pair, in numbers wide enough for every engine.

use crate::query::ContactRecord;

/// An engine's answer to a pair. Without a hit, its numbers are meaningless.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// True if the bodies touch.
    pub hit: bool,
    /// The position.
    pub position: [f64; 3],
    /// The direction in which they separate, pointing into the first.
    pub normal: [f64; 3],
    /// The depth of the overlap.
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
