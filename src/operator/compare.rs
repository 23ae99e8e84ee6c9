//! Comparisons of two numbers. −0 equals +0. With a NaN, every comparison is false (IEEE 754-2019, clause 5.11).

use super::Domain;
use super::parts::Operand;
use crate::hdl::Signal;

/// a > b.
pub fn greater<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> Signal<'g> {
    let (greater, unordered) = order(a, b, domain);
    greater & !unordered
}

/// a ≤ b.
pub fn at_most<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> Signal<'g> {
    let (greater, unordered) = order(a, b, domain);
    !(greater | unordered)
}

/// Two bits: a > b if neither is a NaN, and whether one is a NaN.
fn order<'g>(a: Signal<'g>, b: Signal<'g>, domain: Domain) -> (Signal<'g>, Signal<'g>) {
    let (a, b) = (Operand::unpack(a, domain, "a"), Operand::unpack(b, domain, "b"));
    let b_is_smaller = b.magnitude().less_than(a.magnitude()).named("b_magnitude_is_smaller");
    let same = a.magnitude().equals(b.magnitude()).named("same_magnitude");
    // Two flushed subnormals are equal. For one subnormal and a normal number, the magnitudes decide correctly.
    let both_zero = (a.is_zero() & b.is_zero()).named("both_zero");

    let across = (!a.sign & b.sign).named("is_across_zero");
    let among_positive = (!a.sign & !b.sign & b_is_smaller).named("is_greater_positive");
    let among_negative = (a.sign & b.sign & !b_is_smaller & !same).named("is_greater_negative");
    let greater = ((across | among_positive | among_negative) & !both_zero).named("is_greater");
    (greater, (a.is_nan() | b.is_nan()).named("unordered"))
}
