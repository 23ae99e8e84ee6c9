//! Square root, by restoring digit recurrence: each step tries a 1 as the root's next digit.

use super::Domain;
use super::parts::{Operand, Rounding, Special, Unrounded, pack, round};
use crate::hdl::Signal;

/// √a. √−0 is −0; of any other negative number it is NaN.
pub fn sqrt(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let graph = a.graph();
    let a = Operand::unpack(a, domain, "a");
    let (a_exponent, significand) = a.normalised();

    // The bias is odd, so an even biased exponent stands for an odd one, of which one goes into the radicand.
    let precision = domain.significand_bits();
    let exponent_is_odd = (!a_exponent.bits(1)).named("exponent_is_odd");
    let radicand = exponent_is_odd.select(significand.append_zeros(1), significand.extend(precision + 1));
    let radicand = radicand.named("radicand");
    let exponent = a_exponent.offset(i64::from(domain.bias())).half().named("root_exponent");

    if domain.rounding() == Rounding::TowardZero {
        // Nobody asks for what is below the significand.
        let (root, _) = root(radicand, precision);
        let zero = graph.constant(1, 0);
        let significand = root.named("significand");
        return finish(domain, a, Unrounded { exponent, significand, guard: zero, sticky: zero, doubled: None });
    }
    let (root, remainder) = root(radicand, precision + 1);
    // A root of p + 1 bits exactly would need a radicand of more than 2p bits, so a normal result is never a tie,
    // and only a subnormal one asks whether anything is left.
    let sticky = if exponent.min() > 0 { graph.constant(1, 1) } else { remainder.any().named("sticky") };
    let unrounded = Unrounded {
        exponent,
        significand: root.drop_low(1).named("significand"),
        guard: root.bit(0).named("guard"),
        sticky,
        doubled: None,
    };
    finish(domain, a, unrounded)
}

/// The root's word.
pub fn finish<'g>(domain: Domain, a: Operand<'g>, unrounded: Unrounded<'g>) -> Signal<'g> {
    let negative = a.sign & !a.is_zero();
    let special = Special { nan: a.is_nan() | negative, infinity: a.is_infinity(), zero: a.is_zero() };
    pack(domain, a.sign, round(domain, unrounded), special)
}

/// The first `count` digits of the root of `radicand`, which has two bits before the point and is at least 1; and
/// the remainder.
fn root(radicand: Signal<'_>, count: u32) -> (Signal<'_>, Signal<'_>) {
    let graph = radicand.graph();
    let radicand = radicand.append_zeros(2 * count - radicand.width());
    let next_two = |index: u32| radicand.slice(2 * (count - 1 - index), 2);
    // The first digit is always 1, and leaves the radicand's first two bits less 1.
    let mut root = graph.constant(1, 1);
    let mut remainder = next_two(0).minus(1).named("remainder_0");
    for index in 1..count {
        // With the root so far r and the remainder m, a digit 1 takes 4r + 1 from 4m + the next two bits.
        let shifted = remainder.concat(next_two(index));
        let one = graph.constant(2, 1);
        let trial = root.concat(one).extend(shifted.width());
        let difference = (shifted - trial).named(&format!("difference_{index}"));
        let negative = difference.msb().named(&format!("borrow_{index}"));
        let width = shifted.width() - 1;
        root = root.concat(!negative).named(&format!("root_{index}"));
        remainder = negative.select(shifted.low(width), difference.low(width)).named(&format!("remainder_{index}"));
    }
    (root.named("root"), remainder)
}
