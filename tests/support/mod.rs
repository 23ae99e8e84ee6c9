//! What several tests share: words that reach the corners, and work split over two threads.
#![allow(dead_code)] // each test uses its own part

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::thread;

/// Words of a format, half of them random, half at the corners where rounding and range go wrong.
pub struct Words {
    random: Xoshiro256PlusPlus,
    exponent_bits: u32,
    fraction_bits: u32,
}

impl Words {
    pub fn new(exponent_bits: u32, fraction_bits: u32, seed: u64) -> Self {
        Self { random: Xoshiro256PlusPlus::seed_from_u64(seed), exponent_bits, fraction_bits }
    }

    /// A fraction: random, few bits set, or nearly all of them.
    fn fraction(&mut self, chance: u64) -> u64 {
        let mask = (1 << self.fraction_bits) - 1;
        let raw = self.random.random::<u64>();
        let one = 1 << ((raw >> 32) % u64::from(self.fraction_bits));
        mask & match chance & 7 {
            0 => one,
            1 => !one,
            2 => one - 1,
            3 => !(one - 1),
            _ => raw,
        }
    }

    /// One word.
    pub fn one(&mut self) -> u128 {
        let chance = self.random.random::<u64>();
        let special = (1 << self.exponent_bits) - 1;
        let exponent = match chance >> 3 & 15 {
            0 => 0,
            1 => special,
            2 => 1,
            3 => special - 1,
            4..8 => special / 2 + (chance >> 7 & 3),
            _ => (chance >> 9) & special,
        };
        let fraction = if chance >> 60 == 0 { 0 } else { self.fraction(chance) };
        let sign = chance >> 59 & 1;
        u128::from(sign << self.exponent_bits | exponent) << self.fraction_bits | u128::from(fraction)
    }

    /// Two words, whose exponents are near each other half of the time.
    pub fn two(&mut self) -> (u128, u128) {
        let (a, mut b) = (self.one(), self.one());
        let chance = self.random.random::<u64>();
        let special = (1 << self.exponent_bits) - 1;
        if chance & 1 == 0 {
            let exponent = (a >> self.fraction_bits) as u64 & special;
            let reach = u64::from(self.fraction_bits) + 4;
            let near = (exponent + (chance >> 1) % (2 * reach + 1)).saturating_sub(reach).min(special);
            b = b & !(u128::from(special) << self.fraction_bits) | u128::from(near) << self.fraction_bits;
        }
        (a, b)
    }
}

/// Runs `work` for the two halves of 0..`count` on two threads.
pub fn halves(count: u64, work: impl Fn(std::ops::Range<u64>) + Sync) {
    thread::scope(|scope| {
        scope.spawn(|| work(0..count / 2));
        work(count / 2..count);
    });
}
