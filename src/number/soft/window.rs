//! The difference of squares in a window, with detection of doubt.

use super::parts::{Class, Parts};
use crate::number::{Format, WINDOW_BITS, WINDOW_INEXACT_BITS, WINDOW_LEADING_BITS, WINDOW_LOST_BITS};

/// a² − (x² + y² + z²) of finite or zero operands in `format`, or NaN if it is in doubt.
pub fn square_excess(format: Format, a: Parts, others: [Parts; 3]) -> Parts {
    let operands = [a, others[0], others[1], others[2]];
    if operands.iter().any(|operand| matches!(operand.class, Class::Nan | Class::Infinity)) {
        return Parts::NAN;
    }
    let finite = operands.into_iter().filter(|operand| operand.class == Class::Finite);
    let Some(top) = finite.map(|operand| operand.exponent).max() else { return Parts::zero(false) };

    let (mut lost, mut inexact) = (false, false);
    let [a, x, y, z] = operands.map(|operand| {
        if operand.class != Class::Finite {
            return 0;
        }
        let significand = u128::from(operand.significand >> (64 - format.significand_bits()));
        inexact |= significand & 1 == 1;
        let square = significand * significand;
        // The last place of a square whose operand has the exponent `top`, as far below as the others are smaller.
        let cut = 2 * format.significand_bits() - WINDOW_BITS;
        let shift = cut + 2 * (top - operand.exponent) as u32;
        let kept = square.checked_shr(shift).unwrap_or(0);
        lost |= kept.checked_shl(shift) != Some(square);
        kept as i128
    });
    let excess = a - (x + y + z);
    let doubt_bits = match (inexact, lost) {
        (true, _) => Some(WINDOW_INEXACT_BITS),
        (false, true) => Some(WINDOW_LOST_BITS),
        (false, false) => None,
    };
    if let Some(bits) = doubt_bits
        && -(1 << bits) < excess
        && excess < 1 << (bits + WINDOW_LEADING_BITS)
    {
        return Parts::NAN;
    }
    if excess == 0 {
        return Parts::zero(false);
    }
    // The window's last place stands for 2^(2·top + 2 − WINDOW_BITS).
    let magnitude = excess.unsigned_abs();
    let zeros = magnitude.leading_zeros();
    let aligned = magnitude << zeros;
    let significand = (aligned >> 64) as u64 | u64::from(aligned as u64 != 0);
    let exponent = 2 * top + 2 - WINDOW_BITS as i32 + 127 - zeros as i32;
    Parts::finite(excess < 0, exponent, significand)
}

#[cfg(test)]
mod tests {
    use crate::number::{Format, Soft, Window};

    fn excess(a: f64, others: [f64; 3]) -> Soft {
        let number = |value| Soft::from_f64(Format::DIFFERENCE, value);
        number(a).square_excess(others.map(number), Format::TAIL)
    }

    #[test]
    fn what_fits_the_window_is_exact() {
        assert_eq!(excess(3.0, [1.0, 2.0, 2.0]).to_f64(), 0.0);
        assert_eq!(excess(7.0, [2.0, -3.0, 6.0]).to_f64(), 0.0);
        assert_eq!(excess(2.0, [1.0, 0.0, 0.0]).to_f64(), 3.0);
        assert_eq!(excess(0.0, [3.0, 4.0, 0.0]).to_f64(), -25.0);
        assert_eq!(excess(0.0, [0.0; 3]).to_f64(), 0.0);
        let (tiny, huge) = (2.0_f64.powi(-149), 2.0_f64.powi(128));
        assert_eq!(excess(2.0 * tiny, [tiny, 0.0, 0.0]).to_f64(), 3.0 * tiny * tiny);
        assert_eq!(excess(2.0 * huge, [huge, huge, huge]).to_f64(), huge * huge);
    }

    #[test]
    fn what_does_not_fit_is_in_doubt_or_settled() {
        // A step to the side whose square is below the window, so that the contact is in doubt.
        assert!(excess(5.0, [5.0, 2.0_f64.powi(-30), 0.0]).is_nan());
        // Clearly apart, clearly together.
        assert!(excess(5.0, [6.0, 2.0_f64.powi(-30), 0.0]).to_f64() < -10.9);
        assert!(excess(5.0, [4.0, 2.0_f64.powi(-30), 0.0]).to_f64() > 8.9);
        // With an excess just above the lost bits, too few leading bits are certain.
        let next = 1.0 + 2.0_f64.powi(-46);
        assert!(excess(next, [1.0, 2.0_f64.powi(-40), 0.0]).is_nan());
        // An operand whose last bit is set may not be exact.
        let odd = 1.0 + 2.0_f64.powi(-47);
        assert!(excess(1.0 + 2.0_f64.powi(-20), [odd, 0.0, 0.0]).is_nan());
        assert!(!excess(1.125, [odd, 0.0, 0.0]).is_nan());
        assert!(!excess(1.0, [odd, 1.0, 0.0]).is_nan());
    }

    #[test]
    fn rounding_to_odd_keeps_what_is_exact_and_marks_what_is_not() {
        let number = |value| Soft::from_f64(Format::DIFFERENCE, value);
        let small = 2.0_f64.powi(-60);
        assert_eq!(number(1.5).plus_to_odd(number(-0.25)).to_f64(), 1.25);
        assert_eq!(number(1.0).minus_to_odd(number(1.0)), number(0.0));
        assert_eq!(number(1.0).plus_to_odd(number(small)).to_f64(), 1.0 + 2.0_f64.powi(-47));
        assert_eq!(number(1.0).minus_to_odd(number(small)).to_f64(), 1.0 - 2.0_f64.powi(-48));
        assert_eq!(number(-1.0).minus_to_odd(number(small)).to_f64(), -1.0 - 2.0_f64.powi(-47));
    }
}
