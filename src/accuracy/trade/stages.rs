//! The stages of a study: errors, areas and routes, cycles, drifts. Each has points.

use super::axes::name;
use super::cost::{Cycles, Hardware, cycles, cycles_hash, hardware, hardware_hash};
use super::{Plan, TradeError};
use crate::accuracy::measure::{Judged, judge_all, unjudged};
use crate::accuracy::study::StudyError;
use crate::accuracy::{Contender, Profiled, Row};
use crate::config::Config;
use crate::query::Query;
use crate::store::{Key, Store, StoreError};
use crate::study::{News, Point, State, Worker};
use crate::synth::Unit;
use crate::verify::{Bench, rtl_sha256};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::thread;

/// The number of arithmetics that are judged at once. The truth about a set is computed again for each such group.
const AT_ONCE: usize = 16;

/// A plan, and the worker that carries it out.
pub(super) struct Stages<'a, F> {
    pub plan: &'a Plan,
    pub store: &'a Store,
    pub worker: &'a mut Worker,
    pub tell: F,
}

/// Points with what was found of each.
pub(super) struct Found<T> {
    points: Vec<Point>,
    pub values: Vec<Option<T>>,
}

/// The errors of configurations: for each set, the names of the arithmetics and what was found of them.
pub(super) struct Errors {
    sets: Vec<(Vec<Row>, Found<Judged>)>,
}

/// The measured figures of a configuration's hardware.
pub(super) struct Cost {
    pub rtl_sha256: String,
    pub scpu_cycles: u32,
    pub modelled_mhz: f64,
    pub cycles: Option<Cycles>,
    pub hardware: Option<Hardware>,
    /// What could not be measured, with the reason.
    pub missing: Vec<String>,
}

impl<F: FnMut(News<'_>)> Stages<'_, F> {
    /// The errors of each arithmetic on each set. An arithmetic answers once: the clock changes no bit.
    pub fn errors(&mut self, configs: &[&Config]) -> Result<Errors, TradeError> {
        let mut arithmetics: Vec<Profiled> = Vec::new();
        for contender in configs.iter().map(|config| Profiled::of(config)) {
            if arithmetics.iter().all(|known| known.name() != contender.name()) {
                arithmetics.push(contender);
            }
        }
        let mut sets = Vec::new();
        for set in &self.plan.sets {
            let (mut rows, mut points) = (Vec::new(), Vec::new());
            for arithmetic in &arithmetics {
                let name = arithmetic.name();
                let (row, key) = unjudged(Query::SphereSphere, &set.name, &name, &set.pairs)?;
                points.push(Point::new(format!("errors of {name} on {}", set.name), key).beside(&name));
                rows.push(row);
            }
            let judge = |at: &[usize]| {
                let mut some: Vec<Box<dyn Contender>> =
                    at.iter().map(|&index| Box::new(arithmetics[index].clone()) as _).collect();
                let judged =
                    judge_all(Query::SphereSphere, &set.pairs, &mut some.iter_mut().collect::<Vec<_>>(), |_| ());
                judged.map_err(|error| StudyError::from(error).into())
            };
            let found = self.measure(points, AT_ONCE, judge)?;
            sets.push((rows, found));
        }
        Ok(Errors { sets })
    }

    /// The rows of each configuration: one per set; `None` where one is missing.
    pub fn rows(&mut self, configs: &[&Config], errors: &mut Errors) -> Result<Vec<Option<Vec<Row>>>, TradeError> {
        for (_, found) in &mut errors.sets {
            self.settle(found)?;
        }
        let row = |config: &Config, (rows, found): &(Vec<Row>, Found<Judged>)| {
            let name = Profiled::of(config).name();
            let index = rows.iter().position(|row| row.contender == name)?;
            Some(rows[index].clone().with(found.values[index]?))
        };
        Ok(configs.iter().map(|config| errors.sets.iter().map(|set| row(config, set)).collect()).collect())
    }

    /// The cost of each configuration: area, the clock after place and route with `seeds` for the placer, cycles.
    pub fn costs(&mut self, configs: &[&Config], seeds: &[u32]) -> Result<Vec<Cost>, TradeError> {
        let plan = self.plan;
        let mut costs = facts(configs)?;
        let version = env!("CARGO_PKG_VERSION");

        let what = if seeds.is_empty() { "area and clock" } else { "place and route" };
        let mut points = Vec::new();
        for (config, cost) in configs.iter().zip(&costs).filter(|_| plan.synthesis) {
            let key = Key::new("hardware/1", &(version, hardware_hash(&cost.rtl_sha256, plan, seeds)))?;
            points.push(Point::new(format!("{what} of {}", name(config)), key).beside(&cost.rtl_sha256));
        }
        let synthesise = |at: &[usize]| {
            let one = |&index: &usize| {
                let key = hardware_hash(&costs[index].rtl_sha256, plan, seeds);
                Ok(hardware(configs[index], plan, seeds, key, |_| ())?)
            };
            at.iter().map(one).collect()
        };
        let mut areas = self.measure(points, 1, synthesise)?;

        let pairs = plan.sets.first().map_or(&[][..], |set| &set.pairs);
        let mut is_asked = vec![false; configs.len()];
        // A clock that another process finds is known once it has found it.
        for round in 0..2 {
            if round == 1 {
                self.settle(&mut areas)?;
            }
            let (mut points, mut of) = (Vec::new(), Vec::new());
            for (index, (config, cost)) in configs.iter().zip(&costs).enumerate() {
                let clock = self.clock(&areas, index, cost.modelled_mhz, seeds);
                let Some(clock) = clock.filter(|_| !is_asked[index]) else { continue };
                let link = plan.link.at(clock)?;
                let hash = cycles_hash(&cost.rtl_sha256, pairs, &link, plan.seed);
                let key = Key::new("cycles/1", &(version, &hash))?;
                points.push(Point::new(format!("cycles of {}", name(config)), key).beside(&cost.rtl_sha256));
                of.push((index, link, hash));
                is_asked[index] = true;
            }
            let simulate = |at: &[usize]| {
                let one = |&at: &usize| {
                    let (index, link, hash) = &of[at];
                    Ok(cycles(&Bench::new(configs[*index])?, pairs, link, plan.seed, hash.clone())?)
                };
                at.iter().map(one).collect()
            };
            let mut found = self.measure(points, 1, simulate)?;
            self.settle(&mut found)?;
            for ((index, ..), (point, cycles)) in of.iter().zip(found.points.iter().zip(found.values)) {
                costs[*index].missing.extend(self.failure(point));
                costs[*index].cycles = cycles;
            }
        }
        for ((cost, point), hardware) in costs.iter_mut().zip(&areas.points).zip(areas.values) {
            cost.missing.extend(self.failure(point));
            cost.hardware = hardware;
        }
        Ok(costs)
    }

    /// The clock that a configuration's cycles are counted at; `None` if another process is to find it.
    fn clock(&self, areas: &Found<Hardware>, index: usize, modelled_mhz: f64, seeds: &[u32]) -> Option<f64> {
        let Some(point) = areas.points.get(index).filter(|_| !seeds.is_empty()) else { return Some(modelled_mhz) };
        match (&areas.values[index], self.worker.state(&point.key)) {
            (Some(hardware), _) => Some(hardware.routed_mhz.unwrap_or(modelled_mhz)),
            (None, Some(State::Failed(_))) => Some(modelled_mhz),
            (None, _) => None,
        }
    }

    /// Measures points, as far as they are the worker's.
    pub fn measure<T: Serialize + DeserializeOwned + Send>(
        &mut self,
        points: Vec<Point>,
        batch: usize,
        make: impl Fn(&[usize]) -> Result<Vec<T>, TradeError> + Sync,
    ) -> Result<Found<T>, TradeError> {
        let values = self.worker.run(self.store, &points, batch, make, &mut self.tell)?;
        Ok(Found { points, values })
    }

    /// Waits for the points of other processes, while these work.
    fn settle<T: DeserializeOwned>(&mut self, found: &mut Found<T>) -> Result<(), StoreError> {
        self.worker.settle(self.store, &found.points, &mut found.values)
    }

    /// Why a point failed, if it did.
    fn failure(&self, point: &Point) -> Option<String> {
        match self.worker.state(&point.key) {
            Some(State::Failed(failed)) => {
                Some(format!("{}: {}", point.title, failed.error.lines().next().unwrap_or_default()))
            }
            _ => None,
        }
    }
}

/// What the generator knows about each configuration, computed on all processors.
fn facts(configs: &[&Config]) -> Result<Vec<Cost>, TradeError> {
    let fact = |config: &Config| {
        let unit = Unit::scpu(config)?;
        Ok::<_, TradeError>(Cost {
            rtl_sha256: rtl_sha256(config)?,
            scpu_cycles: unit.latency.unwrap_or_default(),
            modelled_mhz: unit.modelled_mhz().unwrap_or(config.clock_mhz).min(config.clock_mhz),
            cycles: None,
            hardware: None,
            missing: Vec::new(),
        })
    };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let share = configs.len().div_ceil(workers).max(1);
    thread::scope(|scope| {
        let parts: Vec<_> = configs
            .chunks(share)
            .map(|part| scope.spawn(move || part.iter().map(|config| fact(config)).collect::<Result<Vec<_>, _>>()))
            .collect();
        let mut all = Vec::new();
        for part in parts {
            all.extend(part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?);
        }
        Ok(all)
    })
}
