//! a² − (b² + c² + d²) in a window of exact squares, or NaN if the result is in doubt.

use super::Domain;
use super::parts::{
    Operand, Signed, Special, Unrounded, leading_zeros, result, shift_left, shift_right_sticky, square,
};
use crate::hdl::Signal;
use crate::number::{Format, WINDOW_BITS, WINDOW_INEXACT_BITS, WINDOW_LEADING_BITS, WINDOW_LOST_BITS};

/// The excess of `a` over the others, converted from `domain` to `to`. Their format flushes subnormals.
pub fn square_excess<'g>(operands: [Signal<'g>; 4], domain: Domain, to: Format) -> Signal<'g> {
    let mut names = ["a", "b", "c", "d"].into_iter();
    let operands = operands.map(|word| Operand::unpack(word, domain, names.next().unwrap_or("a")));
    let [a, b, c, d] = operands.map(|operand| operand.exponent);
    let top = larger(larger(a, b).named("top_ab"), larger(c, d).named("top_cd")).named("top_exponent");
    let [a, b, c, d] = operands.map(|operand| Windowed::new(&operand, top, domain));

    let width = WINDOW_BITS + 3;
    let others = (b.kept.extend(width) + c.kept.extend(width)).named("sum_bc") + d.kept.extend(width);
    let excess = (a.kept.extend(width) - others.named("sum_bcd")).named("excess");
    let negative = excess.msb().named("excess_negative");
    let below = (excess.same(0) - excess).named("shortfall");
    let magnitude = negative.select(below.low(width - 1), excess.low(width - 1)).named("excess_magnitude");

    // In doubt are the sign, if the magnitude is below the error bound, and also the leading bits of a positive excess.
    let inexact = (a.inexact | b.inexact | c.inexact | d.inexact).named("inexact");
    let lost = (a.lost | b.lost | c.lost | d.lost).named("lost");
    let doubtful = |bits: u32, name: &str| {
        let small = magnitude.drop_low(bits).is_zero().named(&format!("{name}_hides_sign"));
        let short = magnitude.drop_low(bits + WINDOW_LEADING_BITS).is_zero().named(&format!("{name}_hides_leading"));
        negative.select(small, short).named(&format!("{name}_doubt"))
    };
    let if_lost = lost & doubtful(WINDOW_LOST_BITS, "loss");
    let in_doubt = inexact.select(doubtful(WINDOW_INEXACT_BITS, "inexactness"), if_lost).named("in_doubt");
    let special = operands.into_iter().map(|operand| operand.is_special()).reduce(|one, other| one | other);
    let nan = special.map_or(in_doubt, |special| in_doubt | special);

    let (zeros, is_zero) = leading_zeros(magnitude, "magnitude");
    let normalised = shift_left(magnitude, zeros.named("leading_zeros"), "normalise").named("normalised");
    let rest = magnitude.width() - to.significand_bits() - 1;
    // The window's last place stands for 2^(2 top + 2 - WINDOW_BITS), top without its bias.
    let leading = i64::from(magnitude.width()) - 1 + 2 - i64::from(WINDOW_BITS);
    let exponent = Signed::unsigned(top, 1, i64::from(domain.special_exponent()) - 1)
        .twice()
        .offset(leading - 2 * i64::from(domain.bias()) + i64::from(to.bias()))
        .minus(Signed::unsigned(zeros, 0, i64::from(magnitude.width()) - 1))
        .named("excess_exponent");
    let unrounded = Unrounded {
        exponent,
        significand: normalised.high(to.significand_bits()).named("significand"),
        guard: normalised.bit(rest).named("guard"),
        sticky: normalised.low(rest).any().named("sticky"),
        doubled: None,
    };
    let never = top.graph().constant(1, 0);
    let to = Domain::from(to);
    result(to, negative, unrounded, Special { nan, infinity: never, zero: is_zero })
}

fn larger<'g>(a: Signal<'g>, b: Signal<'g>) -> Signal<'g> {
    a.less_than(b).select(b, a)
}

/// An operand's square in the window.
struct Windowed<'g> {
    /// The bits from the window's last place up.
    kept: Signal<'g>,
    /// True if bits below the window were lost.
    lost: Signal<'g>,
    /// True if the operand's last bit is set, so that it may differ from the exact value.
    inexact: Signal<'g>,
}

impl<'g> Windowed<'g> {
    fn new(operand: &Operand<'g>, top: Signal<'g>, domain: Domain) -> Self {
        let present = !operand.is_zero();
        let name = |signal: Signal<'g>, what: &str| signal.named(&format!("{}_{what}", operand.prefix()));
        let square = name(square(operand.significand()).gate(present), "square");
        let cut = 2 * domain.significand_bits() - WINDOW_BITS;
        // A square's exponent is twice its root's.
        let distance = name((top - operand.exponent).append_zeros(1), "distance");
        let (kept, shifted_out) =
            shift_right_sticky(square.drop_low(cut), distance, &format!("{}_align", operand.prefix()));
        Self {
            kept: name(kept, "in_window"),
            lost: name(shifted_out | square.low(cut).any(), "lost"),
            inexact: name(operand.fraction.bit(0) & present, "inexact"),
        }
    }
}
