//! Quotient, by digit recurrence without restoring: each step adds or subtracts the divisor once. The remainder stays
//! exact, so the result is rounded correctly.

use super::Domain;
use super::parts::{Operand, Rounding, Special, Unrounded, result};
use crate::hdl::Signal;

/// a / b.
pub fn div<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> Signal<'g> {
    let (a, b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    let sign = (a.sign ^ b.sign).named("quotient_sign");
    let (a_exponent, dividend) = a.normalised();
    let (b_exponent, divisor) = b.normalised();

    // The quotient of two significands in [1, 2) is in (1/2, 2). So there is one digit before the point, and as many
    // after it as significand and guard bit need if the first digit is 0. Rounding toward zero needs no guard bit.
    let toward_zero = domain.rounding() == Rounding::TowardZero;
    let guard_bits = u32::from(!toward_zero);
    let precision = domain.significand_bits();
    let mut step = Step::after(dividend.extend(precision + 1) - divisor.extend(precision + 1), 0);
    let mut zeros = vec![step.negative];
    for index in 1..precision + 1 + guard_bits {
        step = step.next(divisor, index);
        zeros.push(step.negative);
    }
    let quotient = (!Signal::join(&zeros)).named("quotient");
    let at_least_one = quotient.msb().named("quotient_at_least_one");
    let normalised = at_least_one
        .select(quotient.high(precision + guard_bits), quotient.low(precision + guard_bits))
        .named("normalised");
    let last_digit = at_least_one & quotient.bit(0);
    let exponent = a_exponent
        .minus(b_exponent)
        .named("exponent_difference")
        .offset(i64::from(domain.bias()) - 1)
        .plus_bit(at_least_one)
        .named("quotient_exponent");

    // A quotient of p-bit significands never has exactly p + 1 bits, because its product with the divisor would have
    // more than p. So a normal result is never a tie, and only a subnormal one needs to know whether there is a
    // remainder.
    let sticky =
        if domain.keeps_subnormals() { step.is_inexact(divisor) | last_digit } else { sign.graph().constant(1, 1) };
    let unrounded = Unrounded {
        exponent,
        significand: normalised.drop_low(guard_bits).named("significand"),
        guard: if toward_zero { sign.same(0) } else { normalised.bit(0).named("guard") },
        sticky: sticky.named("sticky"),
        doubled: None,
    };
    let nan = a.is_nan() | b.is_nan() | (a.is_infinity() & b.is_infinity()) | (a.is_zero() & b.is_zero());
    let special = Special { nan, infinity: a.is_infinity() | b.is_zero(), zero: a.is_zero() | b.is_infinity() };
    result(domain, sign, unrounded, special)
}

/// One digit of a quotient, without restoring. The partial remainder is kept even if it is negative, and after a
/// negative one the divisor is added instead. The signs are the same as with restoring, so the digits are the
/// complemented digits of the quotient. A digit costs only one carry chain.
#[derive(Clone, Copy)]
pub struct Step<'g> {
    /// The partial remainder: at least −divisor and less than it, in two's complement with one bit more than it.
    pub partial: Signal<'g>,
    /// True if it is negative: the divisor does not fit, and the digit is 0.
    pub negative: Signal<'g>,
}

impl<'g> Step<'g> {
    /// `partial`, which is what remains after digit `index`.
    pub fn after(partial: Signal<'g>, index: u32) -> Self {
        let partial = partial.named(&format!("partial_{index}"));
        Self { partial, negative: partial.msb() }
    }

    /// The next digit, from twice the partial remainder.
    pub fn next(self, divisor: Signal<'g>, index: u32) -> Self {
        let doubled = self.partial.low(divisor.width()).append_zeros(1);
        Self::after(doubled.minus_or_plus(divisor.extend(doubled.width()), self.negative), index)
    }

    /// True if there is a remainder. A negative partial remainder is the true one minus the divisor.
    pub fn is_inexact(self, divisor: Signal<'g>) -> Signal<'g> {
        let restored = self.partial + divisor.extend(self.partial.width()).gate(self.negative);
        restored.any()
    }
}
