//! Whatever finds the spheres that touch: software here, an AFU behind its host elsewhere.

use super::{Hit, Search, Spheres};
use crate::kernel::{Engine, EngineError};

/// Finds the spheres that touch, and computes their contacts.
pub trait Finder {
    /// Every two spheres that touch, in the order of [`Candidates::pairs`](super::Candidates::pairs).
    ///
    /// # Errors
    /// Returns an error if a device fails, or is not to be trusted.
    fn find(&mut self, sets: &Spheres) -> Result<Vec<Hit>, EngineError>;
}

/// A search in software, with an engine that decides.
#[derive(Clone, Debug)]
pub struct Decided<E> {
    /// The search.
    pub search: Search,
    /// The engine, whose arithmetic is that of the search.
    pub engine: E,
}

impl<E: Engine> Finder for Decided<E> {
    fn find(&mut self, sets: &Spheres) -> Result<Vec<Hit>, EngineError> {
        Ok(self.search.find(&mut self.engine, &sets.first, sets.second.as_deref())?.hits)
    }
}
