//! Rounding, and results at the ends of the range.

use super::{Signed, capped, distance_bits, shift_right_sticky};
use crate::hdl::Signal;
use crate::operator::Domain;

/// A result before rounding: significand.guard sticky · 2^exponent, with the leading bit of the significand set.
#[derive(Clone, Copy)]
pub struct Unrounded<'g> {
    /// The biased exponent, as if it had no limits.
    pub exponent: Signed<'g>,
    /// As many bits as the format's significand.
    pub significand: Signal<'g>,
    /// The next bit.
    pub guard: Signal<'g>,
    /// Set if any bit below the guard bit is set.
    pub sticky: Signal<'g>,
    /// One bit: the exponent is one more than `exponent`. The adder that rounds can add it.
    pub doubled: Option<Signal<'g>>,
}

impl Unrounded<'_> {
    /// The same with the exponent as it is.
    #[track_caller]
    pub fn exact_exponent(self) -> Self {
        match self.doubled {
            Some(doubled) => {
                let exponent = self.exponent.plus_bit(doubled).named("exponent");
                Self { exponent, doubled: None, ..self }
            }
            None => self,
        }
    }
}

/// The fields of a result that only has to be rounded.
#[derive(Clone, Copy)]
pub struct Fields<'g> {
    /// The exponent field.
    pub exponent: Signal<'g>,
    /// The fraction field, truncated.
    pub fraction: Signal<'g>,
    /// The next bit.
    pub guard: Signal<'g>,
    /// Set if any bit below the guard bit is set.
    pub sticky: Signal<'g>,
    /// One bit: the exponent is one more than `exponent`. Only if results are normal and rounded to nearest.
    pub doubled: Option<Signal<'g>>,
    /// The rounding of the bits below the fraction.
    pub rounding: Rounding,
    /// One bit: too large for the format.
    pub overflow: Signal<'g>,
    /// One bit: to be flushed to zero.
    pub underflow: Signal<'g>,
}

/// The treatment of bits that do not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// To the nearest, ties to even.
    NearestEven,
    /// Toward zero: they are dropped.
    TowardZero,
    /// To odd: they set the last bit that fits.
    Odd,
}

/// One bit: the next magnitude is nearer, or as near and even.
#[track_caller]
fn rounds_up<'g>(fraction: Signal<'g>, guard: Signal<'g>, sticky: Signal<'g>) -> Signal<'g> {
    (guard & (sticky | fraction.bit(0))).named("round_up")
}

impl<'g> Fields<'g> {
    /// These fields if `condition` (1 bit) is set, otherwise zero, which rounding does not change.
    pub fn gate(self, condition: Signal<'g>) -> Self {
        Self {
            exponent: self.exponent.gate(condition).named("exponent_field"),
            doubled: self.doubled.map(|doubled| doubled & condition),
            ..self.with_fraction(self.fraction.gate(condition).named("fraction_field"), condition)
        }
    }

    /// Another fraction if `condition` is not set, with nothing below it.
    pub fn with_fraction(self, fraction: Signal<'g>, condition: Signal<'g>) -> Self {
        // To nearest, the guard bit decides alone. Toward zero, nothing below the fraction counts.
        let sticky = if self.rounding == Rounding::Odd { self.sticky & condition } else { self.sticky };
        Self { fraction, guard: self.guard & condition, sticky, ..self }
    }

    /// {exponent, fraction}, rounded. A carry out of the fraction correctly increments the exponent. From the largest
    /// finite number it gives infinity.
    #[track_caller]
    pub fn rounded(self) -> Signal<'g> {
        let Self { exponent, fraction, guard, sticky, .. } = self;
        match self.rounding {
            Rounding::NearestEven => {
                let truncated = exponent.concat(fraction).named("truncated");
                let up = rounds_up(fraction, guard, sticky);
                // The adder that rounds also increments the exponent.
                let increment = match self.doubled {
                    Some(doubled) => {
                        let doubled = doubled.extend(exponent.width());
                        doubled.concat(up.extend(fraction.width())).named("increments")
                    }
                    None => up.extend(truncated.width()),
                };
                (truncated + increment).named("rounded")
            }
            Rounding::TowardZero => exponent.concat(fraction).named("rounded"),
            Rounding::Odd => {
                let last = (fraction.bit(0) | guard | sticky).named("odd_bit");
                exponent.concat(fraction.drop_low(1)).concat(last).named("rounded")
            }
        }
    }
}

/// Rounds in the given mode.
#[track_caller]
pub fn round<'g>(domain: Domain, value: Unrounded<'g>, rounding: Rounding) -> Fields<'g> {
    let never = value.guard.same(0);
    let fields = |value: Unrounded<'g>| Fields {
        exponent: value.exponent.bits(domain.exponent_bits()),
        fraction: value.significand.low(domain.fraction_bits()),
        guard: value.guard,
        sticky: value.sticky,
        doubled: value.doubled,
        rounding,
        overflow: never,
        underflow: never,
    };
    if domain.is_normal() && rounding == Rounding::NearestEven {
        return fields(value);
    }
    let value = value.exact_exponent();
    if domain.is_normal() {
        return fields(value);
    }
    let fields = Fields { overflow: overflow(domain, value), ..fields(value) };
    if value.exponent.min() > 0 {
        return fields;
    }
    if domain.keeps_subnormals() {
        let (exponent, fraction, guard, sticky) = denormalise(domain, value, never);
        return Fields { exponent, fraction, guard, sticky, ..fields };
    }
    // Just below the smallest normal number, a result may still be rounded up to it.
    let too_small = match rounding {
        Rounding::NearestEven => {
            let up = rounds_up(fields.fraction, value.guard, value.sticky);
            let becomes_normal = (fields.fraction.all() & up).named("becomes_normal");
            value.exponent.is(0) & !becomes_normal
        }
        Rounding::TowardZero | Rounding::Odd => value.exponent.is(0),
    };
    Fields { underflow: (value.exponent.is_negative() | too_small).named("underflow"), ..fields }
}

/// One bit: too large for the format, before rounding.
pub fn overflow<'g>(domain: Domain, value: Unrounded<'g>) -> Signal<'g> {
    value.exponent.at_least(i64::from(domain.special_exponent())).named("overflow")
}

/// Shifts a significand whose exponent is below the smallest normal one to the right, and a significand that is `gone`
/// out completely. Returns exponent field, fraction, guard and sticky.
pub fn denormalise<'g>(
    domain: Domain,
    value: Unrounded<'g>,
    gone: Signal<'g>,
) -> (Signal<'g>, Signal<'g>, Signal<'g>, Signal<'g>) {
    let is_subnormal = (!value.exponent.at_least(1)).named("is_subnormal");
    let missing = value.exponent.subtracted_from(1).named("missing_exponent");
    let missing_bits = 64 - (1 - value.exponent.min()).leading_zeros();
    let moved = value.significand.concat(value.guard);
    let places = capped(missing.bits(missing_bits).named("missing_places"), moved.width(), "missing_places_capped");
    // A negative value is not missing, and zero does not move. Neither waits for `is_subnormal`.
    let mut distance = places.gate(!missing.is_negative());
    // The distance can also shift out what is gone, unless it has too few bits.
    let is_enough = distance.width() == distance_bits(moved.width());
    if is_enough {
        distance = distance | gone.repeat(distance.width());
    }
    let (shifted, lost) = shift_right_sticky(moved, distance.named("denormalise_distance"), "denormalise");
    let shifted = if is_enough { shifted } else { shifted.gate(!gone) }.named("denormalised");
    let field = value.exponent.bits(domain.exponent_bits()).gate(!is_subnormal);
    let fraction = shifted.slice(1, domain.fraction_bits());
    (field, fraction, shifted.bit(0).named("guard"), (lost | value.sticky).named("sticky"))
}
