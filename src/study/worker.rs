//! A process that works on a study.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::claim;
use super::pass::{Busy, CLAIM, Message, Pass};
use super::{Failed, Point, PointError, Shard, State};
use crate::store::{Key, Store, StoreError};

/// Which points a process measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Every point. Points that others work on are waited for.
    Whole,
    /// The points of a shard. Points that others work on are left to them.
    Part(Shard),
    /// None: it reads what is there.
    Reader,
}

/// How far a process is with its points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Points that are measured.
    pub done: usize,
    /// Points that failed in this run.
    pub failed: usize,
    /// Points that are left.
    pub left: usize,
    /// Estimate of the seconds that these take; `None` before the first was measured.
    pub seconds_left: Option<f64>,
}

/// A progress report of a process.
#[derive(Debug)]
pub enum News<'a> {
    /// It begins with a point, or with several at once.
    Begun(&'a str),
    /// A point was measured, or failed with an error.
    Ended(&'a Point, Option<&'a Failed>, Progress),
}

/// A process that works on a study, and the points that it met.
#[derive(Debug)]
pub struct Worker {
    role: Role,
    lease: Duration,
    jobs: usize,
    /// How many more points it may measure.
    limit: Option<usize>,
    ledger: Vec<(Point, State)>,
}

impl Worker {
    /// A process in this role.
    pub fn new(role: Role) -> Self {
        Self { role, lease: Duration::from_secs(60), jobs: 1, limit: None, ledger: Vec::new() }
    }

    /// The same with `jobs` points at a time.
    #[must_use]
    pub fn with_jobs(self, jobs: usize) -> Self {
        Self { jobs: jobs.max(1), ..self }
    }

    /// The same, taking up the point of a process that gave no sign of life for so long.
    #[must_use]
    pub fn with_lease(self, lease: Duration) -> Self {
        Self { lease, ..self }
    }

    /// The same, measuring at most so many points.
    #[must_use]
    pub fn with_limit(self, limit: Option<usize>) -> Self {
        Self { limit, ..self }
    }

    /// The points that it met so far, in the order of the study, and what became of each.
    pub fn ledger(&self) -> &[(Point, State)] {
        &self.ledger
    }

    /// The part of the ledger that is this process's own work.
    pub fn own(&self) -> impl Iterator<Item = &(Point, State)> {
        self.ledger.iter().filter(|(point, _)| self.is_own(point))
    }

    /// What became of the point with this key; `None` if it was not met.
    pub fn state(&self, key: &Key) -> Option<&State> {
        self.ledger.iter().find(|(point, _)| point.key == *key).map(|(_, state)| state)
    }

    /// True if nobody has measured, or failed to measure, a point that it met.
    pub fn is_missing_any(&self) -> bool {
        self.ledger.iter().any(|(_, state)| *state == State::Missing)
    }

    fn is_own(&self, point: &Point) -> bool {
        match self.role {
            Role::Whole => true,
            Role::Part(shard) => shard.holds(&point.part),
            Role::Reader => false,
        }
    }

    /// The measurements of `points`, each of which stands there once: those in the store, and those of its role, which
    /// `make` measures now, `batch` at a time. A point that fails is recorded in the store and does not stop the
    /// others. `None` stands for a point that failed or is missing; the ledger says which.
    ///
    /// # Errors
    /// Returns an error of `make` that is not a point's own, and an error if the store cannot be read or written.
    pub fn run<T, E>(
        &mut self,
        store: &Store,
        points: &[Point],
        batch: usize,
        make: impl Fn(&[usize]) -> Result<Vec<T>, E> + Sync,
        mut tell: impl FnMut(News<'_>),
    ) -> Result<Vec<Option<T>>, E>
    where
        T: Serialize + DeserializeOwned + Send,
        E: PointError + From<StoreError> + Send,
    {
        let mut found: Vec<Option<T>> = points.iter().map(|point| store.get(&point.key)).collect::<Result<_, _>>()?;
        let mut failed: Vec<Option<Failed>> = points.iter().map(|_| None).collect();
        let own: Vec<usize> = (0..points.len()).filter(|&index| self.is_own(&points[index])).collect();
        let mut open: VecDeque<usize> = own.iter().copied().filter(|&index| found[index].is_none()).collect();
        let (begun, mut measured) = (Instant::now(), 0_usize);
        while !open.is_empty() && self.limit != Some(0) {
            let mut busy = Vec::new();
            let pass = Pass { store, points, batch, lease: self.lease, jobs: self.jobs };
            self.limit = pass.run(open, self.limit, &make, |message| {
                let (index, is_made) = match message {
                    Message::Begun(what) => return tell(News::Begun(&what)),
                    Message::Busy(point) => return busy.push(point),
                    Message::Made(index, value) => {
                        found[index] = Some(value);
                        (index, true)
                    }
                    Message::Failed(index, failure) => {
                        failed[index] = Some(failure);
                        (index, false)
                    }
                };
                measured += 1;
                let done = own.iter().filter(|&&index| found[index].is_some()).count();
                let failures = failed.iter().flatten().count();
                let left = own.len() - done - failures;
                let seconds_left = Some(begun.elapsed().as_secs_f64() / measured as f64 * left as f64);
                let progress = Progress { done, failed: failures, left, seconds_left };
                tell(News::Ended(&points[index], failed[index].as_ref().filter(|_| !is_made), progress));
            })?;
            open =
                if self.limit == Some(0) { VecDeque::new() } else { self.taken_up(store, points, busy, &mut found)? };
        }
        self.ledger.retain(|(known, _)| points.iter().all(|point| point.key != known.key));
        for ((point, found), failed) in points.iter().zip(&found).zip(failed) {
            let state = match (found, failed) {
                (Some(_), _) => State::Made,
                (None, Some(failed)) => State::Failed(failed),
                (None, None) => Failed::of(store, &point.key)?.map_or(State::Missing, State::Failed),
            };
            self.ledger.push((point.clone(), state));
        }
        Ok(found)
    }

    /// Watches points that other processes have claimed. Returns those that this one must measure after all, since
    /// their processes died. A shard watches a point until its process gives a sign of life, then leaves it.
    fn taken_up<T: DeserializeOwned>(
        &self,
        store: &Store,
        points: &[Point],
        mut busy: Vec<Busy>,
        found: &mut [Option<T>],
    ) -> Result<VecDeque<usize>, StoreError> {
        let mut open = VecDeque::new();
        while !busy.is_empty() && open.is_empty() {
            thread::sleep(poll(self.lease));
            let mut still = Vec::new();
            for mut point in busy {
                let key = &points[point.index].key;
                found[point.index] = store.get(key)?;
                if found[point.index].is_some() {
                    continue;
                }
                let path = store.file(key, CLAIM);
                let now = claim::read(&path).map_err(|error| StoreError::io("read", &path, error))?;
                match now {
                    // Its process gave it up. If it failed there, that is its state.
                    None if Failed::of(store, key)?.is_some() => {}
                    None => open.push_back(point.index),
                    Some(now) if now != point.claim => {
                        if !matches!(self.role, Role::Part(_)) {
                            (point.claim, point.since) = (now, Instant::now());
                            still.push(point);
                        }
                    }
                    Some(_) if point.since.elapsed() < self.lease => still.push(point),
                    Some(_) => {
                        let removed = claim::remove_dead(&path, &point.claim);
                        removed.map_err(|error| StoreError::io("remove", &path, error))?;
                        open.push_back(point.index);
                    }
                }
            }
            busy = still;
            if !open.is_empty() {
                // Met again, and watched again, in the next pass.
                open.extend(busy.drain(..).map(|point| point.index));
            }
        }
        Ok(open)
    }

    /// Completes what [`Worker::run`] found: a shard waits for points of other processes, as long as any of them gives
    /// signs of life. What is missing then, nobody is working on.
    ///
    /// # Errors
    /// Returns an error if the store cannot be read.
    pub fn settle<T: DeserializeOwned>(
        &mut self,
        store: &Store,
        points: &[Point],
        found: &mut [Option<T>],
    ) -> Result<(), StoreError> {
        let can_wait = matches!(self.role, Role::Part(_)) && self.limit != Some(0);
        let (mut last, mut since) = (None, Instant::now());
        loop {
            let mut missing = 0;
            for (point, found) in points.iter().zip(&mut *found) {
                let state = self.ledger.iter_mut().find(|(known, _)| known.key == point.key).map(|(_, state)| state);
                let Some(state) = state.filter(|state| **state == State::Missing) else { continue };
                *found = store.get(&point.key)?;
                *state = match (&found, Failed::of(store, &point.key)?) {
                    (Some(_), _) => State::Made,
                    (None, Some(failed)) => State::Failed(failed),
                    (None, None) => State::Missing,
                };
                missing += usize::from(*state == State::Missing);
            }
            let now = Some((missing, signs_of_life(store)?));
            if missing == 0 || !can_wait || now == last && since.elapsed() >= self.lease {
                return Ok(());
            }
            if now != last {
                (last, since) = (now, Instant::now());
            }
            thread::sleep(poll(self.lease));
        }
    }
}

/// How often other processes are looked at.
fn poll(lease: Duration) -> Duration {
    (lease / 8).clamp(Duration::from_millis(20), Duration::from_secs(5))
}

/// All claims, and what each says.
fn signs_of_life(store: &Store) -> Result<Vec<(PathBuf, Option<String>)>, StoreError> {
    let read = |path: PathBuf| {
        let text = claim::read(&path).map_err(|error| StoreError::io("read", &path, error))?;
        Ok((path, text))
    };
    store.files(CLAIM)?.into_iter().map(read).collect()
}
