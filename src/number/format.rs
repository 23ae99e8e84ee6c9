//! Floating-point formats: widths, rounding, and behaviour at the ends of the range.

use std::fmt;
use std::str::FromStr;

use super::options::{Roots, Rounding, Subnormals};

/// The exponent widths, in bits, that a [`Format`] can have.
pub const EXPONENT_BITS: std::ops::RangeInclusive<u32> = 5..=15;
/// The fraction widths, in bits, that a [`Format`] can have.
pub const FRACTION_BITS: std::ops::RangeInclusive<u32> = 2..=52;

/// A binary floating-point format in the layout of IEEE 754-2019, clause 3.4: sign, biased exponent, fraction.
///
/// It includes the options of the arithmetic: rounding, subnormals, and the accuracy of roots. The largest biased
/// exponent encodes infinities and NaN. Every NaN produced is the canonical quiet one: sign 0, leading fraction bit 1,
/// all others 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Format {
    exponent_bits: u8,
    fraction_bits: u8,
    subnormals: Subnormals,
    rounding: Rounding,
    roots: Roots,
}

/// The longest fraction, in bits, for which there are faithful roots: all significands were tried.
pub const FAITHFUL_FRACTION_BITS: u32 = 31;

/// Why a format was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FormatError {
    /// A width outside [`EXPONENT_BITS`] or [`FRACTION_BITS`].
    #[error("format e{exponent}f{fraction} is out of range: exponent 5 to 15 bits, fraction 2 to 52 bits")]
    Range {
        /// The requested exponent bits.
        exponent: u32,
        /// The requested fraction bits.
        fraction: u32,
    },
    /// Faithful roots exist only for fractions that were checked completely.
    #[error("{0}: faithful roots exist for fractions of up to {FAITHFUL_FRACTION_BITS} bits; use correct roots")]
    Unfaithful(Format),
    /// The proof of the profile `exact` holds only for its own arithmetic.
    #[error(
        "profile exact has its own arithmetic (rounding nearest, subnormals flushed, roots correct); leave out other options"
    )]
    Exact,
    /// Not an option of the arithmetic.
    #[error("unknown option `{0}` of the arithmetic: use nearest or zero, kept or flushed, correct or faithful")]
    Option(String),
    /// Not a profile name and not eXfY.
    #[error("unknown profile `{0}`: use paper, wide, exact, half, bfloat or eXfY such as e8f15")]
    Unknown(String),
}

impl Format {
    /// IEEE binary32 with subnormals: the paper's arithmetic and the record format.
    pub const BINARY32: Self = Self::fixed(8, 23, Subnormals::Kept);
    /// IEEE binary64 with subnormals.
    pub const BINARY64: Self = Self::fixed(11, 52, Subnormals::Kept);
    /// The default arithmetic: the significand of binary32 with a 10-bit exponent, which no finite binary32 pair
    /// overflows or underflows.
    pub const WIDE: Self = Self::fixed(10, 23, Subnormals::Flushed);
    /// Differences of coordinates and sums of radii in the profile `exact`.
    pub const DIFFERENCE: Self = Self::fixed(10, 47, Subnormals::Flushed);
    /// The numbers after the differences in the profile `exact`: distance, depth, normal, position.
    pub const TAIL: Self = Self::fixed(10, 31, Subnormals::Flushed);
    /// IEEE binary16.
    pub const HALF: Self = Self::fixed(5, 10, Subnormals::Kept);
    /// bfloat16.
    pub const BFLOAT: Self = Self::fixed(8, 7, Subnormals::Kept);

    const fn fixed(exponent_bits: u8, fraction_bits: u8, subnormals: Subnormals) -> Self {
        Self { exponent_bits, fraction_bits, subnormals, rounding: Rounding::Nearest, roots: Roots::Correct }
    }

    /// A format of `exponent` (5 to 15) and `fraction` (2 to 52) bits that rounds to nearest and has correct roots.
    ///
    /// # Errors
    /// [`FormatError::Range`] if a width is out of range.
    pub fn new(exponent: u32, fraction: u32, subnormals: Subnormals) -> Result<Self, FormatError> {
        if !EXPONENT_BITS.contains(&exponent) || !FRACTION_BITS.contains(&fraction) {
            return Err(FormatError::Range { exponent, fraction });
        }
        Ok(Self::fixed(exponent as u8, fraction as u8, subnormals))
    }

    /// The same format with another rounding mode.
    #[must_use]
    pub const fn with_rounding(self, rounding: Rounding) -> Self {
        Self { rounding, ..self }
    }

    /// The same format with subnormals kept or flushed.
    #[must_use]
    pub const fn with_subnormals(self, subnormals: Subnormals) -> Self {
        Self { subnormals, ..self }
    }

    /// The same format with correct or faithful roots and reciprocals.
    ///
    /// # Errors
    /// [`FormatError::Unfaithful`] for faithful roots of a fraction longer than [`FAITHFUL_FRACTION_BITS`].
    pub const fn with_roots(self, roots: Roots) -> Result<Self, FormatError> {
        match roots {
            Roots::Faithful if self.fraction_bits() > FAITHFUL_FRACTION_BITS => Err(FormatError::Unfaithful(self)),
            _ => Ok(Self { roots, ..self }),
        }
    }

    /// The format of records with the widths of `record` and the rounding of this arithmetic.
    #[must_use]
    pub const fn record(self, record: Self) -> Self {
        Self { rounding: self.rounding, roots: self.roots, ..record }
    }

    /// The rounding mode of results.
    #[inline]
    pub const fn rounding(self) -> Rounding {
        self.rounding
    }

    /// The handling of subnormal numbers.
    #[inline]
    pub const fn subnormals(self) -> Subnormals {
        self.subnormals
    }

    /// The accuracy of roots and reciprocals.
    #[inline]
    pub const fn roots(self) -> Roots {
        self.roots
    }

    /// Bits of the biased exponent.
    #[inline]
    pub const fn exponent_bits(self) -> u32 {
        self.exponent_bits as u32
    }

    /// Bits of the fraction: the significand without its leading bit.
    #[inline]
    pub const fn fraction_bits(self) -> u32 {
        self.fraction_bits as u32
    }

    /// Bits of the significand, the leading bit included (IEEE 754's precision p).
    #[inline]
    pub(crate) const fn significand_bits(self) -> u32 {
        self.fraction_bits() + 1
    }

    /// Bits of the whole word.
    #[inline]
    pub const fn width(self) -> u32 {
        1 + self.exponent_bits() + self.fraction_bits()
    }

    /// Exponent bias, which is also the largest exponent of a finite number.
    #[inline]
    pub const fn bias(self) -> i32 {
        (1 << (self.exponent_bits - 1)) - 1
    }

    /// Exponent of the smallest normal number.
    #[inline]
    pub const fn min_exponent(self) -> i32 {
        1 - self.bias()
    }

    /// True if subnormals are kept (gradual underflow).
    #[inline]
    pub(crate) const fn keeps_subnormals(self) -> bool {
        matches!(self.subnormals, Subnormals::Kept)
    }

    /// The biased exponent of infinities and NaN: all ones.
    #[inline]
    pub const fn special_exponent(self) -> u32 {
        (1 << self.exponent_bits) - 1
    }

    /// The word of +infinity.
    #[inline]
    pub(crate) const fn infinity_bits(self) -> u128 {
        (self.special_exponent() as u128) << self.fraction_bits
    }

    /// The word of the canonical NaN.
    #[inline]
    pub const fn nan_bits(self) -> u128 {
        self.infinity_bits() | 1 << (self.fraction_bits - 1)
    }

    /// The mask of the sign bit.
    #[inline]
    pub const fn sign_mask(self) -> u128 {
        1 << (self.width() - 1)
    }

    /// The mask of the fraction field.
    #[inline]
    pub const fn fraction_mask(self) -> u128 {
        (1 << self.fraction_bits) - 1
    }
}

impl fmt::Display for Format {
    /// Writes `e8f23`, followed by `z` if subnormals are flushed to zero, `t` if results are truncated (rounded toward
    /// zero) and `r` if roots are faithful.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let flush = if self.keeps_subnormals() { "" } else { "z" };
        let truncate = if self.rounding == Rounding::TowardZero { "t" } else { "" };
        let roots = if self.roots == Roots::Faithful { "r" } else { "" };
        write!(f, "e{}f{}{flush}{truncate}{roots}", self.exponent_bits, self.fraction_bits)
    }
}

impl FromStr for Format {
    type Err = FormatError;

    /// Reads a profile name (`paper`, `wide`, `half`, `bfloat`) or `eXfY` (subnormals kept, nearest, correct roots),
    /// followed by `z`, `t` and `r` for flushed subnormals, truncation and faithful roots.
    fn from_str(text: &str) -> Result<Self, FormatError> {
        match text {
            "paper" => return Ok(Self::BINARY32),
            "wide" => return Ok(Self::WIDE),
            "half" => return Ok(Self::HALF),
            "bfloat" => return Ok(Self::BFLOAT),
            _ => {}
        }
        let whole = text;
        let unknown = || FormatError::Unknown(whole.to_owned());
        let (text, roots) = option(text, 'r', Roots::Faithful);
        let (text, rounding) = option(text, 't', Rounding::TowardZero);
        let (digits, subnormals) = option(text, 'z', Subnormals::Flushed);
        let (exponent, fraction) =
            digits.strip_prefix('e').and_then(|rest| rest.split_once('f')).ok_or_else(unknown)?;
        let plain = |t: &str| t.bytes().all(|b| b.is_ascii_digit()).then(|| t.parse().ok()).flatten();
        let format = Self::new(
            plain(exponent).ok_or_else(unknown)?,
            plain(fraction).ok_or_else(unknown)?,
            subnormals.unwrap_or(Subnormals::Kept),
        )?;
        format.with_rounding(rounding.unwrap_or_default()).with_roots(roots.unwrap_or_default())
    }
}

/// Removes an option letter from the end of a format's text.
fn option<T>(text: &str, letter: char, meaning: T) -> (&str, Option<T>) {
    match text.strip_suffix(letter) {
        Some(rest) => (rest, Some(meaning)),
        None => (text, None),
    }
}
