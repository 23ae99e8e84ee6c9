//! The arithmetic by its name.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::kernel::{Arithmetic, Fields, Reference};
use crate::number::{Format, FormatError};

/// A named arithmetic (`paper`, `wide`, `exact`, `half`, `bfloat`) or one given by its widths (`eXfY`, `eXfYz`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Profile {
    name: &'static str,
    format: Format,
}

/// The named ones.
const NAMED: [Profile; 5] = [
    Profile { name: "paper", format: Format::BINARY32 },
    Profile::WIDE,
    Profile::EXACT,
    Profile { name: "half", format: Format::HALF },
    Profile { name: "bfloat", format: Format::BFLOAT },
];

impl Profile {
    /// The default: binary32's significand, and exponents no finite pair exhausts.
    pub const WIDE: Self = Self { name: "wide", format: Format::WIDE };

    /// Exact squares and a host that settles what they cannot: a kernel of its own.
    pub const EXACT: Self = Self { name: "exact", format: Format::TAIL };

    /// Whether its kernel is the one of exact squares.
    pub fn is_exact(&self) -> bool {
        *self == Self::EXACT
    }

    /// Its kernel and numbers.
    pub fn arithmetic(&self) -> Arithmetic {
        if self.is_exact() { Arithmetic::Exact } else { Arithmetic::Rounded(self.format) }
    }

    /// Its reference kernel.
    pub fn reference(&self, fields: Fields) -> Reference {
        Reference::of(self.arithmetic(), fields)
    }

    /// The number format of its arithmetic; of `exact`, that of depth, normal and position.
    pub const fn format(&self) -> Format {
        self.format
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.name.is_empty() { self.format.fmt(f) } else { f.write_str(self.name) }
    }
}

impl FromStr for Profile {
    type Err = FormatError;

    fn from_str(text: &str) -> Result<Self, FormatError> {
        match NAMED.into_iter().find(|profile| profile.name == text) {
            Some(profile) => Ok(profile),
            None => Ok(Self { name: "", format: text.parse()? }),
        }
    }
}

impl Serialize for Profile {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Profile {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        String::deserialize(from)?.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_keeps_the_name_it_was_given() {
        for text in ["paper", "wide", "exact", "half", "bfloat", "e8f15", "e10f23z"] {
            assert_eq!(text.parse::<Profile>().expect(text).to_string(), text);
        }
        assert_eq!("wide".parse::<Profile>().expect("named").format(), Format::WIDE);
        assert!("exact".parse::<Profile>().expect("named").is_exact() && !Profile::WIDE.is_exact());
        assert!("e99f1".parse::<Profile>().is_err());
    }
}
