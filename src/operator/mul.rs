//! Product and square: the full product of the significands, normalised by at most one place, and rounded.

use super::Domain;
use super::parts::{Operand, Signed, Special, Unrounded, product, result, settled_bits, square};
use crate::hdl::Signal;

/// a · b.
pub fn mul<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> Signal<'g> {
    let (a, b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    let sign = (a.sign ^ b.sign).named("product_sign");
    let (a_exponent, a_significand) = a.normalised();
    let (b_exponent, b_significand) = b.normalised();
    let product = product(a_significand, b_significand).named("product");
    let nan = a.is_nan() | b.is_nan() | (a.is_infinity() & b.is_zero()) | (a.is_zero() & b.is_infinity());
    let special = Special { nan, infinity: a.is_infinity() | b.is_infinity(), zero: a.is_zero() | b.is_zero() };
    result(domain, sign, unrounded(domain, a_exponent, b_exponent, product), special)
}

/// a · a: fewer multiplier blocks, and no sign.
pub fn squared(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let a = Operand::unpack(a, domain, "a");
    let (exponent, significand) = a.normalised();
    let square = square(significand).named("square");
    let special = Special { nan: a.is_nan(), infinity: a.is_infinity(), zero: a.is_zero() };
    result(domain, a.sign.same(0), unrounded(domain, exponent, exponent, square), special)
}

/// Two significands in [1, 2) have a product in [1, 4).
fn unrounded<'g>(domain: Domain, a: Signed<'g>, b: Signed<'g>, product: Signal<'g>) -> Unrounded<'g> {
    let at_least_two = product.msb().named("product_at_least_two");
    // Significand and guard bit are taken from one of two places. Below the lower one, everything is sticky in both
    // cases.
    let taken = domain.significand_bits() + 1;
    let below = product.width() - taken - 1;
    let normalised = at_least_two.select(product.high(taken), product.slice(below, taken)).named("normalised");
    // Bits to which no row is added are available early, and are examined separately.
    let settled = settled_bits(domain.significand_bits()).min(below);
    let rest = [(0, settled), (settled, below - settled)].into_iter().filter(|(_, width)| *width > 0);
    let passed = at_least_two & product.bit(below);
    let sticky = rest.map(|(low, width)| product.slice(low, width).any()).reduce(|one, other| one | other);
    // The bias is 2^n − 1. The one comes in as a carry, and 2^n affects only the top bits.
    let exponent = a.plus_and_one(b).named("exponent_sum").minus_bias_and_one(domain.bias()).named("product_exponent");
    Unrounded {
        exponent,
        significand: normalised.drop_low(1).named("significand"),
        guard: normalised.bit(0).named("guard"),
        sticky: sticky.map_or(passed, |sticky| sticky | passed).named("sticky"),
        doubled: Some(at_least_two),
    }
}
