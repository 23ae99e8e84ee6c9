//! Sum and difference, on a single path: order by magnitude, align, add or subtract, normalise, round.

use super::Domain;
use super::parts::{
    Fields, Operand, Rounding, Signed, Special, Unrounded, distance_bits, leading_zeros, normalise, pack, result,
    round, shift_left, shift_right_sticky,
};
use crate::hdl::Signal;

/// a + b, or a − b if `subtract` is set. Rounding to odd is only for results within the normal range. An exact zero is
/// +0 unless both terms are −0 (IEEE 754-2019, clause 6.3).
pub fn add<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain, subtract: bool, rounding: Rounding) -> Signal<'g> {
    add_to(a, b, domain, domain, subtract, rounding)
}

/// The same with the result in another domain, in which every finite sum is zero or normal and no operand loses a bit
/// ([`super::widening::is_direct`]).
pub fn add_to<'g>(
    a: Signal<'g>,
    b: Signal<'g>,
    domain: Domain,
    to: Domain,
    subtract: bool,
    rounding: Rounding,
) -> Signal<'g> {
    let (a, mut b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    if subtract {
        b.sign = (!b.sign).named("b_sign_inverted");
    }
    let effective_subtraction = (a.sign ^ b.sign).named("effective_subtraction");

    let b_is_larger = a.magnitude().less_than(b.magnitude()).named("b_is_larger");
    let choose = |if_b, if_a, name: &str| b_is_larger.select(if_b, if_a).named(name);
    // Both differences are computed beside the comparison, so that the right one is available as soon as it is known.
    let [a_exponent, b_exponent] = [a.effective_exponent(), b.effective_exponent()];
    let more = to.fraction_bits() - domain.fraction_bits();
    let differences = [a_exponent - b_exponent, b_exponent - a_exponent];
    let align_distance = align_distance(differences, b_is_larger, domain.significand_bits() + more + 2);
    let large_sign = choose(b.sign, a.sign, "large_sign");
    let large_exponent = choose(b_exponent, a_exponent, "large_exponent");
    let large_significand = choose(b.true_significand(), a.true_significand(), "large_significand");
    let small_significand = choose(a.true_significand(), b.true_significand(), "small_significand");
    let [large_significand, small_significand] = [large_significand, small_significand].map(|it| it.append_zeros(more));

    // Below the significand are a guard bit, a round bit and the sticky bit; above it is the carry.
    let (mut aligned, mut sticky) = shift_right_sticky(small_significand.append_zeros(2), align_distance, "align");
    if !domain.keeps_subnormals() && !domain.is_normal() {
        // The fraction of a flushed number does not count. It is removed here, where this is cheap.
        let small_is_zero = b_is_larger.select(a.is_zero(), b.is_zero()).named("small_is_zero");
        (aligned, sticky) = (aligned.gate(!small_is_zero), sticky & !small_is_zero);
    }
    let width = to.significand_bits() + 4;
    let addend = aligned.concat(sticky.named("aligned_sticky")).extend(width).named("addend");
    let augend = large_significand.append_zeros(3).extend(width).named("augend");
    let sum = augend.minus_or_plus(addend, !effective_subtraction).named("sum");

    let is_gradual = domain.keeps_subnormals() && to == domain;
    let (fields, sum_is_zero) = match is_gradual {
        true => gradual(domain, rounding, sum, large_exponent),
        false => flushed(domain, to, rounding, sum, large_exponent),
    };
    let both_zero =
        if domain.keeps_subnormals() || domain.is_normal() { sum_is_zero.same(0) } else { a.is_zero() & b.is_zero() };
    let is_exact_zero = (sum_is_zero | both_zero).named("is_exact_zero");
    let both_infinite = a.is_infinity() & b.is_infinity();
    let special = Special {
        nan: a.is_nan() | b.is_nan() | (both_infinite & effective_subtraction),
        infinity: a.is_infinity() | b.is_infinity(),
        // A sum of zero has an empty fraction, and the exponent is right by itself except for results that may
        // underflow.
        zero: if is_gradual || to.is_normal() { both_zero } else { is_exact_zero },
    };
    let sign = large_sign & !(is_exact_zero & effective_subtraction);
    pack(to, sign, fields, special)
}

/// The distance by which the smaller number is shifted: the right one of both exponent differences, in the bits that a
/// value of `moved_bits` needs. For each difference it is known beforehand whether it is too large for them.
fn align_distance<'g>(differences: [Signal<'g>; 2], b_is_larger: Signal<'g>, moved_bits: u32) -> Signal<'g> {
    let [a_minus_b, b_minus_a] = differences;
    let (a_minus_b, b_minus_a) = (a_minus_b.named("a_exponent_minus_b"), b_minus_a.named("b_exponent_minus_a"));
    let bits = distance_bits(moved_bits);
    if a_minus_b.width() <= bits {
        return b_is_larger.select(b_minus_a, a_minus_b).named("align_distance");
    }
    let near = b_is_larger.select(b_minus_a.low(bits), a_minus_b.low(bits)).named("align_near");
    let is_far = |difference: Signal<'g>, name: &str| difference.drop_low(bits).any().named(name);
    let a_is_far = is_far(a_minus_b, "a_is_far_above");
    let b_is_far = is_far(b_minus_a, "b_is_far_above");
    let far = b_is_larger.select(b_is_far, a_is_far).named("align_far");
    (near | far.repeat(bits)).named("align_distance")
}

/// Normalises and rounds `sum`, which is carry, significand and three bits. With subnormals, the shift ends where the
/// exponent does, and a result that is then not normal is exact. Also returns whether the sum is zero.
fn gradual<'g>(
    domain: Domain,
    rounding: Rounding,
    sum: Signal<'g>,
    large_exponent: Signal<'g>,
) -> (Fields<'g>, Signal<'g>) {
    let sum_is_zero = sum.is_zero().named("sum_is_zero");
    // A one at the leading bit of the smallest normal number. Counting ends there, so the count is the distance.
    let count_bits = u32::BITS - (sum.width() - 1).leading_zeros();
    let long_exponent = large_exponent.extend(large_exponent.width().max(count_bits + 1));
    let is_near = long_exponent.drop_low(count_bits).is_zero().named("end_is_near");
    let ends = long_exponent.low(count_bits).one_hot().named("exponent_one_hot").low(sum.width());
    let ends: Vec<_> = (0..sum.width()).map(|place| ends.bit(place) & is_near).collect();
    let end = Signal::join(&ends).named("exponent_end");
    let (distance, _) = leading_zeros((sum | end).named("sum_or_end"), "sum");
    let distance = distance.named("normalise_distance");
    let normalised = shift_left(sum, distance, "normalise").named("normalised");
    let exponent_bits = domain.exponent_bits();
    let width = exponent_bits.max(distance.width());
    let exponent = (large_exponent.plus(1).extend(width) - distance.extend(width)).low(exponent_bits);
    // A result without its leading one is subnormal or zero.
    let exponent = exponent.gate(normalised.msb()).named("normalised_exponent");
    let (significand, guard, sticky) = taken(domain, normalised);
    let fields = Fields {
        exponent,
        fraction: significand.low(domain.fraction_bits()),
        guard,
        sticky,
        doubled: None,
        rounding,
        overflow: exponent.all().named("overflow"),
        underflow: guard.same(0),
    };
    (fields, sum_is_zero)
}

/// The same without subnormals: the exponent may go below its end, and rounding then flushes. The exponent of `from` is
/// converted to that of `domain`.
fn flushed<'g>(
    from: Domain,
    domain: Domain,
    rounding: Rounding,
    sum: Signal<'g>,
    large_exponent: Signal<'g>,
) -> (Fields<'g>, Signal<'g>) {
    let normalised = normalise(sum, "normalise");
    let largest = i64::from(from.special_exponent()) - 1;
    let exponent = Signed::unsigned(large_exponent, 1, largest)
        .offset(1 + i64::from(domain.bias() - from.bias()))
        .minus(Signed::unsigned(normalised.zeros.named("leading_zeros"), 0, i64::from(sum.width()) - 1))
        .named("normalised_exponent");
    let (significand, guard, sticky) = taken(domain, normalised.value.named("normalised"));
    let is_zero = !normalised.value.msb();
    let exponent = if domain.is_normal() { exponent.gate(!is_zero).named("result_exponent") } else { exponent };
    let unrounded = Unrounded { exponent, significand, guard, sticky, doubled: None };
    (round(domain, unrounded, rounding), is_zero)
}

/// Significand, guard and sticky bit of a normalised sum.
fn taken<'g>(domain: Domain, normalised: Signal<'g>) -> (Signal<'g>, Signal<'g>, Signal<'g>) {
    let significand = normalised.high(domain.significand_bits()).named("significand");
    (significand, normalised.bit(3).named("guard"), normalised.low(3).any().named("sticky"))
}

/// a + b of numbers that are zero or normal and not negative. The sum is normalised by at most one place, and the
/// exponents alone decide which number is aligned.
pub fn add_magnitudes<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> Signal<'g> {
    let (a, b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    // Both differences. The borrow tells which one is right.
    let width = domain.exponent_bits() + 1;
    let a_less_b = a.exponent.extend(width) - b.exponent.extend(width);
    let b_is_larger = a_less_b.msb().named("b_is_larger");
    let differences = [a_less_b.low(width - 1), b.exponent - a.exponent];
    let align_distance = align_distance(differences, b_is_larger, domain.significand_bits() + 1);
    let choose = |if_b, if_a, name: &str| b_is_larger.select(if_b, if_a).named(name);
    let large_exponent = choose(b.exponent, a.exponent, "large_exponent");
    let augend = choose(b.true_significand(), a.true_significand(), "large_significand");
    let small_significand = choose(a.true_significand(), b.true_significand(), "small_significand");
    let (aligned, below) = shift_right_sticky(small_significand.append_zeros(1), align_distance, "align");

    // The bits below the larger significand bypass the adder.
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
    // If both are zero, all of this is zero.
    let special = Special { nan: carry.same(0), infinity: carry.same(0), zero: carry.same(0) };
    result(domain, a.sign & b.sign, unrounded, special)
}
