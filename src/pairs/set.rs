//! The sets of pairs that have names.

use super::{dense, diamond, hard, random};
use crate::kernel::PairRecord;
use std::fmt;
use std::str::FromStr;

/// The most layers a diamond can have: some 16 million pairs.
const LAYERS: u32 = 100;
/// The most random, dense or hard pairs: 3.2 GB of records.
const COUNT: u64 = 100_000_000;

/// A set of pairs made from a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Set {
    /// The candidate pairs of the paper's diamond of so many layers.
    Diamond(u32),
    /// So many random pairs of every kind.
    Random(u64),
    /// So many candidate pairs of crowded scenes.
    Dense(u64),
    /// So many pairs of the hard categories, each in turn.
    Hard(u64),
}

/// Not the name of a set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetError {
    /// Neither of the kinds there are.
    #[error("unknown set of pairs `{0}`: use diamond:H, random:N, dense:N or hard:N")]
    Unknown(String),
    /// Not a number, or too large a one.
    #[error("set of pairs `{name}`: `{size}` must be a number from {least} to {most}")]
    Size {
        /// The whole name.
        name: String,
        /// Its size.
        size: String,
        /// The smallest size.
        least: u64,
        /// The largest size.
        most: u64,
    },
}

impl Set {
    /// Whether `text` can only be meant as the name of a set, right or wrong, and not as a file.
    pub fn is_name(text: &str) -> bool {
        text.split_once(':').is_some_and(|(kind, _)| matches!(kind, "diamond" | "random" | "dense" | "hard"))
    }

    /// The pairs, the same on every machine. `seed` matters to all but the diamond.
    pub fn pairs(self, seed: u64) -> Vec<PairRecord> {
        match self {
            Self::Diamond(layers) => diamond::pairs(layers),
            Self::Random(count) => random::pairs(count, seed),
            Self::Dense(count) => dense::pairs(count, seed),
            Self::Hard(count) => hard::pairs(count, seed),
        }
    }
}

impl fmt::Display for Set {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diamond(layers) => write!(f, "diamond:{layers}"),
            Self::Random(count) => write!(f, "random:{count}"),
            Self::Dense(count) => write!(f, "dense:{count}"),
            Self::Hard(count) => write!(f, "hard:{count}"),
        }
    }
}

impl FromStr for Set {
    type Err = SetError;

    fn from_str(text: &str) -> Result<Self, SetError> {
        let (kind, size) = text.split_once(':').ok_or_else(|| SetError::Unknown(text.to_owned()))?;
        let number = |least, most: u64| {
            let digits = size.bytes().all(|b| b.is_ascii_digit());
            let value = if digits { size.parse().ok() } else { None };
            value.filter(|value| (least..=most).contains(value)).ok_or_else(|| SetError::Size {
                name: text.to_owned(),
                size: size.to_owned(),
                least,
                most,
            })
        };
        match kind {
            "diamond" => Ok(Self::Diamond(number(1, LAYERS.into())? as u32)),
            "random" => Ok(Self::Random(number(0, COUNT)?)),
            "dense" => Ok(Self::Dense(number(0, COUNT)?)),
            "hard" => Ok(Self::Hard(number(0, COUNT)?)),
            _ => Err(SetError::Unknown(text.to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back_and_others_are_refused() {
        for set in [Set::Diamond(10), Set::Random(0), Set::Random(COUNT), Set::Dense(5), Set::Hard(17)] {
            assert_eq!(set.to_string().parse(), Ok(set));
        }
        for wrong in
            ["diamond", "diamond:", "diamond:0", "diamond:101", "random:+5", "random:1e3", "cube:3", "hard:x", ""]
        {
            assert!(wrong.parse::<Set>().is_err(), "{wrong}");
        }
        let error = "diamond:many".parse::<Set>().unwrap_err().to_string();
        assert_eq!(error, "set of pairs `diamond:many`: `many` must be a number from 1 to 100");
    }
}
