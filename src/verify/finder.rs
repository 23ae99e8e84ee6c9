//! The simulated AFU as what finds spheres: a job per call, every contact compared with the software.

use super::{Bench, Totals, VerifyError};
use crate::kernel::EngineError;
use crate::link::LinkModel;
use crate::spheres::{Finder, Hit, Spheres};

/// A [`Bench`] whose AFU takes spheres. Sets that are larger than its table are cut into tiles.
///
/// It never returns a wrong result: a job with a contact that differs from the software's is an error.
#[derive(Clone, Debug)]
pub struct BenchFinder<'a> {
    bench: &'a Bench,
    link: LinkModel,
    seed: u64,
    totals: Totals,
}

impl<'a> BenchFinder<'a> {
    /// The AFU of `bench` behind `link`. The first call has the seed `seed`, and each further one the next.
    pub fn new(bench: &'a Bench, link: LinkModel, seed: u64) -> Self {
        Self { bench, link, seed, totals: Totals::default() }
    }

    /// The work so far; `pairs` are the candidates.
    pub fn totals(&self) -> Totals {
        self.totals
    }
}

/// A job in which the AFU and the software disagree.
#[derive(Debug, thiserror::Error)]
#[error("call {call} of the simulated AFU: {}", failed_checks.join("; "))]
pub struct Unlike {
    /// The call's number, from 0.
    pub call: u64,
    /// What differs.
    pub failed_checks: Vec<String>,
}

impl Finder for BenchFinder<'_> {
    fn find(&mut self, sets: &Spheres) -> Result<Vec<Hit>, EngineError> {
        let (call, table) = (self.totals.jobs, self.bench.config().search.table);
        let seed = self.seed.wrapping_add(call);
        let longest = sets.second.iter().chain([&sets.first]).map(Vec::len).max();
        let verdict = if longest > Some(table as usize) {
            self.bench.run_spheres_in_tiles(sets, table, &self.link, seed)
        } else {
            self.bench.run_spheres(sets, &self.link, seed, None)
        };
        let verdict = verdict.map_err(|error: VerifyError| Box::new(error) as EngineError)?;
        if !verdict.is_good() {
            return Err(Box::new(Unlike { call, failed_checks: verdict.failed_checks }));
        }
        self.totals.jobs += 1;
        self.totals.pairs += verdict.counts.candidates;
        self.totals.cycles += verdict.outcome.cycles;
        Ok(verdict.hits_with_contacts().collect())
    }
}
