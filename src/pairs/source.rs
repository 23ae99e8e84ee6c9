//! Random numbers for sets of pairs.

use crate::query::PairRecord;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A generator of the numbers in sets of pairs. It uses only integers and correctly rounded operations, so every
/// machine makes the same numbers.
pub(super) struct Source(Xoshiro256PlusPlus);

/// Biased exponents of binary32: those of 1 and of the largest finite numbers.
pub(super) const UNIT: u32 = 127;
pub(super) const LARGEST: u32 = 254;

impl Source {
    pub(super) fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    pub(super) fn bits(&mut self) -> u32 {
        (self.0.next_u64() >> 32) as u32
    }

    /// A number below `bound`, as evenly as matters here.
    pub(super) fn below(&mut self, bound: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(bound)) >> 32) as u32
    }

    /// A random significand; one in four has few bits set or few missing.
    pub(super) fn significand(&mut self) -> u32 {
        let run = (1 << self.below(24)) - 1;
        let bits = match self.below(16) {
            0 => run,
            1 => !run,
            2 => run + 1,
            3 => !(run + 1),
            _ => self.bits(),
        };
        bits & 0x7F_FFFF
    }

    /// A positive number of a biased exponent from `low` to `high`.
    pub(super) fn positive(&mut self, low: u32, high: u32) -> f32 {
        let exponent = low + self.below(high - low + 1);
        f32::from_bits(exponent << 23 | self.significand())
    }

    pub(super) fn signed(&mut self, low: u32, high: u32) -> f32 {
        let value = self.positive(low, high);
        if self.bits() & 1 == 0 { value } else { -value }
    }

    /// Two spheres, coordinates and radii of the given biased exponents.
    pub(super) fn spheres(&mut self, coordinates: (u32, u32), radii: (u32, u32)) -> PairRecord {
        let mut sphere = || {
            let [x, y, z] = [(); 3].map(|()| self.signed(coordinates.0, coordinates.1));
            [x, y, z, self.positive(radii.0, radii.1)]
        };
        PairRecord::from_spheres(sphere(), sphere())
    }
}
