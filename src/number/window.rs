//! What the exact kernel asks of a number beyond [`Number`]: sums that know they are not exact, and the difference of
//! squares in a window that knows what it cannot tell.

use super::{Format, Number, Precise};

/// Bits of the window in which squares are summed, below the leading place of the largest.
pub const WINDOW_BITS: u32 = 64;

/// How far the window's value may be from the true one where bits were cut off, in units of its last place: less than
/// one for the first square and three for the others, so less than 2^2.
pub const WINDOW_LOST_BITS: u32 = 2;
/// The same where an operand is not exact: each square is then within 2^17, all four and what is cut off within 2^20.
pub const WINDOW_INEXACT_BITS: u32 = 20;
/// Number of leading bits that must be right in a positive value.
pub const WINDOW_LEADING_BITS: u32 = 28;

/// Numbers in which the sign and the leading bits of a² − (x² + y² + z²) can be told, or told to be in doubt.
pub trait Window: Number {
    /// self + other, rounded to odd: the exact sum if the format has it, else the neighbour (towards zero or away)
    /// whose last significand bit is set. So an even last bit says that nothing was lost.
    fn plus_to_odd(self, other: Self) -> Self;

    /// self − other, rounded to odd.
    fn minus_to_odd(self, other: Self) -> Self;

    /// self² − (x² + y² + z²) in the format `to`; a NaN where its sign, or of a positive value the leading 28 bits,
    /// cannot be told. Each operand is the rounding to odd of what is meant: the excess is that of what is meant.
    ///
    /// The operands' squares are exact and stand in a window of [`WINDOW_BITS`] whose top is the place of the largest
    /// operand's square; what is below the window is cut off. `docs/exact.md` proves the bounds.
    fn square_excess(self, others: [Self; 3], to: Format) -> Self;
}

/// Nothing is ever in doubt.
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
