//! Units that were asked for, as data: all that is needed to find their figures in a store.

use serde::{Deserialize, Serialize};

use super::run::sha256_of;
use super::{Figures, Options, SynthError, Unit, synthesise};
use crate::store::{Key, Store};
use crate::study::{News, Point, PointError, Worker};
use crate::tools::Program;

/// Units that were asked for, and the keys of their figures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    units: Vec<Asked>,
}

/// A unit that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Asked {
    title: String,
    figures: Key,
}

impl PointError for SynthError {
    fn is_of_point(&self) -> bool {
        self.is_of_unit()
    }
}

impl Request {
    /// The figures of `units`, each measured with the same options.
    ///
    /// # Errors
    /// Returns an error if a program is missing, or if a unit cannot be put into its wrapper.
    pub fn new(units: &[Unit], options: &Options) -> Result<Self, SynthError> {
        let Options { target, seeds, placer } = options;
        let router = target.router().filter(|_| !seeds.is_empty());
        let nextpnr = router.map(|(architecture, _)| Program::nextpnr(architecture)).transpose()?;
        let versions = (Program::yosys()?.version().to_owned(), nextpnr.map(|program| program.version().to_owned()));
        let asked = |unit: &Unit| {
            let verilog = sha256_of(&Unit::files(&unit.wrapped()?, *target));
            let named = (&unit.name, &unit.profile, unit.architecture, unit.interval, unit.clock_mhz, unit.latency);
            let of = (env!("CARGO_PKG_VERSION"), named, &unit.module.name, target, (seeds, placer), verilog, &versions);
            let by = unit.architecture.map_or_else(String::new, |architecture| format!(" by {}", architecture.name()));
            Ok(Asked {
                title: format!("{}{by}, {target} at {} MHz", unit.title(), unit.clock_mhz),
                figures: Key::new("figures/1", &of)?,
            })
        };
        Ok(Self { units: units.iter().map(asked).collect::<Result<_, SynthError>>()? })
    }

    /// Measures `units`, those of the request, as far as they are the worker's. Returns the figures that are then
    /// there. `step` is called with what is being done, from any thread.
    ///
    /// # Errors
    /// Returns an error that other units would meet as well, such as a missing program, and an error if the store
    /// cannot be read or written.
    pub fn run(
        &self,
        units: &[Unit],
        options: &Options,
        store: &Store,
        worker: &mut Worker,
        step: impl Fn(&str) + Sync,
        tell: impl FnMut(News<'_>),
    ) -> Result<Vec<Figures>, SynthError> {
        let make = |at: &[usize]| at.iter().map(|&index| synthesise(&units[index], options, &step)).collect();
        Ok(worker.run(store, &self.points(), 1, make, tell)?.into_iter().flatten().collect())
    }

    /// The figures that are in a store.
    ///
    /// # Errors
    /// Returns an error if the store cannot be read.
    pub fn read(&self, store: &Store, reader: &mut Worker) -> Result<Vec<Figures>, SynthError> {
        let found = reader.run(store, &self.points(), 1, |_| Ok::<_, SynthError>(Vec::new()), |_| ())?;
        Ok(found.into_iter().flatten().collect())
    }

    fn points(&self) -> Vec<Point> {
        self.units.iter().map(|unit| Point::new(unit.title.clone(), unit.figures.clone())).collect()
    }
}
