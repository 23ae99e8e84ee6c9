//! Quotient, by restoring digit recurrence: each step subtracts the divisor once and keeps the difference if it is
//! not negative. The remainder stays exact, so the result is rounded correctly.

use super::Domain;
use super::parts::{Operand, Rounding, Special, Unrounded, pack, round};
use crate::hdl::Signal;

/// a / b.
pub fn div<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> Signal<'g> {
    let (a, b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    let sign = (a.sign ^ b.sign).named("quotient_sign");
    let (a_exponent, dividend) = a.normalised();
    let (b_exponent, divisor) = b.normalised();

    // Two significands in [1, 2) have a quotient in (1/2, 2): one digit before the point, and as many behind it as
    // make significand and guard bit when the first is 0.
    // Toward zero nobody asks for the guard bit.
    let toward_zero = domain.rounding() == Rounding::TowardZero;
    let guard_bits = u32::from(!toward_zero);
    let precision = domain.significand_bits();
    let mut remainder = dividend.extend(precision + 1);
    let mut digits = Vec::new();
    for index in 0..precision + 1 + guard_bits {
        let step = Step::new(remainder, divisor, index);
        digits.push(step.digit);
        remainder = step.remainder.append_zeros(1);
    }
    let quotient = Signal::join(&digits).named("quotient");
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

    // A quotient of p-bit significands never has exactly p + 1 bits: its product with the divisor would have more
    // than p. So a normal result is never a tie, and only a subnormal one asks whether anything is left.
    let sticky = if domain.keeps_subnormals() { remainder.any() | last_digit } else { sign.graph().constant(1, 1) };
    let unrounded = Unrounded {
        exponent,
        significand: normalised.drop_low(guard_bits).named("significand"),
        guard: if toward_zero { sign.same(0) } else { normalised.bit(0).named("guard") },
        sticky: sticky.named("sticky"),
        doubled: None,
    };
    let nan = a.is_nan() | b.is_nan() | (a.is_infinity() & b.is_infinity()) | (a.is_zero() & b.is_zero());
    let special = Special { nan, infinity: a.is_infinity() | b.is_zero(), zero: a.is_zero() | b.is_infinity() };
    pack(domain, sign, round(domain, unrounded), special)
}

/// One digit of a quotient.
pub struct Step<'g> {
    /// Whether the divisor fits.
    pub digit: Signal<'g>,
    /// What is left: less than the divisor.
    pub remainder: Signal<'g>,
}

impl<'g> Step<'g> {
    /// `remainder`, one bit wider than `divisor` and less than twice as large.
    pub fn new(remainder: Signal<'g>, divisor: Signal<'g>, index: u32) -> Self {
        let width = divisor.width();
        let difference = (remainder - divisor.extend(width + 1)).named(&format!("difference_{index}"));
        let negative = difference.msb().named(&format!("borrow_{index}"));
        Self {
            digit: (!negative).named(&format!("digit_{index}")),
            remainder: negative
                .select(remainder.low(width), difference.low(width))
                .named(&format!("remainder_{index}")),
        }
    }
}
