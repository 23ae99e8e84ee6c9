//! The model of a link as data, and the link limit.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::direction::{Direction, Order, Stalls, Stragglers};
use super::fault::Fault;
use super::memory::LINE_BYTES;

/// The reads, and the writes, that a link takes in flight if its description does not say how many.
pub const USUAL_IN_FLIGHT: u32 = 64;

/// A link at a clock, in cycles and lines: two directions, an order, a bandwidth that both share, and the cost of a
/// session. [`Physical`](super::Physical) describes a link in nanoseconds and bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkModel {
    /// The name in reports.
    pub name: String,
    /// From a read request to its data.
    pub read: Direction,
    /// From a write request to its acknowledgement.
    pub write: Direction,
    /// The order of the responses to reads, and to writes unless `write_order` differs.
    pub order: Order,
    /// The order of the acknowledgements of writes, if it differs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub write_order: Option<Order>,
    /// Lines per cycle in both directions together, above 0 and up to 2.
    #[serde(default = "both")]
    pub lines_per_cycle: f64,
    /// The host's waiting times before and after a job.
    #[serde(default)]
    pub session: SessionCost,
    /// Faults planted from the start.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Fault>,
}

/// The costs of the host's side of a link, in cycles of the AFU's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SessionCost {
    /// Before each transaction.
    #[serde(default)]
    pub set_up: u64,
    /// After each transaction.
    #[serde(default)]
    pub tear_down: u64,
    /// From the host's write of a control register to its arrival at the AFU.
    #[serde(default)]
    pub csr_write: u64,
}

fn both() -> f64 {
    2.0
}

/// An error in the name or description of a link.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinkError {
    /// There is no preset of this name.
    #[error("unknown link `{0}`: use {names}", names = super::NAMES.join(", "))]
    Unknown(String),
    /// The file does not describe a link.
    #[error("{file}: {message}")]
    File {
        /// The file.
        file: String,
        /// The line, and what is wrong with it.
        message: String,
    },
    /// A value is outside its range.
    #[error("link `{link}`: {field} is {value}, but must be {range}")]
    Range {
        /// The link.
        link: String,
        /// The field.
        field: &'static str,
        /// The value found.
        value: f64,
        /// The allowed values.
        range: &'static str,
    },
}

impl LinkModel {
    /// The names that [`FromStr`] accepts. [`Description`](super::Description) accepts more, which need a clock.
    pub const PRESETS: [&'static str; 4] = ["ideal", "late", "shuffled", "hostile"];

    /// One line per cycle each way, answered in the next cycle. Only the AFU limits the throughput.
    pub fn ideal() -> Self {
        Self::new("ideal", Direction::steady(1, 0), Order::InOrder)
    }

    /// Reads take 71 to 118 cycles, the latency and tail of HARP v1 at 200 MHz recalled from Choi et al., DAC 2016.
    /// They return in order and without a bandwidth limit. Writes take the same.
    pub fn late() -> Self {
        Self::new("late", Direction::steady(71, 47), Order::InOrder)
    }

    /// Responses in any order within some 40 cycles.
    pub fn shuffled() -> Self {
        Self::new("shuffled", Direction::steady(20, 40), Order::Shuffled)
    }

    /// Everything that a link may do to an AFU short of a fault: any order, stragglers, stalls, low bandwidth.
    pub fn hostile() -> Self {
        let stalls = Stalls { chance: 0.04, longest: 30 };
        let stragglers = Stragglers { share: 0.005, cycles: 600 };
        let read = Direction { stalls, stragglers, lines_per_cycle: 0.8, ..Direction::steady(1, 60) };
        let write = Direction { lines_per_cycle: 0.9, ..read };
        Self { write, lines_per_cycle: 0.9, ..Self::new("hostile", read, Order::Shuffled) }
    }

    fn new(name: &str, both_ways: Direction, order: Order) -> Self {
        Self {
            name: name.to_owned(),
            read: both_ways,
            write: both_ways,
            order,
            write_order: None,
            lines_per_cycle: both(),
            session: SessionCost::default(),
            faults: Vec::new(),
        }
    }

    /// Checks that every value is in its range.
    ///
    /// # Errors
    /// Returns [`LinkError::Range`] with the first value that is outside its range.
    pub fn check(&self) -> Result<(), LinkError> {
        let fail = |field, value, range| Err(LinkError::Range { link: self.name.clone(), field, value, range });
        for direction in [&self.read, &self.write] {
            if let Some((field, value, range)) = direction.fault() {
                return fail(field, value, range);
            }
        }
        if !(self.lines_per_cycle > 0.0 && self.lines_per_cycle <= 2.0) {
            return fail("lines_per_cycle", self.lines_per_cycle, "above 0 and at most 2");
        }
        Ok(())
    }

    /// The link behind an AXI4 slave with a bus of this many bits, for a master with one ID: in order, and no faster
    /// than the bus.
    #[must_use]
    pub fn on_bus(self, bits: u32) -> Self {
        let most = f64::from(bits) / (8 * LINE_BYTES) as f64;
        let mut model = Self { order: Order::InOrder, write_order: None, ..self };
        for direction in [&mut model.read, &mut model.write] {
            direction.lines_per_cycle = direction.lines_per_cycle.min(most);
        }
        model
    }

    /// The minimum number of cycles, on average over the link's randomness, to read and write this many lines. The
    /// limits are its bandwidths, its stalls and, by Little's law, its latency with its requests in flight. An AFU with
    /// fewer requests in flight than the link accepts reaches less.
    pub fn limit_cycles(&self, lines_read: u64, lines_written: u64) -> f64 {
        let (read, written) = (lines_read as f64, lines_written as f64);
        let alone = (read * self.read.cycles_per_read()).max(written * self.write.cycles_per_write());
        alone.max((read + written) / self.lines_per_cycle)
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
        assert_eq!(
            error,
            "unknown link `idea`: use ideal, late, shuffled, hostile, harp1, harp2, pcie3x8, zynqmp, ddr4"
        );
    }

    #[test]
    fn limits_are_those_of_the_tightest_bound() {
        assert_eq!(LinkModel::ideal().limit_cycles(1000, 1000), 1000.0);
        assert_eq!(LinkModel::ideal().limit_cycles(10, 1000), 1000.0);
        let late = LinkModel::late().limit_cycles(1000, 0); // 94.5 cycles with 64 in flight
        assert!((late - 1000.0 * 94.5 / 64.0).abs() < 1e-9, "{late}");
        let hostile = LinkModel::hostile().limit_cycles(900, 900); // 1800 lines at 0.9 per cycle
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
