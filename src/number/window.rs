//! The operations of the exact kernel beyond [`Number`]: sums that record whether they are exact, and the difference of
//! squares in a window that detects doubt.

use super::{Format, Number, Precise};

/// Bits of the window in which squares are summed, below the leading place of the largest.
pub const WINDOW_BITS: u32 = 64;

/// The largest error of the window's value if bits were cut off, in units of its last place: less than one for the
/// first square and three for the others, so less than 2^2.
pub const WINDOW_LOST_BITS: u32 = 2;
/// The same if an operand is not exact: each square is then within 2^17, and all four with the bits that are cut off
/// within 2^20.
pub const WINDOW_INEXACT_BITS: u32 = 20;
/// Number of leading bits that must be right in a positive value.
pub const WINDOW_LEADING_BITS: u32 = 28;

/// Numbers whose a² − (x² + y² + z²) has a known sign and leading bits, or is known to be in doubt.
pub trait Window: Number {
    /// self + other, rounded to odd: the exact sum if the format has it, otherwise the neighbour (towards zero or away)
    /// whose last significand bit is set. So an even last bit means that nothing was lost.
    fn plus_to_odd(self, other: Self) -> Self;

    /// self − other, rounded to odd.
    fn minus_to_odd(self, other: Self) -> Self;

    /// self² − (x² + y² + z²) in the format `to`. NaN if its sign or, for a positive value, its leading 28 bits are not
    /// certain. Each operand is an exact value rounded to odd, and the result is that of the exact values.
    ///
    /// The operands' squares are exact and are placed in a window of [`WINDOW_BITS`] bits, whose top is the place of
    /// the largest operand's square. Bits below the window are cut off. `docs/exact.md` proves the bounds.
    fn square_excess(self, others: [Self; 3], to: Format) -> Self;
}

/// No result is ever in doubt.
impl Window for Precise {
    fn plus_to_odd(self, other: Self) -> Self {
        self + other
    }

    fn minus_to_odd(self, other: Self) -> Self {
        self - other
    }

    fn square_excess(self, [x, y, z]: [Self; 3], _: Format) -> Self {
        self * self - (x * x + y * y + z * z)
    }
}
