//! `f32` as a [`Number`]: what the machine's own binary32 arithmetic computes.
//!
//! Rust neither fuses nor reorders floating-point operations, so its results are those of IEEE 754 on every target that
//! this crate supports. Only the words of NaN differ between machines, and code that writes a record makes them
//! canonical.

use super::{Format, Number};

impl Number for f32 {
    type Bool = bool;

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        value as f32
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn gt(self, other: Self) -> bool {
        self > other
    }

    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }

    /// Exact in binary64: the middle above `bound` has 25 significand bits, its square 50, and no binary32 square
    /// leaves binary64's normal range. No tie can occur: it would need a subnormal `bound`, whose square is far
    /// below the smallest `self`.
    #[inline(always)]
    fn root_exceeds(self, bound: Self) -> bool {
        // Half an ulp of a number with biased exponent e is 2^(max(e, 1) − 127 − 24). An infinity absorbs it.
        let biased = (bound.to_bits() >> 23 & 0xFF).max(1);
        let half_ulp = f64::from_bits(u64::from(biased + (1023 - 127 - 24)) << 52);
        let middle = f64::from(bound) + half_ulp;
        f64::from(self) > middle * middle
    }

    #[inline(always)]
    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }

    /// # Panics
    /// Panics if `format` is not [`Format::BINARY32`], the only format of an `f32`.
    #[inline(always)]
    fn to(self, format: Format) -> Self {
        assert!(format == Format::BINARY32, "an f32 cannot be converted to {format}: use Soft");
        self
    }
}
