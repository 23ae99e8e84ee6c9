//! What a sweep measures, as data: all that is needed to make its results of a store.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::row::Simulated;
use super::{SweepError, SweepResults, Task, area, fingerprint, simulate};
use crate::config::Config;
use crate::report::table::counted;
use crate::store::{Key, Store};
use crate::study::{News, Point, Role, State, Worker};
use crate::synth::Area;
use crate::verify::rtl_sha256;

/// A sweep that was asked for: its results without rows, and the keys of its measurements.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    results: SweepResults,
    rows: Vec<Asked>,
}

/// A row that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Asked {
    scpus: u32,
    interval: u32,
    simulation: Key,
    /// `None` if areas are not counted.
    area: Option<Key>,
}

impl Request {
    /// The sweep of `results`, with a row for each of `configs`.
    ///
    /// # Errors
    /// Returns an error if a configuration cannot be generated.
    pub fn new(results: SweepResults, configs: &[Config], task: &Task) -> Result<Self, SweepError> {
        let version = env!("CARGO_PKG_VERSION");
        let pairs = fingerprint(task.pairs);
        let asked = |config: &Config| {
            let simulation = (version, config, rtl_sha256(config)?, &pairs, task.link, task.seed);
            // The same SCPU stands in an AFU of any size.
            let single = Config { scpus: 1, ..config.clone() };
            let area =
                task.counts.then(|| Ok::<_, SweepError>((version, &single, rtl_sha256(&single)?))).transpose()?;
            Ok::<_, SweepError>(Asked {
                scpus: config.scpus,
                interval: config.interval,
                simulation: Key::new("sweep/2", &simulation)?,
                area: area.map(|of| Key::new("area/1", &of)).transpose()?,
            })
        };
        Ok(Self { results, rows: configs.iter().map(asked).collect::<Result<_, _>>()? })
    }

    /// The points whose measurement is already in a store.
    pub fn known(&self, store: &Store) -> usize {
        self.rows.iter().filter(|row| store.has(&row.simulation)).count()
    }

    /// Measures `configs`, those of the request, as far as they are the worker's. Returns the results of what is then
    /// there; a folder, if there is one, gets them after each point.
    ///
    /// # Errors
    /// Returns an error that other points would meet as well, such as a missing tool, and an error if the store or the
    /// folder cannot be read or written.
    pub fn run(
        &self,
        configs: &[Config],
        task: &Task,
        store: &Store,
        worker: &mut Worker,
        folder: Option<&Path>,
        mut tell: impl FnMut(News<'_>),
    ) -> Result<SweepResults, SweepError> {
        let config = |row: &Asked| {
            let of = |config: &&Config| (config.scpus, config.interval) == (row.scpus, row.interval);
            // The request is made of the same configurations.
            configs.iter().find(of).cloned().unwrap_or_default()
        };
        // From the first measurement on the folder is known as ours.
        let mut saved = match folder {
            Some(folder) => self.read(store, &mut Worker::new(Role::Reader))?.save(folder).map_err(SweepError::from),
            None => Ok(()),
        };
        let mut heard = |news: News<'_>| {
            let has_ended = matches!(news, News::Ended(..));
            tell(news);
            if let Some(folder) = folder.filter(|_| has_ended && saved.is_ok()) {
                saved = self.read(store, &mut Worker::new(Role::Reader)).and_then(|so_far| Ok(so_far.save(folder)?));
            }
        };
        let simulated = worker.run(
            store,
            &self.simulations(),
            1,
            |at| at.iter().map(|&index| simulate(&config(&self.rows[index]), task)).collect(),
            &mut heard,
        )?;
        let (points, of) = self.areas();
        let areas = worker.run(
            store,
            &points,
            1,
            |at| at.iter().map(|&index| area(&config(&self.rows[of[index]]))).collect(),
            &mut heard,
        )?;
        saved?;
        let results = self.results(&simulated, &points, &areas, worker);
        folder.map_or(Ok(()), |folder| results.save(folder))?;
        Ok(results)
    }

    /// The results of what is in a store.
    ///
    /// # Errors
    /// Returns an error if the store cannot be read.
    pub fn read(&self, store: &Store, reader: &mut Worker) -> Result<SweepResults, SweepError> {
        let simulated = reader.run(store, &self.simulations(), 1, |_| Ok::<_, SweepError>(Vec::new()), |_| ())?;
        let (points, _) = self.areas();
        let areas = reader.run(store, &points, 1, |_| Ok::<_, SweepError>(Vec::new()), |_| ())?;
        Ok(self.results(&simulated, &points, &areas, reader))
    }

    /// A point per row.
    fn simulations(&self) -> Vec<Point> {
        let point = |row: &Asked| {
            Point::new(
                format!("{}, interval {}", counted(row.scpus.into(), "SCPU"), row.interval),
                row.simulation.clone(),
            )
        };
        self.rows.iter().map(point).collect()
    }

    /// A point for each SCPU whose area is counted, and a row that it stands in.
    fn areas(&self) -> (Vec<Point>, Vec<usize>) {
        let (mut points, mut of): (Vec<Point>, Vec<usize>) = (Vec::new(), Vec::new());
        for (index, row) in self.rows.iter().enumerate() {
            if let Some(key) = row.area.clone().filter(|key| points.iter().all(|point| point.key != *key)) {
                points.push(Point::new(format!("area of an SCPU, interval {}", row.interval), key));
                of.push(index);
            }
        }
        (points, of)
    }

    fn results(
        &self,
        simulated: &[Option<Simulated>],
        points: &[Point],
        areas: &[Option<Area>],
        worker: &Worker,
    ) -> SweepResults {
        let area = |row: &Asked| {
            let index = points.iter().position(|point| Some(&point.key) == row.area.as_ref())?;
            areas[index]
        };
        let rows = self.rows.iter().zip(simulated).filter_map(|(asked, simulated)| Some((asked, simulated.as_ref()?)));
        let gaps = worker.ledger().iter().filter(|(_, state)| *state != State::Made);
        SweepResults {
            rows: rows.clone().map(|(asked, simulated)| simulated.row.clone().with_area(area(asked))).collect(),
            missing: gaps.map(|(point, _)| point.title.clone()).collect(),
            host: rows.map(|(_, simulated)| simulated.host).collect(),
            ..self.results.clone()
        }
    }
}
