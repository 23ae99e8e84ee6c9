//! A configuration with all its measurements.

use super::cost::{Cycles, Hardware};
use super::scene::Drift;
use crate::accuracy::{ErrorStatistics, Row, Tally};
use crate::config::Config;
use crate::synth::{Area, Target};
use serde::{Deserialize, Serialize};

/// A configuration, its errors, its time and its area.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// The name, unique in a study.
    pub name: String,
    /// The axis along which it was chosen.
    pub axis: String,
    /// The configuration, with one SCPU and without a shell.
    pub config: Config,
    /// The clock of its stages by the delay model, MHz. It is not above the requested one.
    pub modelled_mhz: f64,
    /// Stages of the SCPU, as the generator counts them.
    pub scpu_cycles: u32,
    /// SHA-256 of its Verilog.
    pub rtl_sha256: String,
    /// One row per set of pairs.
    pub rows: Vec<Row>,
    /// Cycles by co-simulation.
    pub cycles: Cycles,
    /// Area and clock, if the tools are installed.
    pub hardware: Option<Hardware>,
    /// Both times at the delay model's clock, before place and route; `None` if the point was not routed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before_routing: Option<Counted>,
    /// Nanoseconds per pair of the same arithmetic in software, on one thread of this machine.
    pub software_ns: Option<f64>,
    /// The drift of the diamond's spheres; `None` without ODE, or if it gives a record that is not a contact.
    pub drift: Option<Drift>,
}

/// A configuration's cycles at the delay model's clock, and its cells as synthesis counts them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counted {
    /// Cycles by co-simulation.
    pub cycles: Cycles,
    /// Area, without a clock.
    pub hardware: Hardware,
}

impl Point {
    /// The clock of its times, MHz: after place and route, otherwise by the delay model.
    pub fn clock_mhz(&self) -> f64 {
        self.routed_mhz().unwrap_or(self.modelled_mhz)
    }

    /// The clock after place and route, MHz.
    pub fn routed_mhz(&self) -> Option<f64> {
        self.hardware.as_ref().and_then(|hardware| hardware.routed_mhz)
    }

    /// The same point before place and route: its times are at the delay model's clock, and its cells as synthesis
    /// counted them.
    #[must_use]
    pub fn unrouted(&self) -> Self {
        let (cycles, hardware) = match &self.before_routing {
            Some(before) => (before.cycles.clone(), Some(before.hardware.clone())),
            None => (self.cycles.clone(), self.hardware.clone()),
        };
        let hardware = hardware.map(|hardware| Hardware { routed_mhz: None, ..hardware });
        Self { cycles, hardware, before_routing: None, ..self.clone() }
    }

    fn ns(&self, cycles: f64) -> f64 {
        1000.0 * cycles / self.clock_mhz()
    }

    /// The latency of a single pair, from its line in to its contact's line out, ns.
    pub fn lone_ns(&self) -> f64 {
        self.ns(self.cycles.lone as f64)
    }

    /// The time per pair of one SCPU, ns.
    pub(crate) fn compute_ns(&self) -> f64 {
        self.ns(self.cycles.compute)
    }

    /// The time per pair over the link, ns.
    pub(crate) fn link_ns(&self) -> f64 {
        self.ns(self.cycles.link)
    }

    /// The number of SCPUs that fit in a device of the target.
    pub(crate) fn on_device(&self, target: Target) -> Option<u64> {
        Some(target.capacity()?.fits(&self.area()?))
    }

    /// The time per pair of a device full of SCPUs, ns; `None` if not even one fits.
    pub(crate) fn device_ns(&self, target: Target) -> Option<f64> {
        self.on_device(target).filter(|&scpus| scpus > 0).map(|scpus| self.compute_ns() / scpus as f64)
    }

    /// The area of the SCPU.
    pub fn area(&self) -> Option<Area> {
        self.hardware.as_ref().map(|hardware| hardware.area)
    }

    /// The tally over all pairs.
    pub fn tally(&self) -> Tally {
        self.rows.iter().fold(Tally::default(), |sum, row| sum.plus(&row.tally))
    }

    /// Wrong decisions on all pairs.
    pub fn wrong(&self) -> u64 {
        let tally = self.tally();
        tally.missed.saturating_add(tally.false_hits)
    }

    /// The errors on the sets of these names.
    pub fn errors(&self, sets: &[String]) -> ErrorStatistics {
        let rows = self.rows.iter().filter(|row| sets.contains(&row.category));
        rows.fold(ErrorStatistics::default(), |sum, row| sum.plus(&row.errors))
    }
}
