//! What a study measures.

use super::Failed;
use crate::store::{Key, sha256};

/// A point of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// What people call it.
    pub title: String,
    /// The key of its measurement.
    pub key: Key,
    /// The hash that decides its shard.
    pub(super) part: String,
}

impl Point {
    /// A point whose key decides its shard.
    pub fn new(title: String, key: Key) -> Self {
        let part = key.hash();
        Self { title, key, part }
    }

    /// The same point in the shard of `content`: points that need each other have the same content.
    #[must_use]
    pub fn beside(self, content: &str) -> Self {
        Self { part: sha256(content.as_bytes()), ..self }
    }
}

/// What became of a point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// It is in the store.
    Made,
    /// It could not be measured.
    Failed(Failed),
    /// Nobody measured it so far.
    Missing,
}

/// An error of a study, which may be a point's own.
pub trait PointError: std::error::Error {
    /// True if the point itself is to blame, so that others may succeed. False if others would fail as well: a tool is
    /// missing, or the disk is full.
    fn is_of_point(&self) -> bool;
}
