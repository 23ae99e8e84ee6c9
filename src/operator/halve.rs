//! Half of a number: the exponent less one, and at the lower end of the range the significand moved instead.

use super::Domain;
use super::parts::{Operand, Rounded, Special, pack};
use crate::hdl::Signal;

/// a · ½.
pub fn halve(a: Signal<'_>, domain: Domain) -> Signal<'_> {
    let graph = a.graph();
    let never = graph.constant(1, 0);
    let a = Operand::unpack(a, domain, "a");
    let is_normal = a.exponent.drop_low(1).any().named("half_is_normal");
    let less_one = a.exponent.minus(1).named("exponent_less_one");
    let rounded = if domain.keeps_subnormals() {
        // Half of a subnormal or of the smallest binade: the last bit falls off, and it may be a tie.
        let moved = is_normal.select(a.fraction, a.hidden.concat(a.fraction).drop_low(1)).named("half_fraction");
        let guard = (a.fraction.bit(0) & !is_normal).named("guard");
        let magnitude = domain.rounding().apply(less_one.gate(is_normal), moved, guard, never);
        Rounded { magnitude, overflow: never, underflow: never }
    } else {
        // Where results are normal, a smallest exponent never comes.
        let underflow = if domain.is_normal() { never } else { !is_normal };
        Rounded { magnitude: less_one.concat(a.fraction), overflow: never, underflow }
    };
    let special = Special { nan: a.is_nan(), infinity: a.is_infinity(), zero: a.is_zero() };
    pack(domain, a.sign, rounded, special)
}
