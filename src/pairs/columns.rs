//! The numbers of a record in a file: a pair of some query, or a sphere.

use crate::query::{PAIR_WORDS, Query};

/// A record as words, in the order of its columns. Words behind its last column are zero.
pub type Words = [u32; PAIR_WORDS];

/// What the columns of a file are.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// The name of a record in messages.
    pub record: &'static str,
    /// The query whose words these are.
    query: Query,
    /// How many of its words.
    count: usize,
    /// The names, if they are not those of the query.
    names: Option<&'static [&'static str]>,
    /// How many bodies of equally many words a record has: an npy file may have an index for them.
    pub bodies: usize,
}

impl Columns {
    /// A sphere alone.
    pub const SPHERE: Self =
        Self { record: "sphere", query: Query::SphereSphere, count: 4, names: Some(&["x", "y", "z", "r"]), bodies: 1 };

    /// A pair of this query.
    pub fn of(query: Query) -> Self {
        let bodies = if query == Query::SphereSphere { 2 } else { 1 };
        Self { record: "pair", query, count: query.shape().inputs.len(), names: None, bodies }
    }

    /// The number of columns.
    pub fn len(self) -> usize {
        self.count
    }

    /// The names, in order: the header of a CSV file.
    pub fn names(self) -> impl Iterator<Item = &'static str> + Clone {
        let inputs = self.query.shape().inputs[..self.count].iter().enumerate();
        inputs.map(move |(place, input)| self.names.map_or(input.name, |names| names[place]))
    }
}
