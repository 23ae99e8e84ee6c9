//! The numbers of the kernel: `f32`, [`Soft`] (any format, with exact integer arithmetic), [`Precise`] (the truth) and,
//! outside this module, the wires of the netlist. This module imports nothing of ours.

mod faithful;
mod format;
mod native;
mod options;
mod precise;
mod soft;
mod window;

pub use faithful::{Faithful, Function, Piece};
pub use format::{EXPONENT_BITS, FAITHFUL_FRACTION_BITS, FRACTION_BITS, Format, FormatError};
pub use options::{Roots, Rounding, Subnormals};
pub use precise::Precise;
pub use soft::Soft;
pub use window::{WINDOW_BITS, WINDOW_INEXACT_BITS, WINDOW_LEADING_BITS, WINDOW_LOST_BITS, Window};

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Not, Sub, SubAssign};

/// A Boolean of a [`Number`]: `bool` in software, one wire in hardware.
pub trait Boolean: Copy + Debug + 'static + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}

impl Boolean for bool {}

/// A number that carries its own context (format, graph), so that one kernel serves software and hardware.
///
/// There is no Zero and no One: a constant is made from another number. Every operation rounds once, as its format says
/// (IEEE 754-2019, clause 4.3). Only roots and reciprocals may be faithful instead. Mixing formats is a programming
/// error in the kernel: `Soft` panics with the names of both formats, and a wire records an error in its graph.
pub trait Number:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// The result of a comparison.
    type Bool: Boolean;

    /// `value`, in this number's format. `value` must be representable there.
    fn constant(self, value: f64) -> Self;
    /// √self, rounded (IEEE 754-2019, clause 5.4.1), or faithful if the format says so.
    fn sqrt(self) -> Self;
    /// 1/self, rounded, or faithful if the format says so.
    fn recip(self) -> Self;
    /// self > other; false when either is NaN.
    fn gt(self, other: Self) -> Self::Bool;
    /// self ≤ other; false when either is NaN.
    fn le(self, other: Self) -> Self::Bool;
    /// True if √self, rounded, is greater than `bound` ≥ 0. It is decided without a root: self > (bound +
    /// ½ulp(bound))², or for rounding toward zero self ≥ (bound + ulp(bound))², computed exactly. A faithful root may
    /// differ.
    fn root_exceeds(self, bound: Self) -> Self::Bool;
    /// `yes` if `condition` holds, otherwise `no`.
    fn select(condition: Self::Bool, yes: Self, no: Self) -> Self;
    /// This number in another format, rounded once. In its own format it does not change.
    fn to(self, format: Format) -> Self;
    /// Gives the value a name in generated hardware; has no effect elsewhere.
    #[must_use]
    fn named(self, _name: &str) -> Self {
        self
    }
}
