//! The words an operator is made for: a format, and which of its values never come.

use std::fmt;

use super::parts::Rounding;
use crate::number::{self, Format};

/// The values of a format that an operator's operands can take. Excluded values cost no logic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Values {
    /// Every word.
    #[default]
    Any,
    /// Neither infinities nor NaN; subnormals as the format has them.
    Finite,
    /// Zero, with an empty fraction, and normal numbers; and the exact result, if it is not zero, rounds to a normal
    /// number of the result's format without overflow. What comes out for other operands is some word.
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
    /// Writes the format, with `_finite` or `_normal` behind it where not every word comes.
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

    /// The values of it that come.
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

    /// Whether a subnormal may come that counts.
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

    /// The same values, of results that are rounded to nearest.
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
