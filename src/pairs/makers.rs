//! The functions that make pairs of each query.

use super::hard::{self, Category};
use super::source::Source;
use super::{random, sphere_plane};
use crate::query::{PairRecord, Query};

/// The functions that make the pairs of a query.
pub(super) struct Makers {
    /// For random pairs: function i mod n makes pair i.
    pub random: &'static [fn(&mut Source) -> PairRecord],
    /// For hard pairs, likewise.
    pub hard: &'static [Category],
}

/// The one place that knows which file makes a query's pairs.
pub(super) const fn of(query: Query) -> Makers {
    match query {
        Query::SphereSphere => Makers { random: &random::KINDS, hard: &hard::CATEGORIES },
        Query::SpherePlane => Makers { random: &sphere_plane::KINDS, hard: &sphere_plane::CATEGORIES },
    }
}

/// The hard categories of a query, each in turn.
pub fn categories(query: Query) -> &'static [Category] {
    of(query).hard
}
