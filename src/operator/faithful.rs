//! Reciprocal and square root within one unit of the last place: a table of parabolas, two products and two sums.
//!
//! [`Faithful`] has the table and the integers that the hardware computes. A result that is a number of the format is
//! exact.

use super::parts::{Operand, Signed, Unrounded, product_of, with_product};
use super::{Domain, recip, sqrt};
use crate::hdl::{DEEP_TABLE_BITS, DEEP_TABLE_INDEX_BITS, Signal};
use crate::number::{Faithful, Function, Piece};

/// 1 / a.
pub fn recip(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    // A subnormal result, too, only has to be less than one unit wrong.
    let domain = domain.to_nearest();
    let a = Operand::unpack(a, domain, "a");
    let (a_exponent, significand) = a.normalised();
    let fraction = significand.low(domain.fraction_bits()).named("significand_fraction");
    let value = value(Function::Reciprocal, domain, fraction, None, Cut::Half);
    // For a power of two, the value is 2, which leaves no fraction and an exponent that is one more.
    let is_power = fraction.is_zero().named("is_power_of_two");
    let exponent = recip::exponent(domain, a_exponent);
    recip::finish(domain, a, unrounded(domain, exponent.plus_bit(is_power).named("result_exponent"), value))
}

/// √a. √−0 is −0; of any other negative number it is NaN.
pub fn sqrt(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let domain = domain.to_nearest();
    let a = Operand::unpack(a, domain, "a");
    let (a_exponent, significand) = a.normalised();
    let (is_odd, exponent) = (sqrt::is_odd(a_exponent), sqrt::exponent(domain, a_exponent));
    let value = value(Function::Root, domain, significand.low(domain.fraction_bits()), Some(is_odd), Cut::Half);
    sqrt::finish(domain, a, unrounded(domain, exponent, value))
}

/// The value's leading one is known, and the table rounded off the bits below its last place.
fn unrounded<'g>(domain: Domain, exponent: Signed<'g>, value: Signal<'g>) -> Unrounded<'g> {
    let zero = value.graph().constant(1, 0);
    let significand = zero.same(1).concat(value.low(domain.fraction_bits())).named("significand");
    Unrounded { exponent, significand, guard: zero, sticky: zero, doubled: None }
}

/// The constant that a value includes before it is truncated.
#[derive(Clone, Copy, PartialEq)]
pub enum Cut {
    /// Half a unit of the last place: [`Faithful::value`].
    Half,
    /// Nothing: [`Faithful::lower`].
    Nothing,
}

/// The table's value, without the bits above the fraction.
pub fn value<'g>(
    function: Function,
    domain: Domain,
    fraction: Signal<'g>,
    odd: Option<Signal<'g>>,
    cut: Cut,
) -> Signal<'g> {
    let table = Faithful::of(function, domain.fraction_bits());
    let t_bits = table.t_bits();
    let index = fraction.drop_low(t_bits);
    let index = odd.map_or(index, |odd| odd.concat(index)).named("piece");
    let words = |of: fn(&Piece) -> u64| table.pieces().iter().map(|piece| u128::from(of(piece))).collect::<Vec<_>>();
    let bits = |words: &[u128]| 128 - words.iter().max().map_or(0, |largest| largest.leading_zeros());
    // The value's bits above the fraction are known, so sums wrap there.
    let value_bits = domain.fraction_bits() + table.guard_bits();
    let less = if cut == Cut::Half { 0 } else { u128::from(table.half()) };
    let begins = words(|piece| piece.c0).into_iter().map(|word| (word - less) & ((1 << value_bits) - 1));
    let begins: Vec<u128> = begins.collect();
    let begin = word(index, &begins, value_bits, "piece_begin");
    if t_bits == 0 {
        return begin.drop_low(table.guard_bits());
    }
    // Both are needed at the same time: one table.
    let (slopes, curves) = (words(|piece| piece.c1), words(|piece| piece.c2));
    let (slope_bits, curve_bits) = (bits(&slopes), bits(&curves));
    let both: Vec<u128> = slopes.iter().zip(&curves).map(|(slope, curve)| slope << curve_bits | curve).collect();
    let both = word(index, &both, slope_bits + curve_bits, "piece_slope_and_curve");
    let slope = both.high(slope_bits).named("piece_slope");
    let curve = both.low(curve_bits).named("piece_curve");

    let t = fraction.low(t_bits).named("t");
    let bend = product_of(curve, t.high(table.high_bits()), "bend").drop_low(table.inner_shift());
    let bent = (slope - bend.extend(slope.width())).named("bent_slope");
    let subtracts = function == Function::Reciprocal;
    let sum = with_product(begin, subtracts, [bent, t], table.outer_shift(), "rise");
    sum.named("value").drop_low(table.guard_bits())
}

/// The word of a table. If it has more words than a block memory of the widest words, it is in two of narrower ones.
fn word<'g>(index: Signal<'g>, table: &[u128], bits: u32, name: &str) -> Signal<'g> {
    if index.width() < DEEP_TABLE_INDEX_BITS {
        return index.lookup(table, bits).named(name);
    }
    let part = |from: u32, bits: u32| {
        let words: Vec<u128> = table.iter().map(|word| word >> from & ((1 << bits) - 1)).collect();
        index.lookup(&words, bits).named(&format!("{name}_from_{from}"))
    };
    part(DEEP_TABLE_BITS, bits - DEEP_TABLE_BITS).concat(part(0, DEEP_TABLE_BITS)).named(name)
}
