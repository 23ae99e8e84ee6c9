//! The box of a sphere: order-preserving integers, wide enough that no contact is lost. `docs/spheres.md` derives the
//! width.
//!
//! Edges are only ever compared with edges. So rounding them loses no contact, as long as all of them are rounded by
//! the same function and that function preserves order: to the nearest binary32 number, and by dropping low bits.

use super::Sphere;
use crate::kernel::Arithmetic;
use crate::number::{Format, Number, Roots, Rounding, Soft};

/// The bits that a number of a box can have.
pub const BOX_BITS: std::ops::RangeInclusive<u32> = 10..=32;
/// The exponent bits from which on neither a square of a difference of binary32 numbers underflows nor a sum of three
/// of them overflows.
const LEAST_EXPONENT_BITS: u32 = 10;

/// A box: the lowest and the highest number on each axis, both inside. The integers preserve the order of the numbers
/// that they stand for; −0 and +0 are both 0. All edges are rounded alike, so boxes that have a point in common before
/// rounding have one after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Bounds {
    /// The lowest x, y and z.
    pub low: [i32; 3],
    /// The highest x, y and z.
    pub high: [i32; 3],
}

impl Bounds {
    /// The box that meets none, not even one that is infinite: of an invalid sphere, or of no sphere.
    pub const EMPTY: Self = Self { low: [i32::MAX; 3], high: [i32::MIN; 3] };

    /// True if the boxes have a point in common.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).fold(true, |all, axis| all & (self.low[axis] <= other.high[axis]) & (other.low[axis] <= self.high[axis]))
    }

    /// The box around both.
    #[must_use]
    pub fn around(self, other: Self) -> Self {
        Self {
            low: std::array::from_fn(|axis| self.low[axis].min(other.low[axis])),
            high: std::array::from_fn(|axis| self.high[axis].max(other.high[axis])),
        }
    }
}

/// Why no box is wide enough for an arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RefusedArithmetic {
    /// Squares underflow.
    #[error(
        "{0} has {bits} exponent bits: the square of a small distance underflows, so spheres far apart for their size \
         would count as contacts that no box can find; use wide, exact, or a format with at least \
         {LEAST_EXPONENT_BITS} exponent bits",
        bits = .0.exponent_bits()
    )]
    Underflows(Format),
    /// The kernel decides by a root that is not correctly rounded.
    #[error("{0} has faithful roots, by which the full kernel and the decision alone differ; use correct roots")]
    Faithful(Format),
    /// The boxes have too few bits, or too many.
    #[error("boxes of {0} bits: expected {least} to {most}", least = BOX_BITS.start(), most = BOX_BITS.end())]
    Bits(u32),
}

/// How the box of a sphere is made, for one arithmetic: the radius is increased by a number of units in its last place,
/// each edge is rounded to the nearest binary32 number, and its integer loses its low bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundsRule {
    /// The format to which the kernel rounds the sphere first, if binary32 is not contained in it.
    rounded_to: Option<Format>,
    /// Binary32 units by which the radius is increased.
    radius_units: i32,
    /// Low bits of an edge that are dropped.
    cut: u32,
}

impl BoundsRule {
    /// The rule for boxes of `bits` bits whose pairs are decided in `arithmetic`.
    ///
    /// # Errors
    /// Returns an error if no box is wide enough for the arithmetic, or if `bits` is not in [`BOX_BITS`].
    pub fn new(arithmetic: Arithmetic, bits: u32) -> Result<Self, RefusedArithmetic> {
        if !BOX_BITS.contains(&bits) {
            return Err(RefusedArithmetic::Bits(bits));
        }
        let cut = i32::BITS - bits;
        // Exact squares decide as real numbers do, for which |x1 − x2| ≤ r1 + r2.
        let Arithmetic::Rounded(format) = arithmetic else {
            return Ok(Self { rounded_to: None, radius_units: 0, cut });
        };
        if format.exponent_bits() < LEAST_EXPONENT_BITS {
            return Err(RefusedArithmetic::Underflows(format));
        }
        if format.roots() == Roots::Faithful {
            return Err(RefusedArithmetic::Faithful(format));
        }
        let own_units = match format.rounding() {
            Rounding::Nearest => 2,
            Rounding::TowardZero => 4,
        };
        let (own, binary32) = (format.fraction_bits(), Format::BINARY32.fraction_bits());
        let radius_units = match binary32.checked_sub(own) {
            Some(coarser) => own_units << coarser,
            // A unit of a finer format is a part of one, which is rounded up.
            None => (own_units >> (own - binary32).min(8)).max(1),
        };
        let rounded_to = (own < binary32).then_some(format);
        Ok(Self { rounded_to, radius_units, cut })
    }

    /// Binary32 units by which the radius is increased.
    pub(crate) const fn radius_units(&self) -> u32 {
        self.radius_units as u32
    }

    /// The bits of each number of a box.
    pub(crate) const fn bits(&self) -> u32 {
        i32::BITS - self.cut
    }

    /// True if the kernel computes with at least the precision of binary32.
    pub(crate) const fn contains_binary32(&self) -> bool {
        self.rounded_to.is_none()
    }

    /// The box of a sphere; [`Bounds::EMPTY`] if the sphere is invalid.
    pub fn bounds(&self, sphere: Sphere) -> Bounds {
        if !sphere.is_valid() {
            return Bounds::EMPTY;
        }
        let [x, y, z, r] = sphere.values().map(|value| self.converted(value));
        let radius = self.increased(r);
        // In binary64 the sum of two binary32 numbers rounds to binary32 as the exact sum does, also where it
        // overflows.
        let edge = |centre: f64, radius: f64| code((centre + radius) as f32) >> self.cut;
        Bounds {
            low: [x, y, z].map(|centre| edge(centre, -radius)),
            high: [x, y, z].map(|centre| edge(centre, radius)),
        }
    }

    /// The number with which the kernel computes. In a short format it can be 2^128, which binary32 does not have.
    fn converted(&self, value: f32) -> f64 {
        match self.rounded_to {
            None => value.into(),
            Some(format) => Soft::from_f32(value).to(format).to_f64(),
        }
    }

    /// The radius after the increase. Beyond the largest binary32 number it is infinite.
    fn increased(&self, radius: f64) -> f64 {
        let infinity = f32::INFINITY.to_bits();
        let word = (radius.abs() as f32).to_bits();
        f32::from_bits(word.saturating_add_signed(self.radius_units).min(infinity)).into()
    }
}

/// The integer of a number that is not a NaN: consecutive numbers have consecutive integers, and ±0 has 0.
fn code(value: f32) -> i32 {
    let word = value.to_bits();
    let magnitude = (word & 0x7FFF_FFFF) as i32;
    if word >> 31 == 0 { magnitude } else { -magnitude }
}

#[cfg(test)]
mod tests;
