//! The arithmetic, by name.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::kernel::{Arithmetic, Reference};
use crate::number::{Format, FormatError, Roots, Rounding, Subnormals};
use crate::query::Fields;

/// An arithmetic with a name (`paper`, `wide`, `exact`, `half`, `bfloat`) or given by its widths (`eXfY`, `eXfYz`).
///
/// Options that differ from the named arithmetic follow the name: `wide+zero`, `paper+flushed`,
/// `wide+kept+faithful`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Profile {
    name: &'static str,
    format: Format,
}

/// The profiles that have a name.
const NAMED: [Profile; 5] = [
    Profile { name: "paper", format: Format::BINARY32 },
    Profile::WIDE,
    Profile::EXACT,
    Profile { name: "half", format: Format::HALF },
    Profile { name: "bfloat", format: Format::BFLOAT },
];

impl Profile {
    /// The default: the significand of binary32, with an exponent that no finite pair overflows.
    pub const WIDE: Self = Self { name: "wide", format: Format::WIDE };

    /// Exact squares in a kernel of its own; the host resolves the pairs that this kernel cannot decide.
    pub const EXACT: Self = Self { name: "exact", format: Format::TAIL };

    /// True if the profile uses the kernel of exact squares.
    pub fn is_exact(&self) -> bool {
        *self == Self::EXACT
    }

    /// This profile with another rounding mode.
    ///
    /// # Errors
    /// [`FormatError::Exact`] for the profile `exact`, whose proof holds for its own rounding only.
    pub fn with_rounding(self, rounding: Rounding) -> Result<Self, FormatError> {
        let format = self.format.with_rounding(rounding);
        self.with_format(format)
    }

    /// This profile with subnormals kept or flushed.
    ///
    /// # Errors
    /// Returns the errors of [`Profile::with_rounding`].
    pub fn with_subnormals(self, subnormals: Subnormals) -> Result<Self, FormatError> {
        let format = self.format.with_subnormals(subnormals);
        self.with_format(format)
    }

    /// This profile with correct or faithful roots and reciprocals.
    ///
    /// # Errors
    /// Returns the errors of [`Profile::with_rounding`], and [`FormatError::Unfaithful`] if the fraction is too long
    /// for faithful roots.
    pub fn with_roots(self, roots: Roots) -> Result<Self, FormatError> {
        if self.is_exact() && roots != self.format.roots() {
            return Err(FormatError::Exact);
        }
        let format = self.format.with_roots(roots)?;
        self.with_format(format)
    }

    fn with_format(self, format: Format) -> Result<Self, FormatError> {
        if self.is_exact() && format != self.format { Err(FormatError::Exact) } else { Ok(Self { format, ..self }) }
    }

    /// The kernel and the number format.
    pub fn arithmetic(&self) -> Arithmetic {
        if self.is_exact() { Arithmetic::Exact } else { Arithmetic::Rounded(self.format) }
    }

    /// The reference kernel of this arithmetic, for these fields of a contact.
    pub fn reference(&self, fields: Fields) -> Reference {
        Reference::of(self.arithmetic(), fields)
    }

    /// The number format; for `exact`, the format of depth, normal and position.
    pub const fn format(&self) -> Format {
        self.format
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(named) = NAMED.into_iter().find(|named| named.name == self.name) else { return self.format.fmt(f) };
        f.write_str(self.name)?;
        let (own, plain) = (self.format, named.format);
        let options = [
            (own.rounding() != plain.rounding()).then(|| own.rounding().to_string()),
            (own.subnormals() != plain.subnormals()).then(|| own.subnormals().to_string()),
            (own.roots() != plain.roots()).then(|| own.roots().to_string()),
        ];
        options.into_iter().flatten().try_for_each(|option| write!(f, "+{option}"))
    }
}

impl FromStr for Profile {
    type Err = FormatError;

    fn from_str(text: &str) -> Result<Self, FormatError> {
        let mut parts = text.split('+');
        let name = parts.next().unwrap_or_default();
        let mut profile = match NAMED.into_iter().find(|profile| profile.name == name) {
            Some(profile) => profile,
            None => Self { name: "", format: name.parse()? },
        };
        for option in parts {
            // No two options share a word.
            profile = if let Ok(rounding) = option.parse() {
                profile.with_rounding(rounding)?
            } else if let Ok(subnormals) = option.parse() {
                profile.with_subnormals(subnormals)?
            } else {
                profile.with_roots(option.parse()?)?
            };
        }
        Ok(profile)
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

    #[test]
    fn options_stand_behind_the_name() {
        for text in ["wide+zero", "paper+flushed", "wide+kept+faithful", "half+zero+flushed+faithful", "e8f15ztr"] {
            assert_eq!(text.parse::<Profile>().expect(text).to_string(), text);
        }
        for (text, same) in [
            ("wide+flushed+nearest+correct", "wide"),
            ("paper+faithful+zero", "paper+zero+faithful"),
            ("e8f15+flushed+zero", "e8f15zt"),
        ] {
            assert_eq!(text.parse::<Profile>().expect(text).to_string(), same);
        }
        for (text, why) in [
            ("exact+faithful", "exact has its own arithmetic"),
            ("exact+zero", "exact has its own arithmetic"),
            ("e11f32+faithful", "up to 31 bits"),
            ("e11f52r", "up to 31 bits"),
            ("wide+up", "unknown option `up`"),
            ("wide+", "unknown option ``"),
        ] {
            let error = text.parse::<Profile>().expect_err(text).to_string();
            assert!(error.contains(why), "{text}: {error}");
        }
        assert!("exact+nearest+flushed+correct".parse::<Profile>().expect("its own").is_exact());
    }
}
