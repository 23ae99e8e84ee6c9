//! Reciprocal: the recurrence of the quotient with the dividend 1, of which the first two digits are known.

use super::Domain;
use super::div::Step;
use super::parts::{Operand, Rounding, Special, Unrounded, pack, round};
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

    let toward_zero = domain.rounding() == Rounding::TowardZero;
    // Behind the significand stands a guard bit, where anything asks for it.
    let guard_bits = u32::from(!toward_zero);
    let precision = domain.significand_bits();
    let digit_one = graph.constant(1, 1);
    let mut zeros = vec![graph.constant(1, 0)];
    // 2 − divisor: what the digit 1 leaves, one place further on.
    let mut step = Step::after((divisor.same(0) - divisor).extend(precision + 1), 1);
    for index in 2..precision + 1 + guard_bits {
        step = step.next(divisor, index);
        zeros.push(step.negative);
    }
    let quotient = (!Signal::join(&zeros)).named("quotient");
    let exponent = a_exponent.subtracted_from(2 * i64::from(domain.bias()) - 1).named("quotient_exponent");

    if toward_zero {
        // Nothing rounds 0.111…1 up: a power of two is a case of its own.
        let is_power = divisor.low(domain.fraction_bits()).is_zero().named("is_power_of_two");
        let fraction = quotient.low(domain.fraction_bits()).gate(!is_power);
        let unrounded = Unrounded {
            exponent,
            significand: digit_one.concat(fraction).named("significand"),
            guard: graph.constant(1, 0),
            sticky: graph.constant(1, 0),
            doubled: Some(is_power),
        };
        return finish(domain, a, unrounded);
    }
    let unrounded = Unrounded {
        exponent,
        significand: quotient.drop_low(1).named("significand"),
        guard: quotient.bit(0).named("guard"),
        // 1 / a ends only if a is a power of two; and that one is to be rounded up.
        sticky: graph.constant(1, 1),
        doubled: None,
    };
    finish(domain, a, unrounded)
}

/// The reciprocal's word: of zero it is infinity, of infinity zero.
pub fn finish<'g>(domain: Domain, a: Operand<'g>, unrounded: Unrounded<'g>) -> Signal<'g> {
    let special = Special { nan: a.is_nan(), infinity: a.is_zero(), zero: a.is_infinity() };
    pack(domain, a.sign, round(domain, unrounded), special)
}
