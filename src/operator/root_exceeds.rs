//! Compares the rounded root of one number with another number, without computing the root.
//!
//! RN(√a) > b exactly if a > (b + ½ulp(b))², or if both are equal and b is odd. The middle between b and the next
//! number has one bit more than b, and its square is exact. For rounding toward zero, the next number replaces the
//! middle, and a ≥ its square decides.

use super::Domain;
use super::parts::{Operand, Rounding, Signed, leading_zeros, shift_left, square};
use crate::hdl::Signal;

/// √a, rounded, > b. False if an operand is a NaN or a has no root, and true if b is negative and a has a root.
pub fn root_exceeds<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> Signal<'g> {
    let (a, b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    let a_exceeds = finite_exceeds(&a, &b, domain).named("finite_exceeds");

    let no_root = (a.is_nan() | (a.sign & !a.is_zero())).named("no_root");
    let b_is_negative = (b.sign & !b.is_zero()).named("b_is_negative");
    let among_positive = !a.is_zero() & !b.is_infinity() & (a.is_infinity() | a_exceeds);
    (b_is_negative | among_positive) & !no_root & !b.is_nan()
}

/// The decision for finite positive a and finite b ≥ 0.
fn finite_exceeds<'g>(a: &Operand<'g>, b: &Operand<'g>, domain: Domain) -> Signal<'g> {
    let (a_exponent, a_significand) = a.normalised();
    let Middle { exponent, significand: middle, certain } = Middle::above(b, domain);
    let square = square(middle).named("square");
    let at_least_two = square.msb().named("square_at_least_two");
    let normalised = at_least_two.select(square, square.low(square.width() - 1).append_zeros(1));
    let precision = domain.significand_bits();
    let high = normalised.high(precision).named("square_high");

    // The difference of a's exponent and that of a square below 2.
    let lead = a_exponent.minus(exponent.twice()).offset(i64::from(domain.bias())).named("exponent_lead");
    let above = at_least_two.select(lead.at_least(2), lead.at_least(1)).named("exponent_is_above");
    let level = at_least_two.select(lead.is(1), lead.is(0)).named("exponent_is_level");
    let mut significand_above = a_significand.greater_than(high).named("significand_is_above");
    if domain.rounding() == Rounding::TowardZero {
        let rest = normalised.low(normalised.width() - precision);
        let level = a_significand.equals(high) & rest.is_zero();
        significand_above = (significand_above | level).named("significand_is_not_below");
    } else if !subnormal_squares_vanish(domain) {
        // The square of an odd number is odd, so a tie needs a middle that ends in zeros, as of a subnormal.
        let rest = normalised.low(normalised.width() - precision);
        let tie = a_significand.equals(high) & rest.is_zero();
        significand_above = significand_above | (tie & b.fraction.bit(0)).named("tie_above_odd");
    }
    certain | above | (level & significand_above)
}

/// True if the square of every middle below the smallest normal number is less than the smallest positive number.
fn subnormal_squares_vanish(domain: Domain) -> bool {
    !domain.keeps_subnormals() || domain.min_exponent() <= -(domain.fraction_bits() as i32)
}

/// The middle between a number and the next one up, or the next number itself: biased exponent, and significand with
/// its leading bit set.
struct Middle<'g> {
    exponent: Signed<'g>,
    significand: Signal<'g>,
    /// True if the middle is so small that its square is below any positive number.
    certain: Signal<'g>,
}

impl<'g> Middle<'g> {
    fn above(b: &Operand<'g>, domain: Domain) -> Self {
        if domain.rounding() == Rounding::TowardZero {
            return Self::next(b, domain);
        }
        let one = b.fraction.graph().constant(1, 1);
        let largest = i64::from(domain.special_exponent()) - 1;
        if subnormal_squares_vanish(domain) {
            let significand = Signal::join(&[one, b.fraction, one]).named("middle");
            let exponent = Signed::unsigned(b.exponent, 1, largest);
            return Self { exponent, significand, certain: (!b.hidden).named("b_is_tiny") };
        }
        let unshifted = b.significand().concat(one).named("middle_unshifted");
        let (zeros, _) = leading_zeros(unshifted, "middle");
        let zeros = zeros.named("middle_leading_zeros");
        let exponent = Signed::unsigned(b.effective_exponent(), 1, largest)
            .minus(Signed::unsigned(zeros, 0, i64::from(domain.significand_bits())))
            .named("middle_exponent");
        Self {
            exponent,
            significand: shift_left(unshifted, zeros, "middle_normalise").named("middle"),
            certain: b.is_zero(),
        }
    }

    /// The next number, with a zero after its significand, so that it is as wide as a middle.
    fn next(b: &Operand<'g>, domain: Domain) -> Self {
        let zero = b.fraction.graph().constant(1, 0);
        let next = b.magnitude().plus(1).named("b_next");
        let (field, fraction) = (next.drop_low(domain.fraction_bits()), next.low(domain.fraction_bits()));
        let largest = i64::from(domain.special_exponent());
        if subnormal_squares_vanish(domain) {
            let significand = Signal::join(&[zero.same(1), fraction, zero]).named("next_significand");
            let exponent = Signed::unsigned(field, 1, largest);
            return Self { exponent, significand, certain: (!b.hidden).named("b_is_tiny") };
        }
        let hidden = field.any().named("next_hidden");
        let unshifted = Signal::join(&[hidden, fraction, zero]).named("next_unshifted");
        let (zeros, _) = leading_zeros(unshifted, "next");
        let zeros = zeros.named("next_leading_zeros");
        let effective = field.drop_low(1).concat(field.bit(0) | !hidden);
        let exponent = Signed::unsigned(effective, 1, largest)
            .minus(Signed::unsigned(zeros, 0, i64::from(domain.significand_bits())))
            .named("next_exponent");
        let significand = shift_left(unshifted, zeros, "next_normalise").named("next_significand");
        Self { exponent, significand, certain: zero }
    }
}
