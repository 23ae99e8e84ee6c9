//! One direction of a link, as data.

use serde::{Deserialize, Serialize};

use super::model::USUAL_IN_FLIGHT;

/// One direction of a link.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Direction {
    /// Cycles from the acceptance of a request to its response, at least 1.
    pub latency: u32,
    /// The most additional cycles, distributed by `shape`.
    #[serde(default)]
    pub tail: u32,
    /// The distribution of the tail.
    #[serde(default)]
    pub shape: Shape,
    /// Rare responses that are much later.
    #[serde(default)]
    pub stragglers: Stragglers,
    /// Spans of cycles in which no request is accepted.
    #[serde(default)]
    pub stalls: Stalls,
    /// Lines per cycle, above 0 and up to 1.
    #[serde(default = "one")]
    pub lines_per_cycle: f64,
    /// The most requests without a response, at least 1. A request whose response is lost no longer counts.
    #[serde(default = "usual_in_flight")]
    pub in_flight: u32,
}

/// The distribution of the cycles beyond the minimum latency.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Every number of cycles is equally likely.
    #[default]
    Even,
    /// The chance that a response arrives is the same in each further cycle, so short waits are the most likely. The
    /// value is the mean in cycles, before the distribution is cut off at the end of the tail.
    Geometric(f64),
}

/// Responses that come much later than the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stragglers {
    /// The share of responses, 0 to 1.
    pub share: f64,
    /// The additional cycles that they take.
    pub cycles: u32,
}

/// Spans of cycles in which `ready` is low, whether or not there is a request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stalls {
    /// The chance that a stall begins in a cycle outside a stall: at least 0, below 1.
    pub chance: f64,
    /// The longest stall in cycles. Lengths from 1 to this are equally likely.
    pub longest: u32,
}

/// The order of responses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// The order of the requests: a late response delays those behind it, as in a reorder buffer.
    InOrder,
    /// Any order: a random one of the responses that are due.
    Shuffled,
}

fn one() -> f64 {
    1.0
}

fn usual_in_flight() -> u32 {
    USUAL_IN_FLIGHT
}

impl Direction {
    /// A direction without stalls, stragglers or a bandwidth limit, with an even tail and [`USUAL_IN_FLIGHT`] in
    /// flight.
    pub fn steady(latency: u32, tail: u32) -> Self {
        Self {
            latency,
            tail,
            shape: Shape::Even,
            stragglers: Stragglers::default(),
            stalls: Stalls::default(),
            lines_per_cycle: one(),
            in_flight: USUAL_IN_FLIGHT,
        }
    }

    /// The first field outside its range, with its value and range.
    pub(super) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        let lines_per_cycle = self.lines_per_cycle > 0.0 && self.lines_per_cycle <= 1.0;
        let share = (0.0..=1.0).contains(&self.stragglers.share);
        let chance = (0.0..1.0).contains(&self.stalls.chance);
        let mean = match self.shape {
            Shape::Even => 0.0,
            Shape::Geometric(mean) => mean,
        };
        let checks = [
            (self.latency >= 1, "latency", f64::from(self.latency), "at least 1 cycle"),
            (lines_per_cycle, "lines_per_cycle of a direction", self.lines_per_cycle, "above 0 and at most 1"),
            (share, "the share of stragglers", self.stragglers.share, "from 0 to 1"),
            (chance, "the chance of stalls", self.stalls.chance, "at least 0 and below 1"),
            (mean >= 0.0 && mean.is_finite(), "the mean of a geometric tail", mean, "0 or more cycles"),
            (self.in_flight >= 1, "in_flight", f64::from(self.in_flight), "at least 1"),
        ];
        checks.into_iter().find(|(is_good, ..)| !is_good).map(|(_, field, value, range)| (field, value, range))
    }

    fn mean_latency(&self) -> f64 {
        let tail = match self.shape {
            Shape::Even => f64::from(self.tail) / 2.0,
            // The mean of a geometric distribution that is cut off at `tail`.
            Shape::Geometric(mean) => mean * (1.0 - self.shape.chance_of_another().powf(self.tail.into())),
        };
        f64::from(self.latency) + tail + self.stragglers.share * f64::from(self.stragglers.cycles)
    }

    /// The share of cycles in which requests are accepted: runs of (1 − c) / c cycles on average, between stalls of
    /// half the longest.
    fn ready_share(&self) -> f64 {
        let Stalls { chance, longest } = self.stalls;
        if longest == 0 {
            return 1.0;
        }
        (1.0 - chance) / (1.0 - chance + chance * (1.0 + f64::from(longest)) / 2.0)
    }

    /// Stalls refuse requests while the data of earlier ones still arrives, so the tighter of the two limits counts.
    pub(super) fn cycles_per_read(&self) -> f64 {
        self.in_flight_limit().max(1.0 / self.lines_per_cycle).max(1.0 / self.ready_share())
    }

    /// A write carries its data, so a stall also stops the data: the two factors multiply.
    pub(super) fn cycles_per_write(&self) -> f64 {
        self.in_flight_limit().max(1.0 / (self.lines_per_cycle * self.ready_share()))
    }

    /// The cycles per line that the latency allows, by Little's law.
    fn in_flight_limit(&self) -> f64 {
        self.mean_latency() / f64::from(self.in_flight)
    }
}

impl Shape {
    /// The chance that a response that has not come yet does not come in the next cycle either; 0 for any other
    /// distribution.
    pub(super) fn chance_of_another(self) -> f64 {
        match self {
            Self::Even => 0.0,
            Self::Geometric(mean) => mean / (mean + 1.0),
        }
    }
}
