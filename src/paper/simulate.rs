//! The AFU's part: each point is a separate transaction through the Verilated AFU.
//!
//! No point is calculated, because no formula is exact to the cycle for a link of varying latency.

use std::cmp::Reverse;
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;

use super::AfuPoint;
use crate::link::LinkModel;
use crate::query::PairRecord;
use crate::store::{Key, Store, StoreError, sha256};
use crate::verify::{Bench, VerifyError};

/// Above this number of collisions, a point is one transaction, because transactions differ by a few cycles in
/// thousands.
const LARGE: usize = 1000;

/// A simulation.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The AFU.
    pub bench: &'a Bench,
    /// The link.
    pub link: &'a LinkModel,
    /// The collisions; a point uses the first ones.
    pub pairs: &'a [PairRecord],
    /// Seed of the first transaction's link. Each further transaction has the next one.
    pub seed: u64,
    /// Transactions of a point of up to 1000 collisions.
    pub transactions: u32,
}

/// Why a point could not be simulated.
#[derive(Debug, thiserror::Error)]
pub enum SimulateError {
    /// The AFU's job did not finish.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// A point could not be read or stored.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The AFU's contacts differ from those of the reference kernel.
    #[error("{mismatches} of {collisions} contacts of the simulated AFU differ from the reference kernel{}", failed_checks.iter().map(|text| format!("; {text}")).collect::<String>())]
    Wrong {
        /// Collisions of the transaction.
        collisions: usize,
        /// Contacts that differ.
        mismatches: usize,
        /// The other checks that failed.
        failed_checks: Vec<String>,
    },
}

impl Task<'_> {
    /// The key of a point: everything that affects it.
    fn key(&self, collisions: usize) -> Result<Key, StoreError> {
        let (rtl, config) = (self.bench.rtl_sha256(), self.bench.config());
        let words = self.first(collisions).iter().flat_map(|pair| pair.0);
        let pairs = sha256(&words.flat_map(u32::to_le_bytes).collect::<Vec<_>>());
        let transactions = self.transactions_of(collisions);
        Key::new("paper/1", &(env!("CARGO_PKG_VERSION"), rtl, config, self.link, self.seed, transactions, pairs))
    }

    fn first(&self, collisions: usize) -> &[PairRecord] {
        &self.pairs[..collisions.min(self.pairs.len())]
    }

    /// Number of simulated pairs for a point of this number of collisions.
    fn cost(&self, collisions: usize) -> usize {
        collisions * self.transactions_of(collisions) as usize
    }

    fn transactions_of(&self, collisions: usize) -> u32 {
        if collisions > LARGE { 1 } else { self.transactions.max(1) }
    }

    fn point(&self, collisions: usize) -> Result<AfuPoint, SimulateError> {
        let pairs = self.first(collisions);
        let transactions = self.transactions_of(collisions);
        let (mut all, mut limit_cycles, mut contacts) = (Vec::new(), 0.0, 0);
        for number in 0..u64::from(transactions) {
            let verdict = self.bench.run(pairs, self.link, self.seed.wrapping_add(number))?;
            if !verdict.is_good() {
                let mismatches = verdict.mismatches.len();
                return Err(SimulateError::Wrong { collisions, mismatches, failed_checks: verdict.failed_checks });
            }
            all.push(verdict.outcome.cycles);
            limit_cycles = verdict.outcome.limit_cycles;
            contacts = u64::from(verdict.outcome.contacts);
        }
        Ok(AfuPoint {
            collisions,
            transactions,
            cycles: thousandths(all.iter().sum::<u64>() as f64 / f64::from(transactions)),
            least_cycles: all.iter().copied().min().unwrap_or(0),
            most_cycles: all.iter().copied().max().unwrap_or(0),
            limit_cycles: thousandths(limit_cycles),
            contacts,
        })
    }
}

/// Rounds, so that reading the file gives exactly the same number.
fn thousandths(cycles: f64) -> f64 {
    (cycles * 1000.0).round() / 1000.0
}

/// A point for each of `counts`. A point comes from `store`, or is simulated on all processors and stored. `progress`
/// is called at the beginning and after each point, with the numbers of pairs done and of all pairs.
///
/// # Errors
/// Returns an error if a job does not finish, if a contact differs from the reference kernel's, or if a point cannot be
/// read or stored.
pub fn simulate(
    task: &Task,
    counts: &[usize],
    store: &Store,
    mut progress: impl FnMut(usize, usize),
) -> Result<Vec<AfuPoint>, SimulateError> {
    let mut points: Vec<AfuPoint> = Vec::new();
    let mut open = Vec::new();
    for &count in counts {
        let key = task.key(count)?;
        match store.get(&key)? {
            Some(point) => points.push(point),
            None => open.push((count, key)),
        }
    }
    // The largest first, so that at the end no processor works alone on a large one.
    open.sort_unstable_by_key(|(count, _)| Reverse(*count));
    let whole: usize = open.iter().map(|(count, _)| task.cost(*count)).sum();
    let open = Mutex::new(VecDeque::from(open));
    let next = || open.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
    let mut finished = 0;
    progress(finished, whole);
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            let sender = sender.clone();
            scope.spawn(move || {
                while let Some((count, key)) = next() {
                    if sender.send(store.get_or_make(&key, || task.point(count))).is_err() {
                        break; // the receiver is gone
                    }
                }
            });
        }
        drop(sender);
        for point in receiver {
            let point = point?;
            finished += task.cost(point.collisions);
            points.push(point);
            progress(finished, whole);
        }
        Ok(points)
    })
}
