//! The configuration of an AFU: one value, read from options or a file, that generator, simulation and reports share.

mod choices;
mod error;
mod file;
mod flags;
mod profile;
mod search;

pub use choices::{Input, Multipliers, RecordFormat, Results, Shell};
pub use error::Error;
pub use file::{MANIFEST_SCHEMA, ReadError, read};
pub use profile::Profile;
pub use search::{DECIDERS, LANES, Search, SearchError, TABLES};

use serde::{Deserialize, Serialize};

use crate::kernel::Reference;
use crate::number::Roots;
use crate::query::{Fields, Query};

/// The numbers of SCPUs that an AFU can have.
pub const SCPUS: std::ops::RangeInclusive<u32> = 1..=64;

/// The initiation intervals that an SCPU can have, in cycles.
pub const INTERVALS: std::ops::RangeInclusive<u32> = 1..=64;

/// The SCPUs in front of the others that only decide.
pub const DECIDE: [u32; 3] = [1, 2, 4];

/// The reads, and the writes, that an AFU can have in flight.
pub const OUTSTANDING: std::ops::RangeInclusive<u32> = 16..=256;

/// The widths that the AXI4 master's data can have, in bits.
pub const BUSES: [u32; 3] = [128, 256, 512];

/// The most that SPL2 takes: its own hardware is almost full at 58 reads, and at 54 writes.
const OUTSTANDING_OVER_SPL2: u32 = 64;

/// The maximum length of a prefix, in characters.
const LONGEST_PREFIX: usize = 32;

/// The configuration of an AFU. [`Config::shipped`] is the configuration of the Verilog in `rtl/`.
///
/// In JSON it is the object `config` of a manifest. Missing keys have their defaults; unknown keys are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Number of sphere collision processing units. It is a Verilog parameter and changes only the top's default.
    pub scpus: u32,
    /// Initiation interval: the cycles between two pairs in one SCPU, which has as few operators as that permits. At
    /// most as many SCPUs are built as take a full line of pairs per cycle. (With two pairs per line, that is the
    /// largest multiple of twice the interval.)
    pub interval: u32,
    /// The kind of pair, such as sphere-sphere.
    #[serde(skip_serializing_if = "Query::is_default")]
    pub query: Query,
    /// The arithmetic of the kernel.
    pub profile: Profile,
    /// The fields of a contact that are computed.
    #[serde(with = "text")]
    pub contact: Fields,
    /// What the AFU gets: pairs, or spheres among which it finds them.
    pub input: Input,
    /// The sizes of the search, if spheres come in.
    #[serde(skip_serializing_if = "Search::is_default")]
    pub search: Search,
    /// SCPUs that only decide whether a pair touches, one pair per cycle each, in front of those that compute contacts.
    /// 0: each SCPU does both.
    #[serde(skip_serializing_if = "is_zero")]
    pub decide: u32,
    /// The pairs for which the AFU returns a record.
    pub results: Results,
    /// The radius of all spheres, a length, as a constant of the hardware; records then have no radii. `None`: each
    /// sphere has its own radius.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f32>,
    /// The number format of records in memory.
    #[serde(skip_serializing_if = "RecordFormat::is_f32")]
    pub record: RecordFormat,
    /// Whether to use multiplier blocks or to spare them.
    #[serde(skip_serializing_if = "Multipliers::are_used")]
    pub multipliers: Multipliers,
    /// The shell around the line port.
    pub shell: Shell,
    /// The most reads, and the most writes, in flight: a power of two, one of [`OUTSTANDING`].
    #[serde(skip_serializing_if = "is_usual")]
    pub outstanding: u32,
    /// Bits of the AXI4 master's data, one of [`BUSES`]. Only the shell `axi` has one.
    #[serde(skip_serializing_if = "is_widest")]
    pub bus: u32,
    /// The clock in MHz. It converts cycles into time, and stages are cut for it unless `cut_mhz` is given.
    pub clock_mhz: f64,
    /// The clock in MHz that stages are cut for, if it differs: place and route may reach less than they were cut for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut_mhz: Option<f64>,
    /// The prefix of the names of all modules and files, before a `_`, so that one design can hold several AFUs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prefix: Option<String>,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            scpus: 10,
            interval: 1,
            query: Query::default(),
            profile: Profile::WIDE,
            contact: Fields::ALL,
            input: Input::Direct,
            search: Search::default(),
            decide: 0,
            results: Results::All,
            radius: None,
            record: RecordFormat::F32,
            multipliers: Multipliers::Use,
            shell: Shell::Spl2,
            outstanding: 64,
            bus: 512,
            clock_mhz: 200.0,
            cut_mhz: None,
            prefix: None,
        }
    }
}

impl Config {
    /// Checks that an AFU of this configuration can be generated.
    ///
    /// # Errors
    /// Returns an error if a value is out of range, or a combination is not supported.
    pub fn check(&self) -> Result<(), Error> {
        if !SCPUS.contains(&self.scpus) {
            return Err(Error::Scpus(self.scpus));
        }
        if !INTERVALS.contains(&self.interval) {
            return Err(Error::Interval(self.interval));
        }
        if !self.outstanding.is_power_of_two() || !OUTSTANDING.contains(&self.outstanding) {
            return Err(Error::Outstanding(self.outstanding));
        }
        if self.shell == Shell::Spl2 && self.outstanding > OUTSTANDING_OVER_SPL2 {
            return Err(Error::OutstandingOverSpl2(self.outstanding));
        }
        if !BUSES.contains(&self.bus) {
            return Err(Error::Bus(self.bus));
        }
        if self.shell != Shell::Axi && !is_widest(&self.bus) {
            return Err(Error::NoBus(self.bus, self.shell));
        }
        let clocks = [self.clock_mhz, self.cut_mhz()];
        if let Some(clock) = clocks.into_iter().find(|clock| !(1.0..=2000.0).contains(clock)) {
            return Err(Error::Clock(clock));
        }
        if let Some(prefix) = self.prefix.as_ref().filter(|prefix| !is_prefix(prefix)) {
            return Err(Error::Prefix(prefix.clone()));
        }
        if self.profile.is_exact() && self.contact == Fields::HIT {
            return Err(Error::ExactHit);
        }
        if self.profile.is_exact() && self.results == Results::Hits {
            return Err(Error::ExactHits);
        }
        if self.profile.is_exact() && self.record != RecordFormat::F32 {
            return Err(Error::ExactRecord(self.record));
        }
        if self.query != Query::SphereSphere {
            let alone = [(self.profile.is_exact(), "profile exact"), (self.radius.is_some(), "radius")];
            if let Some((_, what)) = alone.into_iter().find(|(is_asked, _)| *is_asked) {
                return Err(Error::SpheresAlone(self.query, what));
            }
        }
        if let Some(radius) = self.radius
            && !(0.0..=f32::MAX).contains(&radius)
        {
            return Err(Error::Radius(radius));
        }
        if let Some(radius) = self.radius.filter(|&radius| self.record.round(radius).is_infinite()) {
            return Err(Error::RecordRadius(radius, self.record));
        }
        self.search.check(self)?;
        self.check_decide()
    }

    fn check_decide(&self) -> Result<(), Error> {
        if self.decide == 0 {
            return Ok(());
        }
        let refused = [
            (self.input == Input::Spheres, "input spheres", "spheres have deciders of their own; use deciders instead"),
            (self.results == Results::All, "results all", "every pair has a record then; use results hits"),
            (self.contact == Fields::HIT, "contact hit", "every SCPU only decides then; leave it out"),
            (
                self.profile.format().roots() == Roots::Faithful,
                "faithful roots",
                "the whole kernel decides by its root, and other pairs would touch; use correct roots",
            ),
        ];
        match refused.into_iter().find(|(is_so, ..)| *is_so) {
            Some((_, what, why)) => Err(Error::Decide(self.decide, what, why)),
            None if !DECIDE.contains(&self.decide) => Err(Error::DecideRange(self.decide)),
            None => Ok(()),
        }
    }

    /// True if SCPUs compute contacts behind others that decided that they touch. Their number is then no parameter of
    /// the Verilog, and at most one contact per cycle is computed.
    pub fn has_deciders(&self) -> bool {
        self.input == Input::Spheres || self.decide > 0
    }

    /// The reference kernel, with which every implementation of this configuration is compared.
    pub fn reference(&self) -> Reference {
        self.profile.reference(self.contact).of_query(self.query).with_record(self.record.format())
    }

    /// The clock that stages are cut for, in MHz.
    pub fn cut_mhz(&self) -> f64 {
        self.cut_mhz.unwrap_or(self.clock_mhz)
    }

    /// The name of a module or file, with the prefix if there is one.
    pub(crate) fn prefixed(&self, name: &str) -> String {
        self.prefix.as_ref().map_or_else(|| name.to_owned(), |prefix| format!("{prefix}_{name}"))
    }

    /// The clock period in nanoseconds.
    pub fn cycle_ns(&self) -> f64 {
        1000.0 / self.clock_mhz
    }

    /// The configuration of the Verilog in `rtl/` and of the built-in model, which `afu rtl` writes without options. It
    /// is the default, but with the longest interval at which ten SCPUs still take a full line of pairs per cycle.
    pub fn shipped() -> Self {
        Self { interval: 5, ..Self::default() }
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(number: &u32) -> bool {
    *number == 0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_usual(outstanding: &u32) -> bool {
    *outstanding == Config::default().outstanding
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_widest(bus: &u32) -> bool {
    *bus == Config::default().bus
}

fn is_prefix(text: &str) -> bool {
    let is_word = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    is_word && (1..=LONGEST_PREFIX).contains(&text.len()) && !text.starts_with(|c: char| c.is_ascii_digit())
}

/// Values that JSON holds as text.
mod text {
    use std::fmt::Display;
    use std::str::FromStr;

    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<T: Display, S: Serializer>(value: &T, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(value)
    }

    pub(super) fn deserialize<'de, T: FromStr<Err: Display>, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
        String::deserialize(from)?.parse().map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_keeps_a_configuration() {
        let config =
            Config { scpus: 3, contact: Fields::HIT, clock_mhz: 312.5, cut_mhz: Some(350.0), ..Config::default() };
        let json = serde_json::to_string(&config).expect("plain values");
        assert_eq!(serde_json::from_str::<Config>(&json).expect("as written"), config);
        assert_eq!(serde_json::from_str::<Config>("{}").expect("all defaults"), Config::default());
        let unknown = serde_json::from_str::<Config>(r#"{"scpu": 3}"#).expect_err("no such key");
        assert!(unknown.to_string().contains("scpu"), "{unknown}");
    }

    #[test]
    fn what_is_not_built_is_refused() {
        assert_eq!(Config::default().check(), Ok(()));
        let hits = Config { results: Results::Hits, ..Config::default() };
        let bad = [
            (Config { scpus: 0, ..Config::default() }, "0 SCPUs"),
            (Config { scpus: 65, ..Config::default() }, "65 SCPUs"),
            (Config { clock_mhz: f64::NAN, ..Config::default() }, "clock NaN"),
            (Config { cut_mhz: Some(0.5), ..Config::default() }, "clock 0.5"),
            (Config { interval: 0, ..Config::default() }, "interval 0"),
            (Config { interval: 65, ..Config::default() }, "interval 65"),
            (Config { outstanding: 96, ..Config::default() }, "96 requests in flight: expected 16, 32"),
            (Config { outstanding: 512, shell: Shell::Line, ..Config::default() }, "512 requests in flight"),
            (Config { outstanding: 128, ..Config::default() }, "128 requests in flight: expected at most 64 below"),
            (
                Config { profile: Profile::EXACT, contact: Fields::HIT, ..Config::default() },
                "profile exact with contact",
            ),
            (
                Config { profile: Profile::EXACT, results: Results::Hits, ..Config::default() },
                "profile exact with results",
            ),
            (
                Config { profile: Profile::EXACT, record: RecordFormat::F16, ..Config::default() },
                "profile exact with record f16",
            ),
            (
                Config { radius: Some(1e6), record: RecordFormat::F16, ..Config::default() },
                "radius 1000000: infinite in f16 records",
            ),
            (
                Config { query: Query::SpherePlane, profile: Profile::EXACT, ..Config::default() },
                "query sphere-plane with profile exact",
            ),
            (
                Config { query: Query::SpherePlane, radius: Some(0.5), ..Config::default() },
                "query sphere-plane with radius",
            ),
            (Config { prefix: Some("2x".into()), ..Config::default() }, "prefix `2x`"),
            (Config { prefix: Some("a-b".into()), ..Config::default() }, "prefix `a-b`"),
            (Config { prefix: Some(String::new()), ..Config::default() }, "prefix ``"),
            (Config { bus: 64, shell: Shell::Axi, ..Config::default() }, "bus of 64 bits: expected 128, 256 or 512"),
            (Config { bus: 128, ..Config::default() }, "bus of 128 bits below shell spl2"),
            (Config { decide: 1, ..Config::default() }, "decide 1 with results all"),
            (Config { decide: 1, contact: Fields::HIT, ..hits.clone() }, "decide 1 with contact hit"),
            (
                Config { decide: 1, profile: "wide+faithful".parse().expect("a profile"), ..hits.clone() },
                "decide 1 with faithful",
            ),
            (Config { decide: 3, ..hits.clone() }, "decide 3: expected 0, 1, 2 or 4"),
            (Config { decide: 1, profile: Profile::EXACT, ..hits }, "profile exact with results hits"),
        ];
        for (config, begins) in bad {
            let error = config.check().expect_err(begins).to_string();
            assert!(error.starts_with(begins), "{error}");
        }
    }
}
