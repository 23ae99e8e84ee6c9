//! The order of two words, and a comparison with a rounded root that needs no root.

use super::parts::{Class, Parts};
use crate::number::{Format, Rounding};
use std::cmp::Ordering;

/// Compares a with b; `None` if either is a NaN. −0 equals +0.
pub fn order(format: Format, a: u128, b: u128) -> Option<Ordering> {
    Some(key(format, a)?.cmp(&key(format, b)?))
}

/// An integer in the order of the values: the magnitude of a word with its sign.
fn key(format: Format, bits: u128) -> Option<i128> {
    let magnitude = bits & !format.sign_mask();
    if magnitude > format.infinity_bits() {
        return None;
    }
    let flushed = !format.keeps_subnormals() && magnitude <= format.fraction_mask();
    let magnitude = if flushed { 0 } else { magnitude as i128 };
    Some(if bits & format.sign_mask() == 0 { magnitude } else { -magnitude })
}

/// RN(√q) > s, without the root: q > (s + ½ulp(s))², computed exactly. For rounding toward zero, √q ≥ s + ulp(s), so q
/// ≥ (s + ulp(s))².
///
/// The middle between s and the next number has one significand bit more than s, so its square has at most
/// 2·(53 + 1) bits. No format can tie: the square of a normal s's middle is odd in its last of more than 2p bits,
/// that of a subnormal one has its last bit below the smallest subnormal.
///
/// A negative s, which a sum of radii never is, is compared as the root would be.
pub fn root_exceeds(format: Format, q: Parts, s: Parts) -> bool {
    let no_root = q.class == Class::Nan || q.negative && q.class != Class::Zero;
    if no_root || s.class == Class::Nan {
        return false;
    }
    match (q.class, s.class) {
        (_, Class::Finite | Class::Infinity) if s.negative => true,
        (_, Class::Infinity) | (Class::Zero, _) => false,
        (Class::Infinity, _) => true,
        _ => {
            let nearest = format.rounding() == Rounding::Nearest;
            let middle = if nearest { upper_middle(format, s) } else { next_up(format, s) };
            let square = u128::from(middle.significand) * u128::from(middle.significand);
            let shift = square.leading_zeros(); // 0 or 1
            let square = (2 * middle.exponent + 1 - shift as i32, square << shift);
            let q = (q.exponent, u128::from(q.significand) << 64);
            if nearest { q > square } else { q >= square }
        }
    }
}

/// The middle between s ≥ 0 and the next number up.
fn upper_middle(format: Format, s: Parts) -> Parts {
    let fraction = format.fraction_bits() as i32;
    if s.class == Class::Zero {
        // Half of the smallest subnormal. If subnormals are flushed, any positive q is also far above its square.
        return Parts::finite(false, format.min_exponent() - fraction - 1, 1 << 63);
    }
    // The bit below the last one. The aligned significand of a subnormal has it higher up.
    let aligned = (format.min_exponent() - s.exponent).max(0);
    Parts::finite(false, s.exponent, s.significand | 1 << (62 - fraction + aligned))
}

/// The next number above s ≥ 0. Above the largest number, it is the one that would follow.
fn next_up(format: Format, s: Parts) -> Parts {
    let fraction = format.fraction_bits() as i32;
    if s.class == Class::Zero {
        let exponent = format.min_exponent() - if format.keeps_subnormals() { fraction } else { 0 };
        return Parts::finite(false, exponent, 1 << 63);
    }
    let aligned = (format.min_exponent() - s.exponent).max(0);
    match s.significand.checked_add(1 << (63 - fraction + aligned)) {
        Some(significand) => Parts::finite(false, s.exponent, significand),
        None => Parts::finite(false, s.exponent + 1, 1 << 63),
    }
}
