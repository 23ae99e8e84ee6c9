//! Sum, product, quotient and root of unpacked values: exact except for one sticky bit, in any format.

use super::parts::{Class, Parts};

/// a + b. An exact zero is +0 unless both terms are −0 (IEEE 754-2019, clause 6.3).
#[inline]
pub fn add(a: Parts, b: Parts) -> Parts {
    use Class::{Finite, Infinity, Nan, Zero};
    match (a.class, b.class) {
        (Finite, Finite) => add_finite(a, b),
        (Nan, _) | (_, Nan) => Parts::NAN,
        (Infinity, Infinity) if a.negative != b.negative => Parts::NAN,
        (Infinity, _) => a,
        (_, Infinity) => b,
        (Zero, Zero) => Parts::zero(a.negative && b.negative),
        (Zero, _) => b,
        (_, Zero) => a,
    }
}

#[inline]
fn add_finite(a: Parts, b: Parts) -> Parts {
    let a_is_larger = (a.exponent, a.significand) >= (b.exponent, b.significand);
    let (large, small) = if a_is_larger { (a, b) } else { (b, a) };
    // Leading bits at 62 leave room for a carry. There are ten zero bits below, and rounding needs two and the sticky
    // bit.
    let x = large.significand >> 1;
    let y = shift_sticky(small.significand >> 1, (large.exponent - small.exponent) as u32);
    let sum = if a.negative == b.negative { x + y } else { x - y };
    if sum == 0 {
        return Parts::zero(false);
    }
    let shift = sum.leading_zeros();
    Parts::finite(large.negative, large.exponent + 1 - shift as i32, sum << shift)
}

/// a · b.
#[inline]
pub fn multiply(a: Parts, b: Parts) -> Parts {
    use Class::{Finite, Infinity, Nan, Zero};
    let negative = a.negative != b.negative;
    match (a.class, b.class) {
        (Finite, Finite) => {
            let product = u128::from(a.significand) * u128::from(b.significand);
            let shift = product.leading_zeros(); // 0 or 1
            Parts::finite(negative, a.exponent + b.exponent + 1 - shift as i32, upper_sticky(product << shift))
        }
        (Nan, _) | (_, Nan) | (Infinity, Zero) | (Zero, Infinity) => Parts::NAN,
        (Infinity, _) | (_, Infinity) => Parts::infinity(negative),
        (Zero, _) | (_, Zero) => Parts::zero(negative),
    }
}

/// a / b.
#[inline]
pub fn divide(a: Parts, b: Parts) -> Parts {
    use Class::{Finite, Infinity, Nan, Zero};
    let negative = a.negative != b.negative;
    match (a.class, b.class) {
        (Finite, Finite) => {
            // Both have their leading bit at 63, so the quotient with 63 places fits in 64 bits and has at least 63.
            let (n, d) = (u128::from(a.significand) << 63, u128::from(b.significand));
            let quotient = (n / d) as u64;
            let shift = quotient.leading_zeros(); // 0 or 1
            let inexact = u64::from(n % d != 0);
            Parts::finite(negative, a.exponent - b.exponent - shift as i32, quotient << shift | inexact)
        }
        (Nan, _) | (_, Nan) | (Infinity, Infinity) | (Zero, Zero) => Parts::NAN,
        (Infinity, _) | (_, Zero) => Parts::infinity(negative),
        (Zero, _) | (_, Infinity) => Parts::zero(negative),
    }
}

/// √a. √−0 is −0; of any other negative number it is NaN.
#[inline]
pub fn square_root(a: Parts) -> Parts {
    match a.class {
        Class::Zero | Class::Nan => a,
        _ if a.negative => Parts::NAN,
        Class::Infinity => a,
        Class::Finite => {
            let odd = a.exponent & 1;
            let exponent = (a.exponent - odd) / 2;
            // A radicand of 127 or 128 bits has a root of 64.
            let radicand = u128::from(a.significand) << (63 + odd);
            let root = radicand.isqrt();
            Parts::finite(false, exponent, root as u64 | u64::from(root * root != radicand))
        }
    }
}

/// `value` >> `shift`, with bit 0 set if any bit fell off.
#[inline]
fn shift_sticky(value: u64, shift: u32) -> u64 {
    if shift >= 64 {
        return u64::from(value != 0);
    }
    value >> shift | u64::from(value & ((1 << shift) - 1) != 0)
}

/// The upper half, with bit 0 set if the lower is not zero.
#[inline]
fn upper_sticky(value: u128) -> u64 {
    (value >> 64) as u64 | u64::from(value as u64 != 0)
}
