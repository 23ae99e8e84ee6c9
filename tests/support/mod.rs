//! Shared by several tests: random words that cover corner cases, and work split over two threads.
#![allow(dead_code)] // each test uses only some of these

pub mod made_for;
pub mod swap;
pub mod watched;

use contact_afu::number::Format;
use contact_afu::operator::Operator;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::thread;

/// Generates words of a format: half are random, half are corner cases of rounding and range.
pub struct Words {
    random: Xoshiro256PlusPlus,
    exponent_bits: u32,
    fraction_bits: u32,
}

impl Words {
    pub fn new(exponent_bits: u32, fraction_bits: u32, seed: u64) -> Self {
        Self { random: Xoshiro256PlusPlus::seed_from_u64(seed), exponent_bits, fraction_bits }
    }

    /// The next word. Choices are looked up instead of branched on, because a test makes hundreds of millions of words.
    #[inline]
    pub fn one(&mut self) -> u128 {
        let (chance, raw) = (self.random.random::<u64>(), self.random.random::<u64>());
        let special = (1 << self.exponent_bits) - 1;
        let any = chance >> 40 & special;
        let near_one = special / 2 + (chance >> 38 & 3);
        let exponents = [0, special, 1, special - 1, near_one, near_one, near_one, any];
        let exponent = if chance & 8 == 0 { any } else { exponents[(chance & 7) as usize] };
        // Kinds of fractions: random, one bit set or cleared, or a run of bits at either end.
        let bit = 1 << ((u64::from(raw as u32) * u64::from(self.fraction_bits)) >> 32);
        let fractions = [bit, !bit, bit - 1, !(bit - 1), raw >> 12, raw >> 12, raw >> 12, raw >> 12];
        let empty = u64::from(chance >> 4 & 15 == 0);
        let fraction = fractions[(chance >> 8 & 7) as usize] & ((1 << self.fraction_bits) - 1) & empty.wrapping_sub(1);
        let sign = chance >> 63;
        u128::from(sign << self.exponent_bits | exponent) << self.fraction_bits | u128::from(fraction)
    }

    /// Two words; in half of the cases their exponents are near each other.
    #[inline]
    pub fn two(&mut self) -> (u128, u128) {
        let (a, b) = (self.one(), self.one());
        let chance = self.random.random::<u64>();
        let special = (1_u64 << self.exponent_bits) - 1;
        let exponent = (a >> self.fraction_bits) as u64 & special;
        let reach = u64::from(self.fraction_bits) + 4;
        let step = (u64::from(chance as u32) * (2 * reach + 1)) >> 32;
        let near = (exponent + step).saturating_sub(reach).min(special);
        let beside = b & !(u128::from(special) << self.fraction_bits) | u128::from(near) << self.fraction_bits;
        (a, if chance >> 63 == 0 { b } else { beside })
    }
}

/// Runs `work` on the two halves of 0..`count` in two threads.
pub fn halves(count: u64, work: impl Fn(std::ops::Range<u64>) + Sync) {
    thread::scope(|scope| {
        scope.spawn(|| work(0..count / 2));
        work(count / 2..count);
    });
}

/// Two operands near a corner case of this operator: cancellation, a tie, or the boundary of a decision.
pub fn corner(operator: Operator, format: Format, words: &mut Words, count: u64) -> (u128, u128) {
    let (a, b) = words.two();
    let mask = format.sign_mask() | (format.sign_mask() - 1);
    let near = |word: u128| (word + u128::from(count >> 2 & 7)).wrapping_sub(3) & mask;
    match (count & 3, operator) {
        (0, Operator::Add | Operator::WideningAdd { .. }) => (a, near(a ^ format.sign_mask())),
        (0, Operator::Sub | Operator::WideningSub { .. } | Operator::Greater | Operator::AtMost) => (a, near(a)),
        (0 | 1, Operator::RootExceeds) => (near(Operator::Mul.twin(format, b, b)), b & !format.sign_mask()),
        (0, Operator::Div) => (near(Operator::Mul.twin(format, a, b)), b),
        (0, Operator::Sqrt) => (near(Operator::Mul.twin(format, a, a)), b),
        _ => (a, b),
    }
}
