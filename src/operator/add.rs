//! Sum and difference, on a single path: order by magnitude, align, add or subtract, normalise, round.

use super::Domain;
use super::parts::{
    Operand, Rounded, Rounding, Signed, Special, Unrounded, leading_zeros, normalise, pack, round, round_so,
    shift_left, shift_right_sticky,
};
use crate::hdl::Signal;

/// a + b, or a − b where `subtract`; to odd, only for results that do not leave the normal range. An exact zero
/// is +0 unless both terms are −0 (IEEE 754-2019, clause 6.3).
pub fn add<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain, subtract: bool, rounding: Rounding) -> Signal<'g> {
    let (a, mut b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    if subtract {
        b.sign = (!b.sign).named("b_sign_inverted");
    }
    let effective_subtraction = (a.sign ^ b.sign).named("effective_subtraction");

    let b_is_larger = a.magnitude().less_than(b.magnitude()).named("b_is_larger");
    let choose = |if_b, if_a, name: &str| b_is_larger.select(if_b, if_a).named(name);
    let large_sign = choose(b.sign, a.sign, "large_sign");
    let large_exponent = choose(b.effective_exponent(), a.effective_exponent(), "large_exponent");
    let small_exponent = choose(a.effective_exponent(), b.effective_exponent(), "small_exponent");
    let large_significand = choose(b.true_significand(), a.true_significand(), "large_significand");
    let small_significand = choose(a.true_significand(), b.true_significand(), "small_significand");

    // Below the significand stand a guard bit, a round bit and the sticky bit; above it the carry.
    let exponent_difference = (large_exponent - small_exponent).named("exponent_difference");
    let (mut aligned, mut sticky) = shift_right_sticky(small_significand.append_zeros(2), exponent_difference, "align");
    if !domain.keeps_subnormals() && !domain.is_normal() {
        // A flushed number's fraction does not count: dropped here, where it is cheap.
        let small_is_zero = b_is_larger.select(a.is_zero(), b.is_zero()).named("small_is_zero");
        (aligned, sticky) = (aligned.gate(!small_is_zero), sticky & !small_is_zero);
    }
    let width = domain.significand_bits() + 4;
    let addend = aligned.concat(sticky.named("aligned_sticky")).extend(width).named("addend");
    let augend = large_significand.append_zeros(3).extend(width).named("augend");
    let sum = augend.minus_or_plus(addend, !effective_subtraction).named("sum");

    let (rounded, sum_is_zero) = match domain.keeps_subnormals() {
        true => gradual(domain, rounding, sum, large_exponent),
        false => flushed(domain, rounding, sum, large_exponent),
    };
    let is_zero = if domain.keeps_subnormals() || domain.is_normal() {
        sum_is_zero
    } else {
        sum_is_zero | (a.is_zero() & b.is_zero())
    };
    let is_exact_zero = is_zero.named("is_exact_zero");
    let both_infinite = a.is_infinity() & b.is_infinity();
    let special = Special {
        nan: a.is_nan() | b.is_nan() | (both_infinite & effective_subtraction),
        infinity: a.is_infinity() | b.is_infinity(),
        zero: is_exact_zero,
    };
    let sign = large_sign & !(is_exact_zero & effective_subtraction);
    pack(domain, sign, rounded, special)
}

/// Normalises and rounds `sum`, which is carry, significand and three bits. With subnormals the shift ends where the
/// exponent does; what is then not normal is exact. Also tells whether the sum is zero.
fn gradual<'g>(
    domain: Domain,
    rounding: Rounding,
    sum: Signal<'g>,
    large_exponent: Signal<'g>,
) -> (Rounded<'g>, Signal<'g>) {
    let (zeros, sum_is_zero) = leading_zeros(sum, "sum");
    let zeros = zeros.named("leading_zeros");
    let exponent_bits = domain.exponent_bits();
    let width = exponent_bits.max(zeros.width());
    let is_subnormal = large_exponent.extend(width).less_than(zeros.extend(width)).named("is_subnormal");
    let limit = large_exponent.extend(width).low(zeros.width());
    let distance = is_subnormal.select(limit, zeros).named("normalise_distance");
    let exponent = (large_exponent.plus(1).extend(width) - zeros.extend(width)).low(exponent_bits);
    let exponent = exponent.gate(!is_subnormal).named("normalised_exponent");
    let (significand, guard, sticky) = taken(domain, shift_left(sum, distance, "normalise").named("normalised"));
    let fraction = significand.low(domain.fraction_bits());
    let rounded = Rounded {
        magnitude: rounding.apply(exponent, fraction, guard, sticky),
        overflow: exponent.all().named("overflow"),
        underflow: guard.same(0),
    };
    (rounded, sum_is_zero)
}

/// The same without subnormals: the exponent may go below its end; rounding then flushes.
fn flushed<'g>(
    domain: Domain,
    rounding: Rounding,
    sum: Signal<'g>,
    large_exponent: Signal<'g>,
) -> (Rounded<'g>, Signal<'g>) {
    let normalised = normalise(sum, "normalise");
    let largest = i64::from(domain.special_exponent()) - 1;
    let exponent = Signed::unsigned(large_exponent, 1, largest)
        .offset(1)
        .minus(Signed::unsigned(normalised.zeros.named("leading_zeros"), 0, i64::from(sum.width()) - 1))
        .named("normalised_exponent");
    let (significand, guard, sticky) = taken(domain, normalised.value.named("normalised"));
    let unrounded = Unrounded { exponent, significand, guard, sticky, doubled: None };
    (round_so(domain, unrounded, rounding), !normalised.value.msb())
}

/// Significand, guard and sticky bit of a normalised sum.
fn taken<'g>(domain: Domain, normalised: Signal<'g>) -> (Signal<'g>, Signal<'g>, Signal<'g>) {
    let significand = normalised.high(domain.significand_bits()).named("significand");
    (significand, normalised.bit(3).named("guard"), normalised.low(3).any().named("sticky"))
}

/// a + b of numbers that are zero or normal and not negative: the sum is normalised by at most one place, and the
/// exponents alone tell which is to be aligned.
pub fn add_magnitudes<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> Signal<'g> {
    let (a, b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    let b_is_larger = a.exponent.less_than(b.exponent).named("b_is_larger");
    let choose = |if_b, if_a, name: &str| b_is_larger.select(if_b, if_a).named(name);
    let large_exponent = choose(b.exponent, a.exponent, "large_exponent");
    let small_exponent = choose(a.exponent, b.exponent, "small_exponent");
    let augend = choose(b.true_significand(), a.true_significand(), "large_significand");
    let small_significand = choose(a.true_significand(), b.true_significand(), "small_significand");
    let exponent_difference = (large_exponent - small_exponent).named("exponent_difference");
    let (aligned, below) = shift_right_sticky(small_significand.append_zeros(1), exponent_difference, "align");

    // What lies below the larger significand passes by the adder.
    let width = domain.significand_bits() + 1;
    let sum = (augend.extend(width) + aligned.drop_low(1).extend(width)).named("sum");
    let carry = sum.msb().named("carry");
    let first = aligned.bit(0).named("aligned_guard");
    let significand = carry.select(sum.drop_low(1), sum.low(width - 1)).named("significand");
    let largest = i64::from(domain.special_exponent()) - 1;
    let unrounded = Unrounded {
        exponent: Signed::unsigned(large_exponent, 0, largest),
        significand,
        guard: carry.select(sum.bit(0), first).named("guard"),
        sticky: (below | (carry & first)).named("sticky"),
        doubled: Some(carry),
    };
    // Of two zeros all this is zero.
    let special = Special { nan: carry.same(0), infinity: carry.same(0), zero: carry.same(0) };
    pack(domain, a.sign & b.sign, round(domain, unrounded), special)
}
