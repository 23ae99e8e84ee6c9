//! What an engine says of a pair, in numbers wide enough for any of them.

use crate::query::ContactRecord;

/// An engine's answer to a pair. Without a hit its numbers mean nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// Whether the bodies touch.
    pub hit: bool,
    /// Where.
    pub position: [f64; 3],
    /// The direction that parts them, pointing into the first.
    pub normal: [f64; 3],
    /// How deep they overlap.
    pub depth: f64,
    /// Whether the engine's own arithmetic did not settle the pair, so that this answer was had otherwise.
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
