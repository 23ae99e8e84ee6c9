//! Rounding, the ends of the range, and the result put together.

use super::{Signed, shift_right_sticky};
use crate::hdl::Signal;
use crate::operator::Domain;

/// A result before rounding: significand.guard sticky · 2^exponent, with the leading bit of the significand set.
#[derive(Clone, Copy)]
pub struct Unrounded<'g> {
    /// The biased exponent, as if it had no ends.
    pub exponent: Signed<'g>,
    /// As many bits as the format's significand.
    pub significand: Signal<'g>,
    /// The next bit.
    pub guard: Signal<'g>,
    /// Whether anything is set below that one.
    pub sticky: Signal<'g>,
    /// One bit: the exponent is one more than said, which the adder that rounds can see to.
    pub doubled: Option<Signal<'g>>,
}

/// A magnitude after rounding.
#[derive(Clone, Copy)]
pub struct Rounded<'g> {
    /// Exponent and fraction fields.
    pub magnitude: Signal<'g>,
    /// One bit: too large for the format.
    pub overflow: Signal<'g>,
    /// One bit: to be flushed to zero.
    pub underflow: Signal<'g>,
}

/// Which special value the operands call for. At most one of `infinity` and `zero` is set; `nan` beats both.
#[derive(Clone, Copy)]
pub struct Special<'g> {
    /// The canonical NaN.
    pub nan: Signal<'g>,
    /// Infinity of the result's sign.
    pub infinity: Signal<'g>,
    /// Zero of the result's sign.
    pub zero: Signal<'g>,
}

/// One bit: the next magnitude is nearer, or as near and even.
#[track_caller]
fn rounds_up<'g>(fraction: Signal<'g>, guard: Signal<'g>, sticky: Signal<'g>) -> Signal<'g> {
    (guard & (sticky | fraction.bit(0))).named("round_up")
}

/// How what does not fit is rounded off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// To the nearest, ties to even.
    NearestEven,
    /// Toward zero: what does not fit is dropped.
    TowardZero,
    /// To odd: what does not fit sets the last bit of what does.
    Odd,
}

impl Rounding {
    /// {exponent, fraction}, rounded.
    #[track_caller]
    pub fn apply<'g>(
        self,
        exponent: Signal<'g>,
        fraction: Signal<'g>,
        guard: Signal<'g>,
        sticky: Signal<'g>,
    ) -> Signal<'g> {
        match self {
            Self::NearestEven => nearest_even(exponent, fraction, guard, sticky),
            Self::TowardZero => exponent.concat(fraction).named("rounded"),
            Self::Odd => {
                let last = (fraction.bit(0) | guard | sticky).named("odd_bit");
                exponent.concat(fraction.drop_low(1)).concat(last).named("rounded")
            }
        }
    }
}

/// {exponent, fraction}, one more where that is nearer. A carry out of the fraction makes the exponent one more,
/// which is right; out of the largest finite number it makes infinity.
#[track_caller]
fn nearest_even<'g>(exponent: Signal<'g>, fraction: Signal<'g>, guard: Signal<'g>, sticky: Signal<'g>) -> Signal<'g> {
    let truncated = exponent.concat(fraction).named("truncated");
    (truncated + rounds_up(fraction, guard, sticky).extend(truncated.width())).named("rounded")
}

/// [`nearest_even`] for a result that stays inside the range: the adder that rounds also adds `doubled` to the exponent.
#[track_caller]
fn inside_range<'g>(domain: Domain, value: Unrounded<'g>) -> Signal<'g> {
    let fraction = value.significand.low(domain.fraction_bits());
    let field = value.exponent.bits(domain.exponent_bits());
    let Some(doubled) = value.doubled else { return nearest_even(field, fraction, value.guard, value.sticky) };
    let truncated = field.concat(fraction).named("truncated");
    let up = rounds_up(fraction, value.guard, value.sticky).extend(domain.fraction_bits());
    let increments = doubled.extend(domain.exponent_bits()).concat(up).named("increments");
    (truncated + increments).named("rounded")
}

/// Rounds as the format says, with gradual underflow or flushing as it has it. What the exponent's range excludes
/// costs nothing.
#[track_caller]
pub fn round<'g>(domain: Domain, value: Unrounded<'g>) -> Rounded<'g> {
    round_so(domain, value, domain.rounding())
}

/// [`round`] in one of the ways there are.
#[track_caller]
pub fn round_so<'g>(domain: Domain, value: Unrounded<'g>, rounding: Rounding) -> Rounded<'g> {
    let never = value.guard.same(0);
    if domain.is_normal() && rounding == Rounding::NearestEven {
        return Rounded { magnitude: inside_range(domain, value), overflow: never, underflow: never };
    }
    let value = match value.doubled {
        Some(doubled) => {
            let exponent = value.exponent.plus_bit(doubled).named("exponent");
            Unrounded { exponent, doubled: None, ..value }
        }
        None => value,
    };
    if domain.is_normal() {
        let field = value.exponent.bits(domain.exponent_bits());
        let fraction = value.significand.low(domain.fraction_bits());
        let magnitude = rounding.apply(field, fraction, value.guard, value.sticky);
        return Rounded { magnitude, overflow: never, underflow: never };
    }
    let overflow = value.exponent.at_least(i64::from(domain.special_exponent())).named("overflow");
    let mut underflow = never;
    let mut field = value.exponent.bits(domain.exponent_bits());
    let mut fraction = value.significand.low(domain.fraction_bits());
    let Unrounded { mut guard, mut sticky, .. } = value;
    if value.exponent.min() <= 0 {
        if domain.keeps_subnormals() {
            (field, fraction, guard, sticky) = denormalise(domain, value);
        } else {
            // Just below the smallest normal number a result can still be rounded up to it.
            let too_small = match rounding {
                Rounding::NearestEven => {
                    let becomes_normal = (fraction.all() & rounds_up(fraction, guard, sticky)).named("becomes_normal");
                    value.exponent.is(0) & !becomes_normal
                }
                Rounding::TowardZero | Rounding::Odd => value.exponent.is(0),
            };
            underflow = (value.exponent.is_negative() | too_small).named("underflow");
        }
    }
    Rounded { magnitude: rounding.apply(field, fraction, guard, sticky), overflow, underflow }
}

/// Moves a significand whose exponent is below the smallest normal one to the right. Gives exponent field, fraction,
/// guard and sticky.
fn denormalise<'g>(domain: Domain, value: Unrounded<'g>) -> (Signal<'g>, Signal<'g>, Signal<'g>, Signal<'g>) {
    let is_subnormal = (!value.exponent.at_least(1)).named("is_subnormal");
    let missing = value.exponent.subtracted_from(1).named("missing_exponent");
    let distance_bits = 64 - (1 - value.exponent.min()).leading_zeros();
    let distance = missing.bits(distance_bits).gate(is_subnormal).named("denormalise_distance");
    let (shifted, lost) = shift_right_sticky(value.significand.concat(value.guard), distance, "denormalise");
    let shifted = shifted.named("denormalised");
    let field = value.exponent.bits(domain.exponent_bits()).gate(!is_subnormal);
    let fraction = shifted.slice(1, domain.fraction_bits());
    (field, fraction, shifted.bit(0).named("guard"), (lost | value.sticky).named("sticky"))
}

/// The result's word: special values over what was rounded. Where results are normal only `zero` counts.
#[track_caller]
pub fn pack<'g>(domain: Domain, sign: Signal<'g>, rounded: Rounded<'g>, special: Special<'g>) -> Signal<'g> {
    if domain.is_normal() {
        let is_zero = special.zero.named("is_zero");
        return sign.named("sign").concat(rounded.magnitude.gate(!is_zero).named("magnitude"));
    }
    let nan = special.nan.named("is_nan");
    // A zero operand leaves nonsense in the exponent, which may look like an overflow; so does an infinity.
    let overflow = rounded.overflow & !special.zero;
    let zero = (special.zero | rounded.underflow).named("is_zero");
    let (infinity, largest) = if domain.rounding() == Rounding::TowardZero {
        // What is too large becomes the largest finite number.
        (special.infinity.named("is_infinity"), (overflow & !special.infinity & !nan).named("is_largest"))
    } else {
        ((special.infinity | overflow).named("is_infinity"), nan.same(0))
    };
    let special_fraction = if domain.rounding() == Rounding::TowardZero {
        (nan | largest).concat(largest.repeat(domain.fraction_bits() - 1))
    } else {
        nan.append_zeros(domain.fraction_bits() - 1)
    };
    let special_exponent = match domain.rounding() {
        Rounding::TowardZero => (nan | infinity | largest).repeat(domain.exponent_bits() - 1).concat(nan | infinity),
        _ => (nan | infinity).repeat(domain.exponent_bits()),
    };
    let special_magnitude = special_exponent.concat(special_fraction).named("special_magnitude");
    let is_special = (nan | infinity | largest | zero).named("is_special");
    let magnitude = is_special.select(special_magnitude, rounded.magnitude).named("magnitude");
    (sign & !nan).named("sign").concat(magnitude)
}
