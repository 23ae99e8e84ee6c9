//! The same job for many AFUs: one row per AFU, in a table that grows row by row and can be resumed. A [`Request`] says
//! what is measured; its [`run`](Request::run) makes [`SweepResults`] of it.

mod page;
mod request;
mod results;
mod row;

pub use request::Request;
pub use results::{SCHEMA, SweepResults, Swept};
pub use row::Row;

use std::time::Instant;

use crate::config::Config;
use crate::link::LinkModel;
use crate::query::PairRecord;
use crate::report::folder;
use crate::store::{StoreError, sha256};
use crate::study::PointError;
use crate::synth::{Area, Options, SynthError, Target, Unit, synthesise};
use crate::verify::{Bench, VerifyError};
use row::{HostSeconds, Simulated};

/// The job of every AFU of a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The pairs.
    pub pairs: &'a [PairRecord],
    /// The link.
    pub link: &'a LinkModel,
    /// Seed of the link and of registers that no reset reaches.
    pub seed: u64,
    /// Whether Yosys counts the cells of one SCPU as well.
    pub counts: bool,
}

/// The area of one SCPU on an ECP5.
fn area(config: &Config) -> Result<Area, SweepError> {
    let target = Target::Ecp5;
    let unit = Unit::scpu_for(config, target)?;
    Ok(synthesise(&unit, &Options { target, seeds: Vec::new() }, |_| ())?.area)
}

/// Builds the AFU of `config` from nothing, so that build times can be compared, and runs the task on it.
fn simulate(config: &Config, task: &Task) -> Result<Simulated, SweepError> {
    let cache = tempfile::Builder::new().prefix("afu-sweep-").tempdir().map_err(SweepError::Cache)?;
    let begun = Instant::now();
    let bench = Bench::cached_in(config, cache.path())?;
    let build_seconds = begun.elapsed().as_secs_f64();
    let verdict = bench.run(task.pairs, task.link, task.seed)?;
    let (scpus, interval, simulation_seconds) = (config.scpus, config.interval, verdict.seconds);
    let host = HostSeconds { scpus, interval, build_seconds, simulation_seconds };
    Ok(Simulated { row: Row::of(config, &bench.rtl_sha256(), &verdict), host })
}

/// SHA-256 of pairs, in hex: whether a file or a set is still what it was.
fn fingerprint(pairs: &[PairRecord]) -> String {
    sha256(&pairs.iter().flat_map(|pair| pair.0).flat_map(u32::to_le_bytes).collect::<Vec<_>>())
}

/// Why a sweep was not completed.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// A temporary folder for models could not be created.
    #[error("no temporary folder for models: {0}")]
    Cache(std::io::Error),
    /// Cells could not be counted.
    #[error(transparent)]
    Synth(#[from] SynthError),
    /// A model could not be built, or a job did not finish.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// The folder is not ours, or could not be read or written.
    #[error(transparent)]
    Folder(#[from] folder::Error),
    /// A row could not be read or kept.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl PointError for SweepError {
    fn is_of_point(&self) -> bool {
        match self {
            Self::Verify(error) => error.is_of_afu(),
            Self::Synth(error) => error.is_of_unit(),
            Self::Cache(_) | Self::Folder(_) | Self::Store(_) => false,
        }
    }
}
