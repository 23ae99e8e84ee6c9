//! Assembles a result: the rounded value, or a special value.

use super::round::{denormalise, overflow};
use super::{Fields, Rounding, Unrounded, round};
use crate::hdl::Signal;
use crate::operator::Domain;

/// The special result of the operands. At most one of `infinity` and `zero` is set; `nan` takes precedence.
#[derive(Clone, Copy)]
pub struct Special<'g> {
    /// The canonical NaN.
    pub nan: Signal<'g>,
    /// Infinity of the result's sign.
    pub infinity: Signal<'g>,
    /// Zero of the result's sign.
    pub zero: Signal<'g>,
}

/// The result's word: rounded as the format says, with gradual underflow or flushing, or special. Cases that the
/// exponent's range excludes cost nothing.
#[track_caller]
pub fn result<'g>(domain: Domain, sign: Signal<'g>, value: Unrounded<'g>, special: Special<'g>) -> Signal<'g> {
    let rounding = domain.rounding();
    if !domain.keeps_subnormals() || rounding != Rounding::NearestEven || value.exponent.min() > 0 {
        return pack(domain, sign, round(domain, value, rounding), special);
    }
    let value = value.exact_exponent();
    let chosen = Chosen::of(domain, special, overflow(domain, value), value.guard.same(0));
    // A special result is shifted out completely, so that nothing is left to round.
    let (exponent, fraction, guard, sticky) = denormalise(domain, value, chosen.is_special);
    let exponent = chosen.is_special.select(chosen.exponent, exponent).named("exponent_field");
    let fraction = (fraction.msb() | chosen.nan).concat(fraction.low(fraction.width() - 1));
    let never = guard.same(0);
    let fields =
        Fields { exponent, fraction, guard, sticky, doubled: None, rounding, overflow: never, underflow: never };
    (sign & !chosen.nan).named("sign").concat(fields.rounded())
}

/// The word of a rounded or special result. If results are normal, only `zero` counts.
#[track_caller]
pub fn pack<'g>(domain: Domain, sign: Signal<'g>, fields: Fields<'g>, special: Special<'g>) -> Signal<'g> {
    if domain.is_normal() {
        let is_zero = special.zero.named("is_zero");
        let is_nonzero = (!is_zero).named("is_nonzero");
        return sign.named("sign").concat(fields.gate(is_nonzero).rounded());
    }
    let Chosen { is_special, nan, exponent, fraction } = Chosen::of(domain, special, fields.overflow, fields.underflow);
    let magnitude = if fields.underflow.as_constant() == Some(0) {
        // Selected before rounding, where there is time. After the adder it would need another stage.
        let exponent = is_special.select(exponent, fields.exponent).named("exponent_field");
        let fraction = is_special.select(fraction, fields.fraction).named("fraction_field");
        Fields { exponent, ..fields.with_fraction(fraction, !is_special) }.rounded()
    } else {
        let special_magnitude = exponent.concat(fraction).named("special_magnitude");
        is_special.select(special_magnitude, fields.rounded()).named("magnitude")
    };
    (sign & !nan).named("sign").concat(magnitude)
}

/// The special value of a result, and its fields.
struct Chosen<'g> {
    /// One bit: the result is special.
    is_special: Signal<'g>,
    nan: Signal<'g>,
    exponent: Signal<'g>,
    fraction: Signal<'g>,
}

impl<'g> Chosen<'g> {
    fn of(domain: Domain, special: Special<'g>, overflow: Signal<'g>, underflow: Signal<'g>) -> Self {
        let nan = special.nan.named("is_nan");
        // For a zero operand, the exponent is meaningless and may look like an overflow. An infinity may, too.
        let overflow = overflow & !special.zero;
        let zero = (special.zero | underflow).named("is_zero");
        if domain.rounding() == Rounding::TowardZero {
            // A value that is too large becomes the largest finite number.
            let infinity = special.infinity.named("is_infinity");
            let largest = (overflow & !infinity & !nan).named("is_largest");
            let beyond = nan | infinity;
            return Self {
                is_special: (beyond | largest | zero).named("is_special"),
                nan,
                exponent: (beyond | largest).repeat(domain.exponent_bits() - 1).concat(beyond),
                fraction: (nan | largest).concat(largest.repeat(domain.fraction_bits() - 1)),
            };
        }
        let infinity = (special.infinity | overflow).named("is_infinity");
        Self {
            is_special: (nan | infinity | zero).named("is_special"),
            nan,
            exponent: (nan | infinity).repeat(domain.exponent_bits()),
            fraction: nan.append_zeros(domain.fraction_bits() - 1),
        }
    }
}
