//! The same job for many AFUs: one row per AFU, in a table that grows row by row and can be resumed. A [`Request`] says
//! what is measured; its [`run`](Request::run) makes [`SweepResults`] of it.

mod job;
mod page;
mod pairs;
mod request;
mod results;
mod row;
mod size;
mod spheres;
mod spheres_page;

pub use job::Job;
pub use pairs::PairsRow;
pub use request::Request;
pub use results::{SCHEMA, SweepResults};
pub use row::Row;
pub use size::{Size, Swept};
pub use spheres::SpheresRow;

use std::time::Instant;

use crate::afu::{PredictError, SearchModel};
use crate::config::Config;
use crate::link::LinkModel;
use crate::report::folder;
use crate::store::StoreError;
use crate::study::PointError;
use crate::synth::{Area, Options, Placer, SynthError, Target, Unit, synthesise};
use crate::verify::{Bench, VerifyError};
use row::{HostSeconds, Simulated};

/// The job of every AFU of a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The pairs, or the spheres.
    pub job: Job<'a>,
    /// The link.
    pub link: &'a LinkModel,
    /// Seed of the link and of registers that no reset reaches.
    pub seed: u64,
    /// Whether Yosys counts the cells of one SCPU as well, or those of a whole AFU that is sent spheres.
    pub counts: bool,
}

/// The area on an ECP5: of one SCPU, or of the whole AFU where the search is the larger part of it.
fn area(config: &Config, task: &Task) -> Result<Area, SweepError> {
    let target = Target::Ecp5;
    let unit = match task.job {
        Job::Pairs(_) => Unit::scpu_for(config, target)?,
        Job::Spheres(_) => Unit::afu(config, target)?,
    };
    Ok(synthesise(&unit, &Options { target, seeds: Vec::new(), placer: Placer::default() }, |_| ())?.area)
}

/// Builds the AFU of `config`, even if the user has a model of it, so that build times can be compared, and runs the
/// task on it.
fn simulate(config: &Config, task: &Task) -> Result<Simulated, SweepError> {
    let cache = tempfile::Builder::new().prefix("afu-sweep-").tempdir().map_err(SweepError::Cache)?;
    let begun = Instant::now();
    let bench = Bench::cached_in(config, cache.path())?;
    let build_seconds = begun.elapsed().as_secs_f64();
    let rtl_sha256 = bench.rtl_sha256();
    let (row, seconds) = match task.job {
        Job::Pairs(pairs) => {
            let verdict = bench.run(pairs, task.link, task.seed)?;
            (Row::Pairs(PairsRow::of(config, &rtl_sha256, &verdict)), verdict.seconds)
        }
        Job::Spheres(sets) => {
            let predicted = SearchModel::new(config, sets)?.predict(config, task.link)?;
            let verdict = bench.run_spheres(sets, task.link, task.seed, None)?;
            (Row::Spheres(SpheresRow::of(config, &rtl_sha256, &verdict, &predicted)), verdict.seconds)
        }
    };
    Ok(Simulated { row, host: HostSeconds::new(Size::of(config), build_seconds, seconds) })
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
    /// The cycle model has no prediction.
    #[error(transparent)]
    Predict(#[from] PredictError),
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
            Self::Predict(_) => true,
            Self::Cache(_) | Self::Folder(_) | Self::Store(_) => false,
        }
    }
}
