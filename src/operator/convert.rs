//! A number in another format.

use super::Domain;
use super::parts::{Operand, Special, Unrounded, pack, round};
use crate::hdl::Signal;
use crate::number::Format;

/// `a`, which is in `from`, in `to`: rounded once, or exact where `to` has the room.
pub fn convert(a: Signal<'_>, from: Domain, to: Format) -> Signal<'_> {
    let a = Operand::unpack(a, from, "a");
    let (a_exponent, significand) = a.normalised();
    let exponent = a_exponent.offset(i64::from(to.bias() - from.bias())).named("rebiased_exponent");

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
    pack(to, a.sign, round(to, unrounded), special)
}
