//! Reciprocal and square root, rounded correctly from a table. The truncated value is the result or one unit below it.
//! The sign of the remainder at the middle between the two decides.
//!
//! [`Faithful::nearest`] does the same with integers. The remainder is small, so only the low bits of one product are
//! computed. This takes a multiplier block or two beside the table's, instead of one carry chain per digit.

use super::faithful::{Cut, value};
use super::parts::{Operand, Rounding, Signed, Unrounded, product_low, square_low};
use super::{Domain, Operator, recip, sqrt};
use crate::hdl::Signal;
use crate::number::{FAITHFUL_FRACTION_BITS, Function, Roots};

/// True if this architecture exists: for rounding to nearest, and fractions that have a table. Subnormals may not
/// occur, because they are not rounded at the last place.
pub fn is_possible(operator: Operator, domain: Domain) -> bool {
    matches!(operator, Operator::Recip | Operator::Sqrt)
        && domain.format().roots() == Roots::Correct
        && domain.rounding() == Rounding::NearestEven
        && !domain.keeps_subnormals()
        && domain.fraction_bits() <= FAITHFUL_FRACTION_BITS
}

/// 1 / a.
pub fn recip(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let a = Operand::unpack(a, domain, "a");
    let (a_exponent, significand) = a.normalised();
    let lower = value(Function::Reciprocal, domain, a.fraction, None, Cut::Nothing).named("lower");
    // 2^(2F+2) minus this is the remainder at the middle. These bits do not contain that power.
    let bits = domain.fraction_bits() + 3;
    let product = product_low(significand, middle(lower), bits, "middle").named("middle_product");
    let exponent = recip::exponent(domain, a_exponent);
    // For a power of two, the lower number is all ones and is rounded up, which also increments the exponent.
    recip::finish(domain, a, unrounded(exponent, lower, product.msb()))
}

/// √a. √−0 is −0; of any other negative number it is NaN.
pub fn sqrt(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let a = Operand::unpack(a, domain, "a");
    let (a_exponent, significand) = a.normalised();
    let (is_odd, exponent) = (sqrt::is_odd(a_exponent), sqrt::exponent(domain, a_exponent));
    let lower = value(Function::Root, domain, a.fraction, Some(is_odd), Cut::Nothing).named("lower");
    let (middle, bits) = (middle(lower), domain.fraction_bits() + 5);
    let square = square_low(middle, bits, "middle").named("middle_square");
    // The radicand has three bits there, and zeros below them. The square is odd, so the difference borrows from the
    // three.
    let radicand = sqrt::radicand_of(significand, is_odd).low(3).named("radicand_low");
    let left = (radicand + !square.high(3)).named("left_high");
    sqrt::finish(domain, a, unrounded(exponent, lower, !left.msb()))
}

/// Twice the middle between the lower number and the next.
fn middle(lower: Signal<'_>) -> Signal<'_> {
    let one = lower.graph().constant(1, 1);
    one.concat(lower).concat(one).named("twice_the_middle")
}

/// The guard bit decides: no result is a tie.
fn unrounded<'g>(exponent: Signed<'g>, lower: Signal<'g>, is_above: Signal<'g>) -> Unrounded<'g> {
    let one = lower.graph().constant(1, 1);
    let (significand, guard) = (one.concat(lower).named("significand"), is_above.named("above_the_middle"));
    Unrounded { exponent, significand, guard, sticky: one, doubled: None }
}
