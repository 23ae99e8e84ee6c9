//! The sets of pairs that have names.

use super::{dense, diamond, hard, random};
use crate::query::{PairRecord, Query};
use std::fmt;
use std::str::FromStr;

/// The most layers a diamond can have: some 16 million pairs.
const LAYERS: u32 = 100;
/// The most random, dense or hard pairs: 3.2 GB of records.
const COUNT: u64 = 100_000_000;

/// A set of pairs made from a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Set {
    /// The candidate pairs of the paper's diamond with this number of layers.
    Diamond(u32),
    /// This number of random pairs of every kind.
    Random(u64),
    /// This number of candidate pairs of crowded scenes.
    Dense(u64),
    /// This number of hard pairs, from each category in turn.
    Hard(u64),
}

/// A text that names no set of pairs.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetError {
    /// The kind is unknown.
    #[error("unknown set of pairs `{name}`: use diamond:H, random:N, dense:N or hard:N{}", tip(meant))]
    Unknown {
        /// The given text.
        name: String,
        /// A set that was probably meant.
        meant: Option<String>,
    },
    /// The set has pairs of two spheres only.
    #[error("set of pairs `{set}`: it has pairs of two spheres only; for {query} use random:N or hard:N")]
    SpheresAlone {
        /// The set.
        set: Set,
        /// The query.
        query: Query,
    },
    /// The size is not a number or out of range.
    #[error("set of pairs `{name}`: expected a number from {least} to {most}, found `{size}`{}", tip(meant))]
    Size {
        /// The whole name.
        name: String,
        /// Its size.
        size: String,
        /// The smallest size.
        least: u64,
        /// The largest size.
        most: u64,
        /// A set that was probably meant.
        meant: Option<String>,
    },
}

fn tip(meant: &Option<String>) -> String {
    meant.as_ref().map(|meant| format!("; did you mean {meant}?")).unwrap_or_default()
}

/// The kinds of sets.
const KINDS: [&str; 4] = ["diamond", "random", "dense", "hard"];

/// The digits of a whole number written in another way: `1e6`, `1_000_000`.
fn whole(text: &str) -> Option<String> {
    let plain: String = text.chars().filter(|c| !matches!(c, '_' | ',' | '\'' | '+')).collect();
    let value: f64 = plain.parse().ok()?;
    (value.fract() == 0.0 && (0.0..1e15).contains(&value)).then(|| format!("{value}"))
}

impl Set {
    /// True if `text` can only be the name of a set, right or wrong, and not a file.
    pub(crate) fn is_name(text: &str) -> bool {
        text.split_once(':').is_some_and(|(kind, _)| KINDS.contains(&kind))
    }

    /// The set that `text` may stand for, if its kind is nearly right.
    pub(super) fn meant(text: &str) -> Option<String> {
        let (kind, size) = text.split_once(':')?;
        let likeness = |known: &&str| strsim::jaro(known, &kind.to_lowercase());
        let nearest = KINDS.into_iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
        (likeness(&nearest) > 0.7).then(|| format!("{nearest}:{}", whole(size).unwrap_or_else(|| size.to_owned())))
    }

    /// The pairs of spheres, the same on every machine. `seed` matters to all but the diamond.
    pub fn pairs(self, seed: u64) -> Vec<PairRecord> {
        match self {
            Self::Diamond(layers) => diamond::pairs(layers),
            Self::Random(count) => random::pairs(Query::SphereSphere, count, seed),
            Self::Dense(count) => dense::pairs(count, seed),
            Self::Hard(count) => hard::pairs(Query::SphereSphere, count, seed),
        }
    }

    /// The pairs of a query.
    ///
    /// # Errors
    /// Returns an error if the set has pairs of two spheres only and the query is another.
    pub fn pairs_of(self, query: Query, seed: u64) -> Result<Vec<PairRecord>, SetError> {
        match self {
            _ if query == Query::SphereSphere => Ok(self.pairs(seed)),
            Self::Random(count) => Ok(random::pairs(query, count, seed)),
            Self::Hard(count) => Ok(hard::pairs(query, count, seed)),
            Self::Diamond(_) | Self::Dense(_) => Err(SetError::SpheresAlone { set: self, query }),
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
        let unknown = || SetError::Unknown { name: text.to_owned(), meant: Self::meant(text) };
        let (kind, size) = text.split_once(':').ok_or_else(unknown)?;
        let number = |least, most: u64| {
            let digits = size.bytes().all(|b| b.is_ascii_digit());
            let value = if digits { size.parse().ok() } else { None };
            let is_within = |meant: &str| meant.parse().is_ok_and(|meant: u64| (least..=most).contains(&meant));
            value.filter(|value| (least..=most).contains(value)).ok_or_else(|| SetError::Size {
                name: text.to_owned(),
                size: size.to_owned(),
                least,
                most,
                meant: whole(size).filter(|meant| is_within(meant)).map(|meant| format!("{kind}:{meant}")),
            })
        };
        match kind {
            "diamond" => Ok(Self::Diamond(number(1, LAYERS.into())? as u32)),
            "random" => Ok(Self::Random(number(0, COUNT)?)),
            "dense" => Ok(Self::Dense(number(0, COUNT)?)),
            "hard" => Ok(Self::Hard(number(0, COUNT)?)),
            _ => Err(unknown()),
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
        assert_eq!(error, "set of pairs `diamond:many`: expected a number from 1 to 100, found `many`");
    }

    #[test]
    fn what_may_be_meant_is_said() {
        for (wrong, meant) in [
            ("random:1e6", Some("random:1000000")),
            ("dense:10_000", Some("dense:10000")),
            ("random:1.5", None),
            ("random:1e9", None),
            ("diamond:0", None),
            ("diamnd:3", Some("diamond:3")),
            ("Random:1e3", Some("random:1000")),
            ("rand:x", Some("random:x")),
            ("cube:3", None),
        ] {
            let error = wrong.parse::<Set>().unwrap_err().to_string();
            let tip = meant.map(|meant| format!("; did you mean {meant}?"));
            assert_eq!(error.find("; did you mean").map(|at| error[at..].to_owned()), tip, "{error}");
        }
    }
}
