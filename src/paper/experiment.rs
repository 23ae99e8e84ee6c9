//! The experiment: measures ODE, simulates the AFU, and joins both.

use super::measure::measure;
use super::simulate::{SimulateError, Task, simulate};
use super::{Experiment, Published, SCHEMA, Settings, Size};
use crate::config::Config;
use crate::link::LinkModel;
use crate::ode::{self, Benchmark, Collider, Diamond, Ode};
use crate::query::Flow;
use crate::report::{folder, manifest};
use crate::store::{self, Store};
use crate::verify::{Bench, VerifyError};
use serde::Serialize;
use std::path::Path;

/// The settings of an experiment.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The extent: how many numbers of collisions are tried.
    pub size: Size,
    /// Layers of the diamond: hMax.
    pub h_max: u32,
    /// Gap between spheres: dSph.
    pub d_sph: f64,
    /// The kind of collision that counts: tCol.
    pub flow: Flow,
    /// The most collisions: nColMax.
    pub n_col_max: usize,
    /// The number of executions of each collision over which ODE's time is averaged.
    pub executions: u32,
    /// The number of transactions over which the AFU's time is averaged.
    pub transactions: u32,
    /// The AFU.
    pub config: Config,
    /// The link.
    pub link: LinkModel,
    /// Seed of the link.
    pub seed: u64,
    /// The command, for the page.
    pub command: String,
    /// The processor's name, for the page.
    pub processor: String,
}

/// Work done, for progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Number of points timed, and number of all points.
    Measured(usize, usize),
    /// The AFU's model is being built.
    Building,
    /// Number of collisions simulated, and number of all collisions.
    Simulated(usize, usize),
}

/// Why the experiment was not completed.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// ODE could not do its part.
    #[error(transparent)]
    Ode(#[from] ode::Error),
    /// There is no model of the AFU.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// A point could not be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The folder is not ours, or cannot be written.
    #[error(transparent)]
    Folder(#[from] folder::Error),
}

/// The schema of the folder.
#[derive(Serialize)]
struct Manifest<'a> {
    schema: &'static str,
    settings: &'a Settings,
}

/// Runs `plan`. Simulated points in the folder's store are reused, but times are measured again.
///
/// # Errors
/// Returns an error if ODE, the model or a job fails. Returns an error if the folder is not ours or holds another
/// study, unless `force` is set, and if it cannot be written.
pub fn run(plan: &Plan, folder: &Path, force: bool, mut progress: impl FnMut(Work)) -> Result<Experiment, PaperError> {
    folder::check_study(folder, SCHEMA, force)?;
    let Plan { size, config, link, .. } = plan;
    let counts = size.all(plan.n_col_max);
    let benchmark = Benchmark {
        diamond: Diamond::new(plan.h_max, plan.d_sph),
        flow: plan.flow,
        executions: plan.executions,
        ..Benchmark::paper(plan.n_col_max)
    };
    let passes = if *size == Size::Quick { 3 } else { 10 };
    progress(Work::Measured(0, counts.len()));
    let measured = measure(&Ode::start(Collider::Own)?, &benchmark, &counts, passes, |points| {
        progress(Work::Measured(points, counts.len()));
    })?;

    progress(Work::Building);
    let bench = Bench::new(config)?;
    let settings = Settings {
        command: plan.command.clone(),
        processor: plan.processor.clone(),
        h_max: plan.h_max,
        d_sph: plan.d_sph,
        t_col: plan.flow.to_string(),
        n_col_max: measured.recording.collisions.len(),
        executions: plan.executions,
        transactions: plan.transactions,
        steps: measured.recording.steps + 1,
        steps_of_a_run: benchmark.steps_of_a_run,
        clock_ns: measured.recording.clock_ns,
        level: measured.level.to_owned(),
        scpus: config.scpus,
        profile: config.profile.to_string(),
        shell: config.shell.to_string(),
        clock_mhz: config.clock_mhz,
        link: link.name.clone(),
        set_up_ns: (link.session.set_up + link.session.tear_down) as f64 * 1000.0 / config.clock_mhz,
        seed: plan.seed,
        rtl_sha256: bench.rtl_sha256(),
    };
    folder::create(folder)?;
    folder::replace_json(&folder.join(manifest::NAME), &Manifest { schema: SCHEMA, settings: &settings })?;

    let pairs = measured.recording.pairs(usize::MAX);
    let task = Task { bench: &bench, link, pairs: &pairs, seed: plan.seed, transactions: plan.transactions };
    let store = Store::open(&folder.join(store::FOLDER));
    let points = simulate(&task, &counts, &store, |done, of| progress(Work::Simulated(done, of)))?;
    Ok(Experiment::new(settings, *size, &measured.points, &points, &Published::PAPER))
}
