//! Reciprocal: the recurrence of the quotient with the dividend 1, of which the first two digits are known.

use super::Domain;
use super::div::Step;
use super::parts::{Operand, Special, Unrounded, pack, round};
use crate::hdl::Signal;

/// 1 / a.
///
/// The significand of a is in [1, 2), so the quotient is in (1/2, 1]: its digits before the point and right behind
/// it are 0 and 1. A power of two, of which the quotient is 1, comes out as 0.111…1 with the guard bit set, and
/// rounding makes it 1 with the exponent one more: no case of its own.
pub fn recip(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let graph = a.graph();
    let a = Operand::unpack(a, domain, "a");
    let (a_exponent, divisor) = a.normalised();

    let precision = domain.significand_bits();
    let digit_one = graph.constant(1, 1);
    let mut digits = vec![digit_one];
    // 2 − divisor: what the digit 1 leaves, one place further on.
    let mut remainder = (divisor.same(0) - divisor).named("remainder_1");
    for index in 2..precision + 2 {
        let step = Step::new(remainder.append_zeros(1), divisor, index);
        digits.push(step.digit);
        remainder = step.remainder;
    }
    let quotient = Signal::join(&digits).named("quotient");
    let exponent = a_exponent.subtracted_from(2 * i64::from(domain.bias()) - 1).named("quotient_exponent");

    let unrounded = Unrounded {
        exponent,
        significand: quotient.drop_low(1).named("significand"),
        guard: quotient.bit(0).named("guard"),
        // 1 / a ends only if a is a power of two; and that one is to be rounded up.
        sticky: graph.constant(1, 1),
        doubled: None,
    };
    let special = Special { nan: a.is_nan(), infinity: a.is_zero(), zero: a.is_infinity() };
    pack(domain, a.sign, round(domain, unrounded), special)
}
