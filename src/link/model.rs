//! What a link is like, as data, and what it allows at best.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Reads, and likewise writes, that an AFU may have outstanding.
pub const MAX_OUTSTANDING: u32 = 64;

/// A link: two directions, an order, and a bandwidth both share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkModel {
    /// What reports call it.
    pub name: String,
    /// From a read request to its data.
    pub read: Direction,
    /// From a write request to its acknowledgement.
    pub write: Direction,
    /// Whether responses of one direction overtake each other.
    pub order: Order,
    /// Lines a cycle in both directions together, above 0 and up to 2.
    #[serde(default = "both")]
    pub lines_per_cycle: f64,
}

/// One direction of a link.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Direction {
    /// Cycles from the acceptance of a request to its response, at least 1.
    pub latency: u32,
    /// Up to so many cycles more, evenly distributed.
    #[serde(default)]
    pub tail: u32,
    /// Rare responses that are much later.
    #[serde(default)]
    pub stragglers: Stragglers,
    /// Spans of cycles in which no request is accepted.
    #[serde(default)]
    pub stalls: Stalls,
    /// Lines a cycle, above 0 and up to 1.
    #[serde(default = "one")]
    pub lines_per_cycle: f64,
}

/// Responses that come much later than the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stragglers {
    /// The share of responses, 0 to 1.
    pub share: f64,
    /// The cycles they take beyond the others.
    pub cycles: u32,
}

/// Spans of cycles in which `ready` is low, whether or not there is a request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stalls {
    /// The chance that one begins in a cycle outside of one: at least 0, below 1.
    pub chance: f64,
    /// The longest, in cycles; lengths from 1 to this are equally likely.
    pub longest: u32,
}

/// The order of responses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// That of the requests: a late response delays those behind it.
    InOrder,
    /// Any: of those that are due, one at random.
    Shuffled,
}

fn one() -> f64 {
    1.0
}

fn both() -> f64 {
    2.0
}

/// A link that does not exist or cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinkError {
    /// Not the name of a preset.
    #[error("unknown link `{0}`: use {presets}", presets = LinkModel::PRESETS.join(", "))]
    Unknown(String),
    /// A value outside its range.
    #[error("link `{link}`: {field} is {value}, but must be {range}")]
    Range {
        /// The link.
        link: String,
        /// The field.
        field: &'static str,
        /// What it holds.
        value: f64,
        /// What it may hold.
        range: &'static str,
    },
}

impl LinkModel {
    /// The names [`FromStr`] knows.
    pub const PRESETS: [&'static str; 4] = ["ideal", "late", "shuffled", "hostile"];

    /// One line a cycle each way, answered in the next cycle: what the AFU alone can do.
    pub fn ideal() -> Self {
        Self::new("ideal", Direction::steady(1, 0), Order::InOrder)
    }

    /// Reads of 71 to 118 cycles, the latency and tail recalled for HARP v1 at 200 MHz (Choi et al., DAC 2016), in order
    /// and without a bandwidth limit; writes alike.
    pub fn late() -> Self {
        Self::new("late", Direction::steady(71, 47), Order::InOrder)
    }

    /// Responses in any order within some 40 cycles.
    pub fn shuffled() -> Self {
        Self::new("shuffled", Direction::steady(20, 40), Order::Shuffled)
    }

    /// Everything a link may do to an AFU short of a fault: any order, stragglers, refusals, little bandwidth.
    pub fn hostile() -> Self {
        let stalls = Stalls { chance: 0.04, longest: 30 };
        let stragglers = Stragglers { share: 0.005, cycles: 600 };
        let read = Direction { stalls, stragglers, lines_per_cycle: 0.8, ..Direction::steady(1, 60) };
        let write = Direction { lines_per_cycle: 0.9, ..read };
        Self { write, lines_per_cycle: 0.9, ..Self::new("hostile", read, Order::Shuffled) }
    }

    fn new(name: &str, both_ways: Direction, order: Order) -> Self {
        Self { name: name.to_owned(), read: both_ways, write: both_ways, order, lines_per_cycle: both() }
    }

    /// Whether every value is in its range.
    ///
    /// # Errors
    /// [`LinkError::Range`] with the first that is not.
    pub fn check(&self) -> Result<(), LinkError> {
        let fail = |field, value, range| Err(LinkError::Range { link: self.name.clone(), field, value, range });
        for d in [&self.read, &self.write] {
            if d.latency == 0 {
                return fail("latency", 0.0, "at least 1 cycle");
            }
            if !(d.lines_per_cycle > 0.0 && d.lines_per_cycle <= 1.0) {
                return fail("lines_per_cycle of a direction", d.lines_per_cycle, "above 0 and at most 1");
            }
            if !(0.0..=1.0).contains(&d.stragglers.share) {
                return fail("the share of stragglers", d.stragglers.share, "from 0 to 1");
            }
            if !(0.0..1.0).contains(&d.stalls.chance) {
                return fail("the chance of stalls", d.stalls.chance, "at least 0 and below 1");
            }
        }
        if !(self.lines_per_cycle > 0.0 && self.lines_per_cycle <= 2.0) {
            return fail("lines_per_cycle", self.lines_per_cycle, "above 0 and at most 2");
        }
        Ok(())
    }

    /// The cycles that so many lines read and written take at least over this link, on average over its randomness: what
    /// its bandwidths, its stalls and (by Little's law) its latency under [`MAX_OUTSTANDING`] requests allow.
    pub fn limit_cycles(&self, lines_read: u64, lines_written: u64) -> f64 {
        let (read, written) = (lines_read as f64, lines_written as f64);
        let alone = (read * self.read.cycles_per_read()).max(written * self.write.cycles_per_write());
        alone.max((read + written) / self.lines_per_cycle)
    }

    /// The longest wait for one response that is no fault, in cycles; beyond it an AFU waits in vain. A generous bound:
    /// a response may queue behind all others.
    #[cfg(feature = "cosim")]
    pub(crate) fn patience_cycles(&self) -> u64 {
        let slowest = |d: &Direction| {
            let each = u64::from(d.latency) + u64::from(d.tail) + u64::from(d.stragglers.cycles);
            let spaced = (f64::from(MAX_OUTSTANDING) * d.cycles_per_write()).ceil() as u64;
            each + 2 * spaced + 64 * u64::from(d.stalls.longest)
        };
        let joint = (4.0 * f64::from(MAX_OUTSTANDING) / self.lines_per_cycle).ceil() as u64;
        2 * (slowest(&self.read).max(slowest(&self.write)) + joint)
    }
}

impl Direction {
    /// Without stalls, stragglers or a bandwidth limit.
    pub fn steady(latency: u32, tail: u32) -> Self {
        let (stragglers, stalls) = (Stragglers::default(), Stalls::default());
        Self { latency, tail, stragglers, stalls, lines_per_cycle: one() }
    }

    fn mean_latency(&self) -> f64 {
        let late = self.stragglers.share * f64::from(self.stragglers.cycles);
        f64::from(self.latency) + f64::from(self.tail) / 2.0 + late
    }

    /// The share of cycles in which requests are accepted: runs of (1 − c) / c cycles on average between stalls of half
    /// the longest.
    fn ready_share(&self) -> f64 {
        let Stalls { chance, longest } = self.stalls;
        if longest == 0 {
            return 1.0;
        }
        (1.0 - chance) / (1.0 - chance + chance * (1.0 + f64::from(longest)) / 2.0)
    }

    /// Stalls refuse requests while the data of earlier ones still comes: the tighter of the two counts.
    fn cycles_per_read(&self) -> f64 {
        self.in_flight_limit().max(1.0 / self.lines_per_cycle).max(1.0 / self.ready_share())
    }

    /// A write carries its data, so a stall stops the data too: the two multiply.
    fn cycles_per_write(&self) -> f64 {
        self.in_flight_limit().max(1.0 / (self.lines_per_cycle * self.ready_share()))
    }

    /// Little's law: cycles a line that the latency leaves.
    fn in_flight_limit(&self) -> f64 {
        self.mean_latency() / f64::from(MAX_OUTSTANDING)
    }
}

impl Default for LinkModel {
    fn default() -> Self {
        Self::ideal()
    }
}

impl FromStr for LinkModel {
    type Err = LinkError;

    fn from_str(name: &str) -> Result<Self, LinkError> {
        match name {
            "ideal" => Ok(Self::ideal()),
            "late" => Ok(Self::late()),
            "shuffled" => Ok(Self::shuffled()),
            "hostile" => Ok(Self::hostile()),
            _ => Err(LinkError::Unknown(name.to_owned())),
        }
    }
}

impl fmt::Display for LinkModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_have_their_names_and_are_possible() {
        for name in LinkModel::PRESETS {
            let model: LinkModel = name.parse().unwrap();
            assert_eq!(model.to_string(), name);
            model.check().unwrap();
        }
        let error = "idea".parse::<LinkModel>().unwrap_err().to_string();
        assert_eq!(error, "unknown link `idea`: use ideal, late, shuffled, hostile");
    }

    #[test]
    fn limits_are_those_of_the_tightest_bound() {
        assert_eq!(LinkModel::ideal().limit_cycles(1000, 1000), 1000.0);
        assert_eq!(LinkModel::ideal().limit_cycles(10, 1000), 1000.0);
        let late = LinkModel::late().limit_cycles(1000, 0); // 94.5 cycles with 64 in flight
        assert!((late - 1000.0 * 94.5 / 64.0).abs() < 1e-9, "{late}");
        let hostile = LinkModel::hostile().limit_cycles(900, 900); // 1800 lines at 0.9 a cycle
        assert!((hostile - 2000.0).abs() < 1e-9, "{hostile}");
    }

    #[test]
    fn values_out_of_range_are_named() {
        let mut model = LinkModel::ideal();
        model.read.latency = 0;
        assert_eq!(model.check().unwrap_err().to_string(), "link `ideal`: latency is 0, but must be at least 1 cycle");
        model.read.latency = 1;
        model.write.lines_per_cycle = f64::NAN;
        assert!(matches!(model.check(), Err(LinkError::Range { field: "lines_per_cycle of a direction", .. })));
    }

    #[test]
    fn a_model_is_data() {
        let text = serde_json::to_string(&LinkModel::hostile()).unwrap();
        assert_eq!(serde_json::from_str::<LinkModel>(&text).unwrap(), LinkModel::hostile());
        let short = r#"{"name":"x","read":{"latency":9},"write":{"latency":3},"order":"in_order"}"#;
        let model: LinkModel = serde_json::from_str(short).unwrap();
        assert_eq!((model.read, model.lines_per_cycle), (Direction::steady(9, 0), 2.0));
    }
}
