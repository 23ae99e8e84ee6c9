//! Product: significands multiplied whole, normalised by at most one place, rounded.

use super::parts::{Operand, Special, Unrounded, pack, product, round};
use crate::hdl::Signal;
use crate::number::Format;

/// a · b.
pub fn mul<'g>(a: Signal<'g>, b: Signal<'g>, format: Format) -> Signal<'g> {
    let (a, b) = (Operand::unpack(a, format, "a"), Operand::unpack(b, format, "b"));
    let sign = (a.sign ^ b.sign).named("product_sign");
    let (a_exponent, a_significand) = a.normalised();
    let (b_exponent, b_significand) = b.normalised();

    // Two significands in [1, 2) have a product in [1, 4).
    let product = product(a_significand, b_significand).named("product");
    let at_least_two = product.msb().named("product_at_least_two");
    let width = product.width();
    let normalised = at_least_two.select(product, product.low(width - 1).append_zeros(1)).named("normalised");
    let exponent = a_exponent
        .plus(b_exponent)
        .named("exponent_sum")
        .offset(-i64::from(format.bias()))
        .named("exponent_below_two")
        .plus_bit(at_least_two)
        .named("product_exponent");

    let fraction_bits = format.fraction_bits();
    let unrounded = Unrounded {
        exponent,
        significand: normalised.high(format.significand_bits()).named("significand"),
        guard: normalised.bit(fraction_bits).named("guard"),
        sticky: normalised.low(fraction_bits).any().named("sticky"),
    };
    let nan = a.is_nan() | b.is_nan() | (a.is_infinity() & b.is_zero()) | (a.is_zero() & b.is_infinity());
    let special = Special { nan, infinity: a.is_infinity() | b.is_infinity(), zero: a.is_zero() | b.is_zero() };
    pack(format, sign, round(format, unrounded), special)
}
