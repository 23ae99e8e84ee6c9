//! A sphere as words.

use crate::query::{Input, PairRecord, Query};

/// The number of words of a sphere.
pub(super) const WORDS: usize = 4;

/// A sphere: x y z and radius as raw binary32 words, the first half of a pair of spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Sphere(pub [u32; WORDS]);

impl Sphere {
    /// The names of the words in files.
    pub const NAMES: [&'static str; WORDS] = ["x", "y", "z", "r"];

    /// The sphere with this centre x y z and radius.
    pub fn new(values: [f32; WORDS]) -> Self {
        Self(values.map(f32::to_bits))
    }

    /// The words read as numbers.
    pub fn values(self) -> [f32; WORDS] {
        self.0.map(f32::from_bits)
    }

    /// The sphere with its centre moved by a distance along each axis. At 0 no word changes.
    #[must_use]
    pub(super) fn moved(self, by: f32) -> Self {
        let [x, y, z, r] = self.values();
        if by == 0.0 { self } else { Self::new([x + by, y + by, z + by, r]) }
    }

    /// True if all numbers are finite and the radius is not below zero (−0 is valid).
    #[inline]
    pub fn is_valid(self) -> bool {
        self.with(Self::default()).is_valid(Query::SphereSphere)
    }

    /// The name of the first word that breaks its rule.
    pub fn broken(self) -> Option<&'static str> {
        Self::rules().zip(self.0).zip(Self::NAMES).find(|((input, word), _)| !input.rule.holds(*word)).map(|(_, n)| n)
    }

    /// The pair of this sphere and another one.
    #[inline]
    pub fn with(self, second: Self) -> PairRecord {
        let mut pair = PairRecord::default();
        pair.0[..WORDS].copy_from_slice(&self.0);
        pair.0[WORDS..2 * WORDS].copy_from_slice(&second.0);
        pair
    }

    fn rules() -> impl Iterator<Item = &'static Input> {
        Query::SphereSphere.shape().inputs[..WORDS].iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_is_half_a_pair() {
        let (first, second) = (Sphere::new([1.0, 2.0, 3.0, 4.0]), Sphere::new([5.0, 6.0, 7.0, 8.0]));
        assert_eq!(first.with(second), PairRecord::from_spheres(first.values(), second.values()));
    }

    #[test]
    fn the_broken_word_is_named() {
        let good = [0.0, -1.0, f32::MAX, -0.0];
        assert!(Sphere::new(good).is_valid() && Sphere::new(good).broken().is_none());
        for (word, name) in Sphere::NAMES.into_iter().enumerate() {
            for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY, -1e-45] {
                let mut values = good;
                values[word] = bad;
                let breaks = !bad.is_finite() || name == "r";
                assert_eq!(Sphere::new(values).broken(), breaks.then_some(name), "{bad}");
            }
        }
    }
}
