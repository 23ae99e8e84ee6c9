//! A number in another format.

use super::Domain;
use super::parts::{Fields, Operand, Special, Unrounded, pack, result, round};
use crate::hdl::Signal;
use crate::number::Format;

/// Converts `a` from `from` to `to`: rounded once, or exact if `to` has enough bits.
pub fn convert(a: Signal<'_>, from: Domain, to: Format) -> Signal<'_> {
    let a = Operand::unpack(a, from, "a");
    let (exponent, significand) = a.normalised_for(to.bias());
    // At least the new significand and its guard bit.
    let padding = (to.significand_bits() + 1).saturating_sub(significand.width());
    let padded = significand.append_zeros(padding);
    let below = padded.width() - to.significand_bits() - 1;
    let sticky = if below == 0 { a.sign.graph().constant(1, 0) } else { padded.low(below).any() };
    let unrounded = Unrounded {
        exponent,
        significand: padded.high(to.significand_bits()).named("significand"),
        guard: padded.bit(below).named("guard"),
        sticky: sticky.named("sticky"),
        doubled: None,
    };
    let special = Special { nan: a.is_nan(), infinity: a.is_infinity(), zero: a.is_zero() };
    let to = Domain::from(to);
    if from.keeps_subnormals() && exponent.min() > 0 {
        // Zero has the significand zero and an exponent that is not too large, so only the exponent must be cleared.
        let fields = round(to, unrounded, to.rounding());
        let fields = Fields { exponent: fields.exponent.gate(!special.zero), ..fields };
        return pack(to, a.sign, fields, Special { zero: a.sign.same(0), ..special });
    }
    result(to, a.sign, unrounded, special)
}
