//! The simulated AFU as an engine: one job per batch, with every bit compared with the reference.

use super::{Bench, VerifyError};
use crate::kernel::{Engine, EngineError};
use crate::link::LinkModel;
use crate::query::{ContactRecord, PairRecord};

/// A [`Bench`] as an engine that computes contacts. Each batch is a job from reset, over the same link.
///
/// It never returns a wrong result: a batch with a record that differs from the reference kernel's is an error.
#[derive(Clone, Debug)]
pub struct BenchEngine<'a> {
    bench: &'a Bench,
    link: LinkModel,
    seed: u64,
    totals: Totals,
}

/// The work of an engine so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// The number of jobs.
    pub jobs: u64,
    /// The number of pairs in them.
    pub pairs: u64,
    /// Clock cycles from start to done, summed over all jobs.
    pub cycles: u64,
}

impl<'a> BenchEngine<'a> {
    /// The AFU of `bench` behind `link`. The first job has the seed `seed`, and each further job the next one.
    pub fn new(bench: &'a Bench, link: LinkModel, seed: u64) -> Self {
        Self { bench, link, seed, totals: Totals::default() }
    }

    /// The work so far.
    pub fn totals(&self) -> Totals {
        self.totals
    }
}

/// A batch in which the AFU and the reference kernel disagree.
#[derive(Debug, thiserror::Error)]
#[error("job {job} of the simulated AFU: {mismatches} of {pairs} records differ from the reference{}", failed_checks.iter().map(|text| format!("; {text}")).collect::<String>())]
pub struct Disagreement {
    /// The job's number, from 0.
    pub job: u64,
    /// The number of pairs.
    pub pairs: usize,
    /// The number of records that differ.
    pub mismatches: usize,
    /// Other checks that failed.
    pub failed_checks: Vec<String>,
}

impl Engine for BenchEngine<'_> {
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        let job = self.totals.jobs;
        let run = self.bench.run(pairs, &self.link, self.seed.wrapping_add(job));
        let verdict = run.map_err(|error: VerifyError| Box::new(error) as EngineError)?;
        if !verdict.is_good() {
            let mismatches = verdict.mismatches.len();
            return Err(Box::new(Disagreement {
                job,
                pairs: pairs.len(),
                mismatches,
                failed_checks: verdict.failed_checks,
            }));
        }
        self.totals.jobs += 1;
        self.totals.pairs += pairs.len() as u64;
        self.totals.cycles += verdict.outcome.cycles;
        Ok(verdict.by_pair())
    }
}
