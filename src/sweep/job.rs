//! What every AFU of a sweep is sent.

use crate::query::PairRecord;
use crate::spheres::{Sphere, Spheres};
use crate::store::sha256;

/// What every AFU of a sweep is sent.
#[derive(Clone, Copy, Debug)]
pub enum Job<'a> {
    /// Pairs.
    Pairs(&'a [PairRecord]),
    /// Spheres, among which it finds those that touch.
    Spheres(&'a Spheres),
}

impl Job<'_> {
    /// SHA-256 of all words, in hex: whether a file or a set is still what it was.
    pub(super) fn fingerprint(&self) -> String {
        let bytes: Vec<u8> = match self {
            Self::Pairs(pairs) => pairs.iter().flat_map(|pair| pair.0).flat_map(u32::to_le_bytes).collect(),
            Self::Spheres(sets) => {
                // Where the second set begins counts too.
                let second = sets.second.as_ref().map(|_| (sets.first.len() as u64).to_le_bytes());
                let all = sets.first.iter().chain(sets.second.iter().flatten());
                let words = all.flat_map(|Sphere(words)| *words).flat_map(u32::to_le_bytes);
                words.chain(second.into_iter().flatten()).collect()
            }
        };
        sha256(&bytes)
    }
}
