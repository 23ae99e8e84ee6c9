//! Reciprocal: the recurrence of the quotient with the dividend 1, whose first two digits are known.

use super::Domain;
use super::div::Step;
use super::parts::{Operand, Rounding, Signed, Special, Unrounded, result};
use crate::hdl::Signal;

/// 1 / a.
pub fn recip(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let a = Operand::unpack(a, domain, "a");
    let (_, divisor) = a.normalised();
    // 2 − divisor: what the digit 1 leaves, one place further on.
    let mut step = Step::after((divisor.same(0) - divisor).extend(divisor.width() + 1), 1);
    let mut zeros = Vec::new();
    for index in 2..2 + digits(domain) {
        step = step.next(divisor, index);
        zeros.push(step.negative);
    }
    rounded(domain, a, (!Signal::join(&zeros)).named("quotient"))
}

/// The number of digits that are not known beforehand. The significand is followed by a guard bit if rounding needs
/// one.
pub fn digits(domain: Domain) -> u32 {
    domain.significand_bits() - 1 + u32::from(domain.rounding() != Rounding::TowardZero)
}

/// The reciprocal's word, from the digits after the first two.
///
/// The significand of a is in [1, 2), so the quotient is in (1/2, 1]. Its digits before and right after the point are 0
/// and 1. For a power of two the quotient is 1. It results as 0.111…1 with the guard bit set, and rounding makes it 1
/// with an exponent one higher, so this needs no separate case.
pub fn rounded<'g>(domain: Domain, a: Operand<'g>, digits: Signal<'g>) -> Signal<'g> {
    let (a_exponent, divisor) = a.normalised();
    let exponent = exponent(domain, a_exponent);
    let graph = digits.graph();
    let (zero, one) = (graph.constant(1, 0), graph.constant(1, 1));
    let unrounded = if domain.rounding() == Rounding::TowardZero {
        // Without rounding, 0.111…1 is not rounded up, so a power of two needs a separate case.
        let is_power = divisor.low(domain.fraction_bits()).is_zero().named("is_power_of_two");
        let significand = one.concat(digits.gate(!is_power)).named("significand");
        Unrounded { exponent, significand, guard: zero, sticky: zero, doubled: Some(is_power) }
    } else {
        Unrounded {
            exponent,
            significand: one.concat(digits.drop_low(1)).named("significand"),
            guard: digits.bit(0).named("guard"),
            // 1 / a is finite in binary only for a power of two, and this one must be rounded up.
            sticky: one,
            doubled: None,
        }
    };
    finish(domain, a, unrounded)
}

/// The exponent of a reciprocal whose leading digit is right after the point.
pub fn exponent<'g>(domain: Domain, a_exponent: Signed<'g>) -> Signed<'g> {
    a_exponent.subtracted_from(2 * i64::from(domain.bias()) - 1).named("quotient_exponent")
}

/// A rounded reciprocal's word. The reciprocal of zero is infinity, and of infinity zero.
pub fn finish<'g>(domain: Domain, a: Operand<'g>, unrounded: Unrounded<'g>) -> Signal<'g> {
    let special = Special { nan: a.is_nan(), infinity: a.is_zero(), zero: a.is_infinity() };
    result(domain, a.sign, unrounded, special)
}
