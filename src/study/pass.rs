//! Threads that measure points, each of which they claim first.

use std::collections::VecDeque;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::mpsc::{self, Sender};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::claim::{self, Claim};
use super::{Failed, Point, PointError};
use crate::store::{Spent, Store, StoreError};

/// The extension of a claim's file.
pub(super) const CLAIM: &str = "claim";

/// Points, and how they are measured.
pub(super) struct Pass<'a> {
    pub store: &'a Store,
    pub points: &'a [Point],
    /// How many a thread measures at once.
    pub batch: usize,
    pub jobs: usize,
    pub lease: Duration,
}

/// A point that another process has claimed.
pub(super) struct Busy {
    pub index: usize,
    /// What the claim said when it last changed, and when that was noticed.
    pub claim: String,
    pub since: Instant,
}

/// From the threads that measure to the one that called.
pub(super) enum Message<T> {
    Begun(String),
    Made(usize, T),
    Failed(usize, Failed),
    Busy(Busy),
}

/// The state that threads share: the points that are left, and how many of them may be measured.
struct Queue {
    open: VecDeque<usize>,
    limit: Option<usize>,
}

impl Pass<'_> {
    /// Measures the points `open`, `limit` of them at most. Returns what is left of the limit.
    pub fn run<T, E>(
        &self,
        open: VecDeque<usize>,
        limit: Option<usize>,
        make: &(impl Fn(&[usize]) -> Result<Vec<T>, E> + Sync),
        mut receive: impl FnMut(Message<T>),
    ) -> Result<Option<usize>, E>
    where
        T: Serialize + DeserializeOwned + Send,
        E: PointError + From<StoreError> + Send,
    {
        self.store.create()?;
        let threads = self.jobs.clamp(1, open.len().max(1));
        let queue = Mutex::new(Queue { open, limit });
        thread::scope(|scope| {
            let (sender, receiver) = mpsc::channel();
            let threads: Vec<_> = (0..threads)
                .map(|_| {
                    let (sender, queue) = (sender.clone(), &queue);
                    scope.spawn(move || {
                        let ended = self.work(queue, make, &sender);
                        if ended.is_err() {
                            lock(queue).open.clear();
                        }
                        ended
                    })
                })
                .collect();
            drop(sender);
            receiver.into_iter().for_each(&mut receive);
            threads.into_iter().try_for_each(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)))
        })?;
        Ok(queue.into_inner().unwrap_or_else(PoisonError::into_inner).limit)
    }

    /// What one thread does: claims points, measures them, keeps them.
    fn work<T, E>(
        &self,
        queue: &Mutex<Queue>,
        make: &impl Fn(&[usize]) -> Result<Vec<T>, E>,
        sender: &Sender<Message<T>>,
    ) -> Result<(), E>
    where
        T: Serialize + DeserializeOwned,
        E: PointError + From<StoreError>,
    {
        // If the receiver is gone, nobody needs the message.
        let tell = |message| drop(sender.send(message));
        loop {
            let mut claims = Vec::new();
            let mut indices = Vec::new();
            while indices.len() < self.batch {
                let Some(index) = lock(queue).next() else { break };
                match self.claim(index)? {
                    Err(busy) => {
                        lock(queue).give_back();
                        tell(Message::Busy(busy));
                    }
                    // Measured by another since this process looked.
                    Ok(claim) => match self.store.get(&self.points[index].key)? {
                        Some(value) => {
                            lock(queue).give_back();
                            tell(Message::Made(index, value));
                        }
                        None => {
                            claims.push(claim);
                            indices.push(index);
                        }
                    },
                }
            }
            let Some(&first) = indices.first() else { return Ok(()) };
            let others = indices.len() - 1;
            let title = &self.points[first].title;
            tell(Message::Begun(if others == 0 { title.clone() } else { format!("{title} and {others} more") }));
            self.measure(&indices, make, tell)?;
            drop(claims);
        }
    }

    fn measure<T, E>(
        &self,
        indices: &[usize],
        make: &impl Fn(&[usize]) -> Result<Vec<T>, E>,
        tell: impl Fn(Message<T>),
    ) -> Result<(), E>
    where
        T: Serialize,
        E: PointError + From<StoreError>,
    {
        let begun = Instant::now();
        match make(indices) {
            Ok(values) => {
                let seconds = begun.elapsed().as_secs_f64() / indices.len() as f64;
                let spent = Spent { seconds, peak_memory_mib: peak_memory_mib() };
                for (&index, value) in indices.iter().zip(values) {
                    let key = &self.points[index].key;
                    self.store.put_spent(key, &value, spent)?;
                    Failed::forget(self.store, key)?;
                    tell(Message::Made(index, value));
                }
            }
            Err(error) if error.is_of_point() => {
                for &index in indices {
                    let failed = Failed::record(self.store, &self.points[index].key, &error.to_string())?;
                    tell(Message::Failed(index, failed));
                }
            }
            Err(error) => return Err(error),
        }
        Ok(())
    }

    /// Claims a point, or finds out who has.
    fn claim(&self, index: usize) -> Result<Result<Claim, Busy>, StoreError> {
        let path = self.store.file(&self.points[index].key, CLAIM);
        let fail = |error| StoreError::io("claim", Path::new(&path), error);
        loop {
            if let Some(claim) = Claim::take(&path, self.lease).map_err(fail)? {
                return Ok(Ok(claim));
            }
            // Between the two the other may have ended.
            if let Some(claim) = claim::read(&path).map_err(fail)? {
                return Ok(Err(Busy { index, claim, since: Instant::now() }));
            }
        }
    }
}

impl Queue {
    fn next(&mut self) -> Option<usize> {
        if self.limit == Some(0) {
            return None;
        }
        let index = self.open.pop_front()?;
        self.limit = self.limit.map(|limit| limit - 1);
        Some(index)
    }

    /// A point did not have to be measured.
    fn give_back(&mut self) {
        self.limit = self.limit.map(|limit| limit + 1);
    }
}

fn lock(queue: &Mutex<Queue>) -> MutexGuard<'_, Queue> {
    queue.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The most memory that this process has held so far, and the most that one of its children has, MiB.
#[cfg(target_os = "linux")]
fn peak_memory_mib() -> u64 {
    use nix::sys::resource::{UsageWho, getrusage};
    let peak = |who| getrusage(who).map_or(0, |usage| u64::try_from(usage.max_rss()).unwrap_or(0));
    // In KiB, by getrusage(2).
    (peak(UsageWho::RUSAGE_SELF) + peak(UsageWho::RUSAGE_CHILDREN)).div_ceil(1024)
}

#[cfg(not(target_os = "linux"))]
fn peak_memory_mib() -> u64 {
    0
}
