//! Square root, by digit recurrence without restoring: each step tries a 1 as the root's next digit.

use super::Domain;
use super::parts::{Operand, Rounding, Signed, Special, Unrounded, result};
use crate::hdl::Signal;

/// √a. √−0 is −0; of any other negative number it is NaN.
pub fn sqrt(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let a = Operand::unpack(a, domain, "a");
    let (root, is_inexact) = root(radicand(&a), digits(domain));
    rounded(domain, a, root, is_inexact)
}

/// The significand of the number whose root is taken, with two bits before the point.
pub fn radicand<'g>(a: &Operand<'g>) -> Signal<'g> {
    let (exponent, significand) = a.normalised();
    radicand_of(significand, is_odd(exponent)).named("radicand")
}

/// One bit: set if the exponent is odd, so that one of it goes into the radicand. The bias is odd, so the biased
/// exponent is then even.
pub fn is_odd(exponent: Signed<'_>) -> Signal<'_> {
    (!exponent.bits(1)).named("exponent_is_odd")
}

/// The exponent of a root.
pub fn exponent<'g>(domain: Domain, a_exponent: Signed<'g>) -> Signed<'g> {
    a_exponent.offset(i64::from(domain.bias())).half().named("root_exponent")
}

/// The significand, or twice the significand if the exponent is odd.
pub fn radicand_of<'g>(significand: Signal<'g>, is_odd: Signal<'g>) -> Signal<'g> {
    is_odd.select(significand.append_zeros(1), significand.extend(significand.width() + 1))
}

/// The number of digits of the root. Rounding toward zero needs none below the significand.
pub fn digits(domain: Domain) -> u32 {
    domain.significand_bits() + u32::from(domain.rounding() != Rounding::TowardZero)
}

/// The root's word, from its digits and whether the remainder is not zero.
pub fn rounded<'g>(domain: Domain, a: Operand<'g>, root: Signal<'g>, is_inexact: Signal<'g>) -> Signal<'g> {
    let (a_exponent, _) = a.normalised();
    let exponent = exponent(domain, a_exponent);
    let [zero, one] = [0, 1].map(|bit| root.graph().constant(1, bit));
    let unrounded = if domain.rounding() == Rounding::TowardZero {
        Unrounded { exponent, significand: root.named("significand"), guard: zero, sticky: zero, doubled: None }
    } else {
        // An exact root of p + 1 bits would need a radicand of more than 2p bits, so a normal result is never a tie.
        // Only a subnormal one needs to know whether there is a remainder.
        let sticky = if exponent.min() > 0 { one } else { is_inexact.named("sticky") };
        Unrounded {
            exponent,
            significand: root.drop_low(1).named("significand"),
            guard: root.bit(0).named("guard"),
            sticky,
            doubled: None,
        }
    };
    finish(domain, a, unrounded)
}

/// A rounded root's word.
pub fn finish<'g>(domain: Domain, a: Operand<'g>, unrounded: Unrounded<'g>) -> Signal<'g> {
    let negative = a.sign & !a.is_zero();
    let special = Special { nan: a.is_nan() | negative, infinity: a.is_infinity(), zero: a.is_zero() };
    result(domain, a.sign, unrounded, special)
}

/// The first `count` digits of the root of `radicand`, which has two bits before the point and is at least 1. Also
/// returns whether there is a remainder.
///
/// With the root so far r and the remainder m, a digit 1 subtracts 4r + 1 from 4m + n, where n is the next two bits. If
/// the difference t is negative, it is kept: the digit is 0, and the next trial is 4t + n + (4r + 3), in which r
/// includes that 0. So a digit costs one carry chain, and its sign is the same as with restoring. In the lowest three
/// places both cases add 3, since −5 and 3 are the same there. So the last digit, which is known last, is needed only
/// as a sign.
fn root(radicand: Signal<'_>, count: u32) -> (Signal<'_>, Signal<'_>) {
    const PLACES: u32 = 3;
    let graph = radicand.graph();
    let radicand = radicand.append_zeros(2 * count - radicand.width());
    let next_two = |index: u32| radicand.slice(2 * (count - 1 - index), 2);
    let one = graph.constant(1, 1);
    // The first digit is always 1. It leaves the radicand's first two bits minus 1, which is less than 3.
    let first = next_two(0).minus(1).concat(next_two(1)).minus(5);
    let mut partial = first.named("partial_1");
    // All digits but the last, and the complement of the last.
    let (mut root, mut negative) = (one, partial.msb());
    for index in 2..count {
        let shifted = partial.concat(next_two(index)).named(&format!("shifted_{index}")).low(index + PLACES);
        let low = shifted.low(PLACES);
        let carry = (low.bit(2) & (low.bit(1) | low.bit(0))).named(&format!("carry_{index}"));
        let above = shifted.drop_low(PLACES).concat(carry);
        // The carry counts or not, whatever the sign, because of a one below it.
        let trial = root.concat(one).extend(above.width());
        let above = above.minus_or_plus(trial, negative).named(&format!("partial_{index}_above"));
        partial = above.drop_low(1).concat(low.plus(3)).named(&format!("partial_{index}"));
        root = root.concat(!negative).named(&format!("root_{index}"));
        negative = partial.msb();
    }
    let root = root.concat(!negative).named("root");
    // A negative partial remainder is 2r + 1 below the true one.
    let short = root.concat(one).extend(partial.width()).gate(negative);
    (root, (partial + short).any())
}
