//! Product and square: significands multiplied whole, normalised by at most one place, rounded.

use super::Domain;
use super::parts::{Operand, Signed, Special, Unrounded, pack, product, round, square};
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
    pack(domain, sign, round(domain, unrounded(domain, a_exponent, b_exponent, product)), special)
}

/// a · a: fewer multiplier blocks, and no sign.
pub fn squared(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let a = Operand::unpack(a, domain, "a");
    let (exponent, significand) = a.normalised();
    let square = square(significand).named("square");
    let special = Special { nan: a.is_nan(), infinity: a.is_infinity(), zero: a.is_zero() };
    pack(domain, a.sign.same(0), round(domain, unrounded(domain, exponent, exponent, square)), special)
}

/// Two significands in [1, 2) have a product in [1, 4).
fn unrounded<'g>(domain: Domain, a: Signed<'g>, b: Signed<'g>, product: Signal<'g>) -> Unrounded<'g> {
    let at_least_two = product.msb().named("product_at_least_two");
    let width = product.width();
    let normalised = at_least_two.select(product, product.low(width - 1).append_zeros(1)).named("normalised");
    // The bias is 2^n - 1: the one comes in as a carry, and of 2^n only the top bits know.
    let exponent = a.plus_and_one(b).named("exponent_sum").minus_bias_and_one(domain.bias()).named("product_exponent");
    let fraction_bits = domain.fraction_bits();
    Unrounded {
        exponent,
        significand: normalised.high(domain.significand_bits()).named("significand"),
        guard: normalised.bit(fraction_bits).named("guard"),
        sticky: normalised.low(fraction_bits).any().named("sticky"),
        doubled: Some(at_least_two),
    }
}
