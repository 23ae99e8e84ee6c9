//! Takes words apart and assembles results. This is the only place that rounds.

use crate::number::{Format, Rounding};

/// The class of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    Zero,
    /// Neither zero nor special: exponent and significand count.
    Finite,
    Infinity,
    Nan,
}

/// A value without a format: ±significand · 2^(exponent − 63).
///
/// The significand of a finite value has its leading bit at bit 63. Significands of words have at most 53 bits, so the
/// low eleven bits are zero. Significands of results are exact down to bit 1. Bit 0 is set if anything was lost below
/// it ("sticky"), which is all that rounding needs.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    pub class: Class,
    pub negative: bool,
    pub exponent: i32,
    pub significand: u64,
}

impl Parts {
    pub const ONE: Self = Self::finite(false, 0, 1 << 63);
    pub const NAN: Self = Self { class: Class::Nan, negative: false, exponent: 0, significand: 0 };

    pub const fn zero(negative: bool) -> Self {
        Self { class: Class::Zero, negative, exponent: 0, significand: 0 }
    }

    pub const fn infinity(negative: bool) -> Self {
        Self { class: Class::Infinity, negative, exponent: 0, significand: 0 }
    }

    pub const fn finite(negative: bool, exponent: i32, significand: u64) -> Self {
        Self { class: Class::Finite, negative, exponent, significand }
    }

    pub const fn negated(self) -> Self {
        Self { negative: !self.negative, ..self }
    }
}

/// Reads a word. A subnormal reads as zero if the format flushes subnormals.
#[inline]
pub fn unpack(format: Format, bits: u128) -> Parts {
    // A fraction fits in 64 bits. So do nearly all words, which are then cheaper to shift.
    let low = bits as u64;
    let fraction = low & ((1 << format.fraction_bits()) - 1);
    let narrow = format.width() <= u64::BITS;
    let head = if narrow { low >> format.fraction_bits() } else { (bits >> format.fraction_bits()) as u64 } as u32;
    let biased = head & format.special_exponent();
    let negative = head > format.special_exponent();
    if biased == format.special_exponent() {
        return if fraction == 0 { Parts::infinity(negative) } else { Parts::NAN };
    }
    // The fraction's leading bit goes to bit 62, right below the hidden one.
    let aligned = fraction << (63 - format.fraction_bits());
    if biased > 0 {
        return Parts::finite(negative, biased as i32 - format.bias(), 1 << 63 | aligned);
    }
    if fraction == 0 || !format.keeps_subnormals() {
        return Parts::zero(negative);
    }
    let shift = aligned.leading_zeros();
    Parts::finite(negative, format.min_exponent() - shift as i32, aligned << shift)
}

/// Rounds a value as the format says, and writes its word.
#[inline]
pub fn pack(format: Format, value: Parts) -> u128 {
    let (biased, fraction) = match value.class {
        Class::Nan => return format.nan_bits(),
        Class::Infinity => (format.special_exponent(), 0),
        Class::Zero => (0, 0),
        Class::Finite => round(format, value.exponent, value.significand),
    };
    let head = u64::from(u32::from(value.negative) << format.exponent_bits() | biased);
    // A carry out of a subnormal's fraction correctly sets the biased exponent to 1.
    if format.width() <= u64::BITS {
        u128::from((head << format.fraction_bits()) + fraction)
    } else {
        (u128::from(head) << format.fraction_bits()) + u128::from(fraction)
    }
}

/// Rounds a value to odd and writes its word: if bits are lost, the last bit that fits is set. The value must be zero
/// or within the format's normal range.
pub fn pack_odd(format: Format, value: Parts) -> u128 {
    let dropped = 64 - format.significand_bits();
    let lost = value.significand & ((1 << dropped) - 1) != 0;
    let kept = value.significand >> dropped << dropped;
    pack(format, Parts { significand: kept | u64::from(lost) << dropped, ..value })
}

/// The biased exponent and the fraction of a rounded value. The fraction of a subnormal may be one bit longer.
#[inline]
fn round(format: Format, exponent: i32, significand: u64) -> (u32, u64) {
    let below = format.min_exponent() - exponent;
    let dropped = 64 - format.significand_bits();
    let nearest = format.rounding() == Rounding::Nearest;
    let round = |shift| {
        if nearest { round_shift(significand, shift) } else { significand.checked_shr(shift).unwrap_or(0) }
    };
    if below > 0 && format.keeps_subnormals() {
        // Gradual underflow: more bits are dropped.
        return (0, round(dropped.saturating_add(below as u32)));
    }
    // A carry out of the significand leaves a fraction of zeros, under the next exponent.
    let rounded = round(dropped);
    let carry = (rounded >> format.significand_bits()) as i32;
    let biased = exponent + carry + format.bias();
    if biased < 1 {
        (0, 0)
    } else if biased >= format.special_exponent() as i32 {
        // Rounding toward zero, no finite value becomes infinite (IEEE 754-2019, clause 7.4).
        if nearest {
            (format.special_exponent(), 0)
        } else {
            (format.special_exponent() - 1, (1 << format.fraction_bits()) - 1)
        }
    } else {
        (biased as u32, rounded & ((1 << format.fraction_bits()) - 1))
    }
}

/// `value` / 2^`shift`, to the nearest integer, ties to even. `shift` is at least 1; bit 0 of `value` may be sticky.
#[inline]
fn round_shift(value: u64, shift: u32) -> u64 {
    if shift > 64 {
        return 0; // less than a half
    }
    let half = 1_u64 << (shift - 1);
    let rest = value & (half | (half - 1));
    let kept = value.checked_shr(shift).unwrap_or(0);
    kept + u64::from(rest > half || rest == half && kept & 1 == 1)
}
