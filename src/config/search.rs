//! The sizes of the search among spheres.

use serde::{Deserialize, Serialize};

use super::{Config, Input, RecordFormat, Results};
use crate::query::{Fields, Query};
use crate::spheres::{BOX_BITS, BoundsRule, RefusedArithmetic};

/// The spheres that a table can hold, as powers of two.
pub const TABLES: std::ops::RangeInclusive<u32> = 512..=65_536;
/// The comparisons of boxes in a cycle, as powers of two.
pub const LANES: std::ops::RangeInclusive<u32> = 16..=256;
/// The deciders that there can be, as powers of two.
pub const DECIDERS: std::ops::RangeInclusive<u32> = 1..=16;

/// The sizes of the search. They change its area and its speed, and never its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Search {
    /// Spheres of the first set, at most: a power of two, one of [`TABLES`].
    pub table: u32,
    /// Bits of each number of a box. Fewer bits make more candidates.
    pub box_bits: u32,
    /// Boxes of spheres that are compared in a cycle: a power of two, one of [`LANES`].
    pub lanes: u32,
    /// Kernels that decide candidates: a power of two, one of [`DECIDERS`].
    pub deciders: u32,
}

impl Default for Search {
    fn default() -> Self {
        Self { table: 4096, box_bits: 24, lanes: 16, deciders: 4 }
    }
}

/// Why a search is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SearchError {
    /// Not a power of two in its range.
    #[error("{what} {value}: expected a power of two from {least} to {most}")]
    Size {
        /// The option.
        what: &'static str,
        /// Its value.
        value: u32,
        /// The least value.
        least: u32,
        /// The largest value.
        most: u32,
    },
    /// A size of the search for an AFU that does not search.
    #[error("{0} with input direct: only input spheres has it; leave it out, or use --input spheres")]
    NoSearch(&'static str),
    /// The arithmetic, or the bits of a box.
    #[error("input spheres: {0}")]
    Refused(#[from] RefusedArithmetic),
    /// Only hits are written.
    #[error("input spheres with results all: only spheres that touch come back; use results hits")]
    Results,
    /// The kernel rounds spheres to a shorter format first.
    #[error(
        "input spheres with {0}: spheres would be rounded before their boxes are made; use wide, or at least 23 fraction bits"
    )]
    Short(super::Profile),
    /// An option that the search does not have.
    #[error("input spheres with {0}: not possible; leave it out")]
    Option(&'static str),
}

impl Search {
    /// True for the default, which files leave out.
    pub(super) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// # Errors
    /// Fails with the first value that is out of range or does not fit the rest of the configuration.
    pub(super) fn check(&self, config: &Config) -> Result<(), SearchError> {
        let sizes =
            [("table", self.table, TABLES), ("lanes", self.lanes, LANES), ("deciders", self.deciders, DECIDERS)];
        if config.input == Input::Direct {
            let default = Self::default();
            let mine = [
                ("table", self.table, default.table),
                ("box-bits", self.box_bits, default.box_bits),
                ("lanes", self.lanes, default.lanes),
                ("deciders", self.deciders, default.deciders),
            ];
            return match mine.into_iter().find(|(_, value, default)| value != default) {
                Some((what, ..)) => Err(SearchError::NoSearch(what)),
                None => Ok(()),
            };
        }
        for (what, value, range) in sizes {
            if !value.is_power_of_two() || !range.contains(&value) {
                return Err(SearchError::Size { what, value, least: *range.start(), most: *range.end() });
            }
        }
        if !BOX_BITS.contains(&self.box_bits) {
            return Err(RefusedArithmetic::Bits(self.box_bits).into());
        }
        if config.results == Results::All {
            return Err(SearchError::Results);
        }
        let options = [
            (config.interval != 1 && config.contact == Fields::HIT, "an interval and contact hit"),
            (config.profile.is_exact(), "profile exact"),
            (config.query != Query::SphereSphere, "another query than sphere-sphere"),
            (config.radius.is_some(), "radius"),
            (config.record != RecordFormat::F32, "record"),
        ];
        if let Some((_, what)) = options.into_iter().find(|(is_asked, _)| *is_asked) {
            return Err(SearchError::Option(what));
        }
        let rule = BoundsRule::new(config.profile.arithmetic(), self.box_bits)?;
        if !rule.contains_binary32() {
            return Err(SearchError::Short(config.profile.clone()));
        }
        Ok(())
    }
}
