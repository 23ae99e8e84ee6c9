//! Options of an arithmetic besides its widths.

/// The rounding of a result that does not fit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Rounding {
    /// To the nearest, ties to even (IEEE 754-2019, clause 4.3.1).
    #[default]
    Nearest,
    /// Toward zero (clause 4.3.2): bits that do not fit are dropped, and no finite result overflows to infinity.
    TowardZero,
}

/// The treatment of values between zero and the smallest normal number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Subnormals {
    /// Gradual underflow (IEEE 754-2019, clause 3.4).
    Kept,
    /// A subnormal operand reads as zero of its sign. A result that would round (with an unbounded exponent) to less
    /// than the smallest normal number is zero of its sign.
    Flushed,
}

/// The accuracy of square roots and reciprocals. Quotients of two numbers are always rounded correctly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Roots {
    /// Rounded correctly, as every other operation.
    #[default]
    Correct,
    /// Less than one unit of the last place from the exact value, whatever the rounding; by a table and a polynomial.
    Faithful,
}

macro_rules! words {
    ($($kind:ident: $($variant:ident = $word:literal),+;)*) => {$(
        impl std::fmt::Display for $kind {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(match self { $(Self::$variant => $word),+ })
            }
        }

        impl std::str::FromStr for $kind {
            type Err = super::FormatError;

            fn from_str(text: &str) -> Result<Self, super::FormatError> {
                match text {
                    $($word => Ok(Self::$variant),)+
                    _ => Err(super::FormatError::Option(text.to_owned())),
                }
            }
        }
    )*};
}

words! {
    Rounding: Nearest = "nearest", TowardZero = "zero";
    Subnormals: Kept = "kept", Flushed = "flushed";
    Roots: Correct = "correct", Faithful = "faithful";
}
