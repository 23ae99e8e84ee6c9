//! The AFU's part: every point a transaction of its own through the Verilated AFU.
//!
//! No point is modelled: a link whose latency varies leaves no formula that is right to the cycle.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::AfuPoint;
use crate::kernel::PairRecord;
use crate::link::LinkModel;
use crate::verify::{Bench, VerifyError};

/// Above so many collisions a point is one transaction: their scatter is a few cycles of thousands.
const LARGE: usize = 1000;

/// What is simulated.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The AFU.
    pub bench: &'a Bench,
    /// The link.
    pub link: &'a LinkModel,
    /// The collisions; a point has the first so many of them.
    pub pairs: &'a [PairRecord],
    /// Seed of the first transaction's link; the others follow.
    pub seed: u64,
    /// Transactions of a point of up to 1000 collisions.
    pub transactions: u32,
}

/// Points, and what they are of: a later run of the same task takes them over.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Simulated {
    task: String,
    /// In the order they were done.
    pub points: Vec<AfuPoint>,
}

/// Why a point could not be simulated.
#[derive(Debug, thiserror::Error)]
pub enum SimulateError {
    /// The AFU's job did not come to its end.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// What the AFU wrote is not what the reference kernel gives.
    #[error("{mismatches} of {collisions} contacts of the simulated AFU differ from the reference kernel{}", failed_checks.iter().map(|text| format!("; {text}")).collect::<String>())]
    Wrong {
        /// Collisions of the transaction.
        collisions: usize,
        /// Contacts that differ.
        mismatches: usize,
        /// What else is wrong.
        failed_checks: Vec<String>,
    },
}

impl Task<'_> {
    /// What decides every cycle of it, in hex.
    fn fingerprint(&self) -> String {
        let mut hash = Sha256::new();
        hash.update(self.bench.rtl_sha256());
        hash.update(format!("{:?} {:?} {} {}", self.bench.config(), self.link, self.seed, self.transactions));
        self.pairs.iter().flat_map(|pair| pair.0).for_each(|word| hash.update(word.to_le_bytes()));
        hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Pairs that a point of so many collisions costs.
    fn cost(&self, collisions: usize) -> usize {
        collisions * self.transactions_of(collisions) as usize
    }

    fn transactions_of(&self, collisions: usize) -> u32 {
        if collisions > LARGE { 1 } else { self.transactions.max(1) }
    }

    fn point(&self, collisions: usize) -> Result<AfuPoint, SimulateError> {
        let pairs = &self.pairs[..collisions.min(self.pairs.len())];
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

/// Rounded, so that a file gives back the very same number.
fn thousandths(cycles: f64) -> f64 {
    (cycles * 1000.0).round() / 1000.0
}

/// Simulates a point for each of `counts` that `earlier`, of the same task, does not have; on every processor. After
/// each, `done` gets all points so far and the pairs that are done, of how many.
///
/// # Errors
/// When a job does not end, or a contact is not the reference kernel's.
pub fn simulate<E: From<SimulateError>>(
    task: &Task,
    counts: &[usize],
    earlier: Option<Simulated>,
    mut done: impl FnMut(&Simulated, usize, usize) -> Result<(), E>,
) -> Result<Simulated, E> {
    let name = task.fingerprint();
    let mut simulated = earlier.filter(|earlier| earlier.task == name).unwrap_or_default();
    simulated.task = name;
    let known = |count: &usize| simulated.points.iter().any(|point| point.collisions == *count);
    // The largest first, so that no processor is left with one at the end.
    let mut open: Vec<usize> = counts.iter().copied().filter(|count| !known(count)).collect();
    open.sort_unstable_by(|a, b| b.cmp(a));
    let whole: usize = open.iter().map(|&count| task.cost(count)).sum();
    let open = Mutex::new(VecDeque::from(open));
    let next = || open.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
    let mut finished = 0;
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            let sender = sender.clone();
            scope.spawn(move || {
                while let Some(count) = next() {
                    if sender.send(task.point(count)).is_err() {
                        break; // nobody waits any more
                    }
                }
            });
        }
        drop(sender);
        for point in receiver {
            let point = point?;
            finished += task.cost(point.collisions);
            simulated.points.push(point);
            done(&simulated, finished, whole)?;
        }
        Ok(simulated)
    })
}
