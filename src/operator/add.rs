//! Sum and difference, on a single path: order by exponent, align, add or subtract, normalise, round.

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
    let [a_exponent, b_exponent] = [a.effective_exponent(), b.effective_exponent()];
    let more = to.fraction_bits() - domain.fraction_bits();
    let order = Order::by(a_exponent, b_exponent, domain.significand_bits() + more + 2);
    let choose = |if_b, if_a, name: &str| order.b_is_above.select(if_b, if_a).named(name);
    let [a_significand, b_significand] = [a.true_significand(), b.true_significand()];
    let large_exponent = choose(b_exponent, a_exponent, "large_exponent");
    // Below the significand are a guard bit, a round bit and the sticky bit; above it is the carry.
    let small_significand = order.small(a_significand, b_significand, more + 2);
    let (mut aligned, mut sticky) = shift_right_sticky(small_significand, order.distance, "align");
    if !domain.keeps_subnormals() && !domain.is_normal() {
        // The fraction of a flushed number does not count. It is removed here, where this is cheap.
        let small_is_zero = choose(a.is_zero(), b.is_zero(), "small_is_zero");
        (aligned, sticky) = (aligned.gate(!small_is_zero), sticky & !small_is_zero);
    }
    // Of two numbers with the same exponent b may be the larger one, and a is then subtracted from it: b + ~a + 1. The
    // one takes the place of the sticky bit.
    let b_is_larger = a_significand.less_than(b_significand).named("b_significand_is_larger");
    let is_reversed = (effective_subtraction & order.is_level & b_is_larger).named("is_reversed");
    let last = (sticky | is_reversed).named("addend_last");
    let addend = aligned.concat(last).extend(to.significand_bits() + 4).named("addend");
    let [a_augend, b_augend] = [a_significand, b_significand].map(|it| it ^ is_reversed.repeat(it.width()));
    let augend = choose(b_augend, a_augend, "augend_significand");
    let augend = Signal::join(&[is_reversed, augend, is_reversed.repeat(more + 3)]).named("augend");
    let is_sum = (!effective_subtraction | is_reversed).named("is_sum");
    let sum = augend.minus_or_plus(addend, is_sum).named("sum");
    let large_sign = (choose(b.sign, a.sign, "first_sign") ^ is_reversed).named("large_sign");

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

/// Two numbers in the order of their exponents.
struct Order<'g> {
    /// One bit: b has the larger exponent.
    b_is_above: Signal<'g>,
    /// One bit: the exponents are equal.
    is_level: Signal<'g>,
    /// The places by which [`Order::small`] has to be shifted.
    distance: Signal<'g>,
}

impl<'g> Order<'g> {
    /// By the exponents alone. The value that is shifted has `moved_bits`.
    fn by(a_exponent: Signal<'g>, b_exponent: Signal<'g>, moved_bits: u32) -> Self {
        let bits = a_exponent.width();
        let difference = (a_exponent.extend(bits + 1) - b_exponent.extend(bits + 1)).named("exponent_difference");
        let b_is_above = difference.msb().named("b_is_above");
        let is_level = difference.low(bits).is_zero().named("exponents_are_equal");
        // The complement of a difference below zero is its magnitude less one. Whether either is too large for the
        // distance is known beside its sign.
        let levels = distance_bits(moved_bits).min(bits);
        let near = (difference.low(levels) ^ b_is_above.repeat(levels)).named("align_near");
        let distance = if levels < bits {
            let high = difference.slice(levels, bits - levels);
            let [above, below] = [high.any().named("a_is_far_above"), (!high.all()).named("b_is_far_above")];
            let far = b_is_above.select(below, above).named("align_far");
            (near | far.repeat(levels)).named("align_distance")
        } else {
            near.named("align_distance")
        };
        Self { b_is_above, is_level, distance }
    }

    /// The significand of the number with the smaller exponent, followed by this number of bits. It is one place
    /// further on if the distance is one less than the exponents say.
    fn small(&self, a: Signal<'g>, b: Signal<'g>, more: u32) -> Signal<'g> {
        let one_on = a.append_zeros(more - 1).extend(a.width() + more);
        self.b_is_above.select(one_on, b.append_zeros(more)).named("small_significand")
    }
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
    let order = Order::by(a.exponent, b.exponent, domain.significand_bits() + 1);
    let choose = |if_b, if_a, name: &str| order.b_is_above.select(if_b, if_a).named(name);
    let [a_significand, b_significand] = [a.true_significand(), b.true_significand()];
    let large_exponent = choose(b.exponent, a.exponent, "large_exponent");
    let augend = choose(b_significand, a_significand, "large_significand");
    let (aligned, below) = shift_right_sticky(order.small(a_significand, b_significand, 1), order.distance, "align");

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
