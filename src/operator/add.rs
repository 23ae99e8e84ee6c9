//! Sum and difference, on a single path: order by magnitude, align, add or subtract, normalise, round.

use super::parts::{
    Operand, Rounded, Rounding, Signed, Special, Unrounded, leading_zeros, pack, round_so, shift_left,
    shift_right_sticky,
};
use crate::hdl::Signal;
use crate::number::Format;

/// a + b, or a − b where `subtract`; to odd, only for results that do not leave the normal range. An exact zero is +0 unless both terms are −0 (IEEE 754-2019, clause 6.3).
pub fn add<'g>(a: Signal<'g>, b: Signal<'g>, format: Format, subtract: bool, rounding: Rounding) -> Signal<'g> {
    let (a, mut b) = (Operand::unpack(a, format, "a"), Operand::unpack(b, format, "b"));
    if subtract {
        b.sign = (!b.sign).named("b_sign_inverted");
    }
    let effective_subtraction = (a.sign ^ b.sign).named("effective_subtraction");

    let b_is_larger = a.magnitude().less_than(b.magnitude()).named("b_is_larger");
    let choose = |if_b, if_a, name: &str| b_is_larger.select(if_b, if_a).named(name);
    let large_sign = choose(b.sign, a.sign, "large_sign");
    let large_exponent = choose(b.effective_exponent(), a.effective_exponent(), "large_exponent");
    let small_exponent = choose(a.effective_exponent(), b.effective_exponent(), "small_exponent");
    let large_significand = choose(b.significand(), a.significand(), "large_significand");
    let small_significand = choose(a.significand(), b.significand(), "small_significand");

    // Below the significand stand a guard bit, a round bit and the sticky bit; above it the carry.
    let exponent_difference = (large_exponent - small_exponent).named("exponent_difference");
    let (mut aligned, mut sticky) = shift_right_sticky(small_significand.append_zeros(2), exponent_difference, "align");
    if !format.keeps_subnormals() {
        // A zero's significand has a leading bit too: dropped here, where it is cheap.
        let small_is_zero = b_is_larger.select(a.is_zero(), b.is_zero()).named("small_is_zero");
        (aligned, sticky) = (aligned.gate(!small_is_zero), sticky & !small_is_zero);
    }
    let width = format.significand_bits() + 4;
    let addend = aligned.concat(sticky.named("aligned_sticky")).extend(width).named("addend");
    let augend = large_significand.append_zeros(3).extend(width).named("augend");
    // One adder does both: the complement, and a carry into an extra lowest bit.
    let complemented = (addend ^ effective_subtraction.repeat(width)).named("complemented");
    let one = augend.graph().constant(1, 1);
    let sum = (augend.concat(one) + complemented.concat(effective_subtraction)).named("sum_and_carry_in");
    let sum = sum.drop_low(1).named("sum");

    let (zeros, sum_is_zero) = leading_zeros(sum, "sum");
    let normaliser = Normaliser { format, rounding, sum, large_exponent, zeros: zeros.named("leading_zeros") };
    let rounded = if format.keeps_subnormals() { normaliser.gradual() } else { normaliser.flushed() };

    let is_zero = match format.keeps_subnormals() {
        true => sum_is_zero,
        false => sum_is_zero | (a.is_zero() & b.is_zero()),
    };
    let is_exact_zero = is_zero.named("is_exact_zero");
    let both_infinite = a.is_infinity() & b.is_infinity();
    let special = Special {
        nan: a.is_nan() | b.is_nan() | (both_infinite & effective_subtraction),
        infinity: a.is_infinity() | b.is_infinity(),
        zero: is_exact_zero,
    };
    let sign = large_sign & !(is_exact_zero & effective_subtraction);
    pack(format, sign, rounded, special)
}

/// What remains after the addition: the leading one to the top, the exponent to match, and rounding.
struct Normaliser<'g> {
    format: Format,
    rounding: Rounding,
    /// Carry, significand, and three bits.
    sum: Signal<'g>,
    large_exponent: Signal<'g>,
    zeros: Signal<'g>,
}

impl<'g> Normaliser<'g> {
    /// With subnormals the shift ends where the exponent does. What is then not normal is exact.
    fn gradual(self) -> Rounded<'g> {
        let exponent_bits = self.format.exponent_bits();
        let width = exponent_bits.max(self.zeros.width());
        let is_subnormal = self.large_exponent.extend(width).less_than(self.zeros.extend(width)).named("is_subnormal");
        let limit = self.large_exponent.extend(width).low(self.zeros.width());
        let distance = is_subnormal.select(limit, self.zeros).named("normalise_distance");
        let exponent = (self.large_exponent.plus(1).extend(width) - self.zeros.extend(width)).low(exponent_bits);
        let exponent = exponent.gate(!is_subnormal).named("normalised_exponent");
        let (significand, guard, sticky) = self.shift(distance);
        let fraction = significand.low(self.format.fraction_bits());
        let never = guard.graph().constant(1, 0);
        Rounded {
            magnitude: self.rounding.apply(exponent, fraction, guard, sticky),
            overflow: exponent.all().named("overflow"),
            underflow: never,
        }
    }

    /// Without subnormals the exponent may go below its end; rounding then flushes.
    fn flushed(self) -> Rounded<'g> {
        let largest = i64::from(self.format.special_exponent()) - 1;
        let exponent = Signed::unsigned(self.large_exponent, 1, largest)
            .offset(1)
            .minus(Signed::unsigned(self.zeros, 0, i64::from(self.sum.width()) - 1))
            .named("normalised_exponent");
        let (significand, guard, sticky) = self.shift(self.zeros);
        round_so(self.format, Unrounded { exponent, significand, guard, sticky }, self.rounding)
    }

    /// Significand, guard and sticky bit of the sum shifted left.
    fn shift(&self, distance: Signal<'g>) -> (Signal<'g>, Signal<'g>, Signal<'g>) {
        let normalised = shift_left(self.sum, distance, "normalise").named("normalised");
        let significand = normalised.high(self.format.significand_bits()).named("significand");
        (significand, normalised.bit(3).named("guard"), normalised.low(3).any().named("sticky"))
    }
}
