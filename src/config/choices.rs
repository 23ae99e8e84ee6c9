//! Options whose value is one of a few words.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::kernel::{narrow, widen};
use crate::number::Format;

/// The value of an option is not one of its words.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown {what} `{given}`: use {words}")]
pub struct ChoiceError {
    what: &'static str,
    given: String,
    words: String,
}

macro_rules! choice {
    ($(#[$about:meta])* $name:ident, $what:literal, default $default:ident, $($(#[$note:meta])* $variant:ident = $word:literal),+) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(rename_all = "lowercase")]
        pub enum $name {
            $($(#[$note])* $variant),+
        }

        impl Default for $name {
            fn default() -> Self {
                Self::$default
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self { $(Self::$variant => $word),+ })
            }
        }

        impl FromStr for $name {
            type Err = ChoiceError;

            fn from_str(text: &str) -> Result<Self, ChoiceError> {
                match text {
                    $($word => Ok(Self::$variant),)+
                    _ => Err(ChoiceError { what: $what, given: text.to_owned(), words: [$($word),+].join(", ") }),
                }
            }
        }
    };
}

choice!(
    /// What the AFU gets.
    Input, "input", default Direct,
    /// Both bodies of every pair, in full.
    Direct = "direct",
    /// Spheres, among which the AFU finds the pairs that touch.
    Spheres = "spheres"
);

choice!(
    /// The pairs for which the AFU returns a record.
    Results, "results", default All,
    /// A record for every pair, in order.
    All = "all",
    /// Only pairs that touch, each with its index.
    Hits = "hits"
);

choice!(
    /// The logic around the line port.
    Shell, "shell", default Spl2,
    /// Nothing: the line port is the top.
    Line = "line",
    /// Intel HARP v1, as in the paper.
    Spl2 = "spl2",
    /// An AXI4 master and an AXI4-Lite slave.
    Axi = "axi"
);

choice!(
    /// The number format of records in memory. Pairs are rounded to it when they are written; contacts are returned in
    /// it.
    RecordFormat, "record", default F32,
    /// IEEE binary32: a pair takes 32 bytes, and a line holds two.
    F32 = "f32",
    /// IEEE binary16: a pair takes 16 bytes, and a line holds four.
    F16 = "f16",
    /// bfloat16, the upper half of binary32: 16 bits with the range of binary32 and 8 significant bits.
    Bf16 = "bf16"
);

choice!(
    /// Whether to use multiplier blocks where logic would do as well. The results have the same bits either way.
    Multipliers, "multipliers", default Use,
    /// Roots and reciprocals by table, with the lowest latency.
    Use = "use",
    /// Roots and reciprocals digit by digit: for a device that runs out of multiplier blocks first.
    Spare = "spare"
);

impl Multipliers {
    /// True for the default, which files leave out.
    pub(super) fn are_used(&self) -> bool {
        *self == Self::Use
    }
}

impl RecordFormat {
    /// The format of a word.
    pub const fn format(self) -> Format {
        match self {
            Self::F32 => Format::BINARY32,
            Self::F16 => Format::HALF,
            Self::Bf16 => Format::BFLOAT,
        }
    }

    /// A number rounded to the nearest that a word can hold.
    pub fn round(self, value: f32) -> f32 {
        f32::from_bits(widen(narrow(value.to_bits(), self.format()), self.format()))
    }

    /// True for the default, which files leave out.
    pub(super) fn is_f32(&self) -> bool {
        *self == Self::F32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_word_lists_the_right_ones() {
        assert_eq!("spl2".parse(), Ok(Shell::Spl2));
        let error = "pcie".parse::<Shell>().expect_err("no such shell").to_string();
        assert_eq!(error, "unknown shell `pcie`: use line, spl2, axi");
    }
}
