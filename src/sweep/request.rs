//! What a sweep measures, as data: all that is needed to make its results of a store.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::row::Simulated;
use super::{Job, Size, SweepError, SweepResults, Task, area, simulate};
use crate::config::Config;
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
    size: Size,
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
        let given = task.job.fingerprint();
        let (kind, kind_of_area) = match task.job {
            Job::Pairs(_) => ("sweep/2", "area/1"),
            Job::Spheres(_) => ("sweep-spheres/1", "area-spheres/1"),
        };
        let asked = |config: &Config| {
            let simulation = (version, config, rtl_sha256(config)?, &given, task.link, task.seed);
            let counted = match task.job {
                // The same SCPU stands in an AFU of any size.
                Job::Pairs(_) => Config { scpus: 1, ..config.clone() },
                Job::Spheres(_) => config.clone(),
            };
            let area =
                task.counts.then(|| Ok::<_, SweepError>((version, &counted, rtl_sha256(&counted)?))).transpose()?;
            Ok::<_, SweepError>(Asked {
                size: Size::of(config),
                simulation: Key::new(kind, &simulation)?,
                area: area.map(|of| Key::new(kind_of_area, &of)).transpose()?,
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
        // The request is made of the same configurations.
        let config =
            |row: &Asked| configs.iter().find(|config| Size::of(config) == row.size).cloned().unwrap_or_default();
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
            |at| at.iter().map(|&index| area(&config(&self.rows[of[index]]), task)).collect(),
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
        let point = |row: &Asked| Point::new(row.size.title(), row.simulation.clone());
        self.rows.iter().map(point).collect()
    }

    /// A point for each SCPU, or AFU, whose area is counted, and a row that it stands in.
    fn areas(&self) -> (Vec<Point>, Vec<usize>) {
        let (mut points, mut of): (Vec<Point>, Vec<usize>) = (Vec::new(), Vec::new());
        for (index, row) in self.rows.iter().enumerate() {
            if let Some(key) = row.area.clone().filter(|key| points.iter().all(|point| point.key != *key)) {
                let of_what = match (row.size.lanes, row.size.interval) {
                    (None, Some(interval)) => format!("an SCPU, interval {interval}"),
                    _ => row.size.title(),
                };
                points.push(Point::new(format!("area of {of_what}"), key));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Input, Results, Shell};
    use crate::link::LinkModel;
    use crate::query::Fields;
    use crate::spheres::SphereSet;
    use crate::sweep::row::HostSeconds;
    use crate::sweep::{Row, SpheresRow, Swept};

    #[test]
    fn rows_of_spheres_are_those_that_a_store_has() {
        let sets = SphereSet::Diamond(3).spheres(1);
        let base = Config { input: Input::Spheres, results: Results::Hits, shell: Shell::Line, ..Config::default() };
        let base = Config { contact: Fields::HIT, ..base };
        let swept = Swept { lanes: vec![16], deciders: vec![4], box_bits: vec![24, 10], ..Swept::default() };
        let configs = swept.configs(&base);
        let request = |seed: u64| {
            let task = Task { job: Job::Spheres(&sets), link: &LinkModel::ideal(), seed, counts: true };
            let results = SweepResults::new("diamond:3", "ideal", &task, &base, swept.clone());
            Request::new(results, &configs, &task).expect("both can be generated")
        };
        let (asked, other) = (request(1), request(2));
        let store = Store::temporary().expect("a temporary store");
        assert_eq!(asked.known(&store), 0);
        let row = SpheresRow::example(16, 10, 90);
        let host = HostSeconds::new(row.size(), 1.0, 0.5);
        let simulated = Simulated { row: Row::Spheres(row.clone()), host };
        store.put(&asked.rows[1].simulation, &simulated).expect("kept");
        assert_eq!([asked.known(&store), other.known(&store)], [1, 0]);
        let read = || asked.read(&store, &mut Worker::new(Role::Reader)).expect("a store");
        assert_eq!(read().rows, [Row::Spheres(row.clone())]);
        assert_eq!(read().missing[0], "16 lanes, 4 deciders, boxes of 24 bits");
        // The area is of the AFU, whatever is sent to it.
        let key = other.rows[1].area.clone().expect("it is counted");
        store.put(&key, &Area { luts: 7, ffs: 5, dsps: 3, brams: 1 }).expect("kept");
        let counted = SpheresRow { luts: Some(7), ffs: Some(5), dsps: Some(3), brams: Some(1), ..row };
        assert_eq!(read().rows, [Row::Spheres(counted)]);
        let text = serde_json::to_string(&asked).expect("plain values");
        assert_eq!(serde_json::from_str::<Request>(&text).expect("the same"), asked);
    }
}
