//! Half of a number: the exponent minus one or, at the lower end of the range, the significand shifted.

use super::Domain;
use super::parts::{Fields, Operand, Special, pack};
use crate::hdl::Signal;

/// a · ½.
pub fn halve(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let graph = a.graph();
    let never = graph.constant(1, 0);
    let a = Operand::unpack(a, domain, "a");
    let is_normal = a.exponent.drop_low(1).any().named("half_is_normal");
    let less_one = a.exponent.minus(1).named("exponent_less_one");
    let exact = Fields {
        exponent: less_one,
        fraction: a.fraction,
        guard: never,
        sticky: never,
        doubled: None,
        rounding: domain.rounding(),
        overflow: never,
        // If results are normal, the smallest exponent never occurs.
        underflow: if domain.is_normal() { never } else { !is_normal },
    };
    let fields = if domain.keeps_subnormals() {
        // Half of a subnormal or of a number in the smallest binade loses its last bit, and may be a tie.
        let moved = is_normal.select(a.fraction, a.hidden.concat(a.fraction).drop_low(1)).named("half_fraction");
        let guard = (a.fraction.bit(0) & !is_normal).named("guard");
        Fields { exponent: less_one.gate(is_normal), fraction: moved, guard, underflow: never, ..exact }
    } else {
        exact
    };
    let special = Special { nan: a.is_nan(), infinity: a.is_infinity(), zero: a.is_zero() };
    pack(domain, a.sign, fields, special)
}
