//! `Precise`: a fixed-point number so wide that its rounding never affects the result for binary32 pairs.

use super::{Format, Number};
use num_bigint::{BigInt, Sign};
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Bits after the point.
const POINT: u32 = 1472;
/// 64-bit digits: 320 bits are before the point, including the sign.
const DIGITS: usize = 28;
/// Results are rounded to multiples of 2^−1100 before they are rounded to a word.
const SNAP: u32 = 1100;

/// A multiple of 2^−1472 below 2^319, in two's complement.
///
/// Binary32 numbers are multiples of 2^−149, so their sums, differences, products and sums of products are exact
/// here, and every comparison of those is. Quotients and roots lose less than 2^−1472. That is enough to round what a
/// pair of spheres gives correctly to binary32 ([`Precise::to_f32`]). Let x² = q be the squared distance, a multiple
/// of 2^−298 below 2^260. Depth, normal and position have the form a + b/x or a + bx with dyadic a and b, so a
/// difference from a binary32 number or the middle of two, unless it is zero, is at least 2^−991 (multiply by its
/// conjugate: a multiple of 2^−598 remains, over at most 2^393). The error of what the kernel computes is below
/// 2^−1160: 1/x, of at most 2^149, loses 2^−1472 · 2^298, and is multiplied by numbers of which one is at most x and
/// the other below 2^129. Rounding to multiples of 2^−1100 first therefore finds every tie, and crosses none.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Precise([u64; DIGITS]);

impl Precise {
    /// Zero.
    pub(crate) const ZERO: Self = Self([0; DIGITS]);

    /// The same value as `value` if that is finite and below 2^256 in magnitude, otherwise zero.
    pub fn from_f64(value: f64) -> Self {
        if value == 0.0 || value.is_nan() || value.abs() >= 2.0_f64.powi(256) {
            return Self::ZERO;
        }
        let biased = (value.to_bits() >> 52 & 0x7FF) as u32;
        let fraction = value.to_bits() & ((1 << 52) - 1);
        let significand = if biased == 0 { fraction } else { 1 << 52 | fraction };
        // The last bit of the significand stands for 2^(max(biased, 1) − 1075).
        let place = biased.max(1) + POINT - 1075;
        let (digit, shift) = ((place / 64) as usize, place % 64);
        let mut number = Self::ZERO;
        let wide = u128::from(significand) << shift;
        number.0[digit] = wide as u64;
        number.0[digit + 1] = (wide >> 64) as u64;
        if value < 0.0 { -number } else { number }
    }

    /// True if it is below zero.
    pub const fn is_negative(self) -> bool {
        self.0[DIGITS - 1] >> 63 == 1
    }

    /// True if it is zero.
    pub fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    /// The magnitude.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.is_negative() { -self } else { self }
    }

    /// The nearest binary32 number, ties to even; infinite beyond the largest one. It is correct for every result of
    /// the contact kernel, although the kernel computes with errors: see [`Precise`].
    pub fn to_f32(self) -> f32 {
        let snapped = round_shift(&self.abs().big(), POINT - SNAP);
        if snapped.bits() == 0 {
            return 0.0;
        }
        // Exponent of the leading bit, and of the last bit that binary32 has there.
        let exponent = snapped.bits() as i32 - 1 - SNAP as i32;
        let last = (exponent - 23).max(-149);
        let significand = digit(&round_shift(&snapped, (last + SNAP as i32) as u32));
        // Exact in binary64, and beyond 2^128 an infinity after the conversion.
        let magnitude = (significand as f64 * 2.0_f64.powi(last)) as f32;
        if self.is_negative() { -magnitude } else { magnitude }
    }

    /// The value as `f64`, to within a unit in the last place; zero below the smallest normal one.
    pub fn to_f64(self) -> f64 {
        let magnitude = self.abs().big();
        let drop = magnitude.bits().saturating_sub(53);
        // The significand as an integer, and its power of two in two steps, neither of which leaves the range.
        let exponent = drop as i32 - POINT as i32;
        if exponent + 53 < f64::MIN_EXP {
            return 0.0;
        }
        let value = digit(&(magnitude >> drop)) as f64 * 2.0_f64.powi(exponent + 100) * 2.0_f64.powi(-100);
        if self.is_negative() { -value } else { value }
    }

    fn big(self) -> BigInt {
        let mut bytes = [0; DIGITS * 8];
        for (bytes, digit) in bytes.chunks_exact_mut(8).zip(self.0) {
            bytes.copy_from_slice(&digit.to_le_bytes());
        }
        BigInt::from_signed_bytes_le(&bytes)
    }

    /// The integer with twice as many bits after the point, from which quotients and roots are computed.
    fn raised(self) -> BigInt {
        self.big() << POINT
    }

    /// A value that does not fit loses its leading bits; binary32 pairs give no such value.
    fn from_big(value: &BigInt) -> Self {
        let mut number = Self::ZERO;
        for (digit, from) in number.0.iter_mut().zip(value.iter_u64_digits()) {
            *digit = from;
        }
        if value.sign() == Sign::Minus { -number } else { number }
    }
}

/// The lowest 64 bits of a number that is not negative.
fn digit(value: &BigInt) -> u64 {
    value.iter_u64_digits().next().unwrap_or(0)
}

/// `value` / 2^`shift`, to the nearest integer, ties to even; `value` is not negative.
fn round_shift(value: &BigInt, shift: u32) -> BigInt {
    let kept = value >> shift;
    let rest = value - (&kept << shift);
    let half = (BigInt::from(1) << shift) >> 1_u32;
    let up = match rest.cmp(&half) {
        Ordering::Less => false,
        Ordering::Equal => kept.bit(0),
        Ordering::Greater => true,
    };
    if up && shift > 0 { kept + 1 } else { kept }
}

impl fmt::Debug for Precise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} (precise)", self.to_f64())
    }
}

impl PartialOrd for Precise {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Precise {
    fn cmp(&self, other: &Self) -> Ordering {
        other.is_negative().cmp(&self.is_negative()).then_with(|| self.0.iter().rev().cmp(other.0.iter().rev()))
    }
}

impl Neg for Precise {
    type Output = Self;

    fn neg(self) -> Self {
        Self::ZERO - self
    }
}

/// a + b + `carry`, as integers; a carry out of the top is lost.
fn sum(mut a: [u64; DIGITS], b: [u64; DIGITS], mut carry: bool) -> Precise {
    for (digit, other) in a.iter_mut().zip(b) {
        let (partial, first) = digit.overflowing_add(other);
        let (total, second) = partial.overflowing_add(carry.into());
        (*digit, carry) = (total, first | second);
    }
    Precise(a)
}

impl Add for Precise {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        sum(self.0, other.0, false)
    }
}

impl Sub for Precise {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        sum(self.0, other.0.map(|digit| !digit), true)
    }
}

impl Mul for Precise {
    type Output = Self;

    /// Exact if the product is a multiple of 2^−1472, otherwise rounded down.
    fn mul(self, other: Self) -> Self {
        Self::from_big(&((self.big() * other.big()) >> POINT))
    }
}

impl Div for Precise {
    type Output = Self;

    /// Rounded toward zero. A quotient by zero is zero, because the kernel never selects it.
    fn div(self, other: Self) -> Self {
        self.raised().checked_div(&other.big()).map_or(Self::ZERO, |quotient| Self::from_big(&quotient))
    }
}

macro_rules! assigning {
    ($($trait:ident::$method:ident, $operation:ident;)*) => {$(
        impl $trait for Precise {
            fn $method(&mut self, other: Self) {
                *self = self.$operation(other);
            }
        }
    )*};
}

assigning! {
    AddAssign::add_assign, add;
    SubAssign::sub_assign, sub;
    MulAssign::mul_assign, mul;
    DivAssign::div_assign, div;
}

/// The trait's "correctly rounded" is more than is needed here: see [`Precise`].
impl Number for Precise {
    type Bool = bool;

    fn constant(self, value: f64) -> Self {
        Self::from_f64(value)
    }

    /// Rounded down. The root of a negative number is zero.
    fn sqrt(self) -> Self {
        if self.is_negative() { Self::ZERO } else { Self::from_big(&self.raised().sqrt()) }
    }

    fn recip(self) -> Self {
        Self::from_f64(1.0) / self
    }

    fn gt(self, other: Self) -> bool {
        self > other
    }

    fn le(self, other: Self) -> bool {
        self <= other
    }

    /// True if √self itself is greater: the decision to which roots with ever more bits converge.
    fn root_exceeds(self, bound: Self) -> bool {
        bound.is_negative() || self > bound * bound
    }

    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }

    /// The same number, because it has no format. [`Precise::to_f32`] rounds.
    fn to(self, _: Format) -> Self {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_as_they_went_in() {
        for value in [0.0, 1.0, -1.0, 0.1, -1e-45, 1e-300, f64::MIN_POSITIVE, 3.5e38, -6.8e76] {
            assert_eq!(Precise::from_f64(value).to_f64(), value);
            assert_eq!(Precise::from_f64(value).to_f32(), value as f32, "{value}");
        }
        // Below half of the smallest subnormal, at half of it (a tie, to even), above it.
        let tiny = 2.0_f64.powi(-150);
        for (value, word) in [(0.9 * tiny, 0), (tiny, 0), (1.1 * tiny, 1), (3.0 * tiny, 2), (2.9 * tiny, 1)] {
            assert_eq!(Precise::from_f64(value).to_f32().to_bits(), word);
            assert_eq!((-Precise::from_f64(value)).to_f32().abs().to_bits(), word);
        }
        // The middle between the largest number and 2^128 is a tie that goes to infinity.
        let top = f64::from(f32::MAX);
        let middle = top + 2.0_f64.powi(103);
        assert_eq!(Precise::from_f64(middle).to_f32(), f32::INFINITY);
        assert_eq!(Precise::from_f64(middle.next_down()).to_f32(), f32::MAX);
        assert_eq!(Precise::from_f64(f64::NAN), Precise::ZERO);
    }

    #[test]
    fn operations_are_those_of_f64_where_that_is_exact() {
        let numbers = [1.5, -2.25, 1024.0, -0.0078125, 3.0];
        for a in numbers {
            for b in numbers {
                let (x, y) = (Precise::from_f64(a), Precise::from_f64(b));
                assert_eq!((x + y).to_f64(), a + b);
                assert_eq!((x - y).to_f64(), a - b);
                assert_eq!((x * y).to_f64(), a * b);
                assert_eq!((x * x).sqrt().to_f64(), a.abs());
                assert_eq!((x * y / y).to_f64(), a);
                assert_eq!(x.cmp(&y), a.partial_cmp(&b).unwrap());
                assert_eq!((x * x).root_exceeds(y), a.abs() > b);
            }
        }
        assert_eq!(Precise::from_f64(1.0) / Precise::ZERO, Precise::ZERO);
    }

    #[test]
    fn a_root_and_a_third_are_known_to_more_than_1400_bits() {
        let two = Precise::from_f64(2.0);
        let error = (two.sqrt() * two.sqrt() - two).abs();
        let third = Precise::from_f64(1.0) / Precise::from_f64(3.0);
        let rest = (third + third + third - Precise::from_f64(1.0)).abs();
        // Not exact, and within a few units of the last of 1472 bits.
        assert!(!error.is_zero() && !rest.is_zero());
        assert!(error.big().bits() < 4 && rest.big().bits() < 4);
    }
}
