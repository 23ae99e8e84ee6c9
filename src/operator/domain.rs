//! The words that an operator is made for: a format, and the values in it that never occur.

use std::fmt;

use super::parts::Rounding;
use crate::number::{self, Format};

/// The values of a format that an operator's operands can take. Excluded values cost no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Values {
    /// Every word.
    #[default]
    Any,
    /// Neither infinities nor NaN. The format decides about subnormals.
    Finite,
    /// Zero, with an empty fraction, and normal numbers. The exact result, if it is not zero, rounds to a normal number
    /// of the result's format without overflow. For other operands the result is arbitrary.
    Normal,
}

/// A format, and the values of it that an operator is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Domain {
    format: Format,
    values: Values,
}

impl From<Format> for Domain {
    /// Every word of the format.
    fn from(format: Format) -> Self {
        Self { format, values: Values::Any }
    }
}

impl fmt::Display for Domain {
    /// Writes the format, followed by `_finite` or `_normal` if not every word occurs.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = match self.values {
            Values::Any => "",
            Values::Finite => "_finite",
            Values::Normal => "_normal",
        };
        write!(f, "{}{values}", self.format)
    }
}

impl Domain {
    /// These values of `format`.
    pub const fn new(format: Format, values: Values) -> Self {
        Self { format, values }
    }

    /// The format.
    pub const fn format(self) -> Format {
        self.format
    }

    /// The values that occur.
    pub const fn values(self) -> Values {
        self.values
    }

    /// True if operands are neither infinite nor NaN.
    pub const fn is_finite(self) -> bool {
        !matches!(self.values, Values::Any)
    }

    /// True if operands and result are zero or normal.
    pub const fn is_normal(self) -> bool {
        matches!(self.values, Values::Normal)
    }

    /// True if a subnormal may occur and is not flushed.
    pub(crate) const fn keeps_subnormals(self) -> bool {
        self.format.keeps_subnormals() && !self.is_normal()
    }

    /// The rounding of results.
    pub const fn rounding(self) -> Rounding {
        match self.format.rounding() {
            number::Rounding::Nearest => Rounding::NearestEven,
            number::Rounding::TowardZero => Rounding::TowardZero,
        }
    }

    /// The same values, with results that are rounded to nearest.
    pub(crate) const fn to_nearest(self) -> Self {
        Self { format: self.format.with_rounding(number::Rounding::Nearest), ..self }
    }

    /// Bits of the biased exponent.
    pub const fn exponent_bits(self) -> u32 {
        self.format.exponent_bits()
    }

    /// Bits of the fraction.
    pub const fn fraction_bits(self) -> u32 {
        self.format.fraction_bits()
    }

    /// Bits of the significand, the leading bit included.
    pub(crate) const fn significand_bits(self) -> u32 {
        self.format.significand_bits()
    }

    /// Exponent bias.
    pub const fn bias(self) -> i32 {
        self.format.bias()
    }

    /// Exponent of the smallest normal number.
    pub(crate) const fn min_exponent(self) -> i32 {
        self.format.min_exponent()
    }

    /// The biased exponent of infinities and NaN.
    pub(crate) const fn special_exponent(self) -> u32 {
        self.format.special_exponent()
    }

    /// Bits of the whole word.
    pub const fn width(self) -> u32 {
        self.format.width()
    }
}
