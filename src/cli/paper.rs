//! `afu paper`: the paper's experiment, on real ODE and the simulated AFU.

use std::path::PathBuf;

use clap::Args;
#[cfg(feature = "ode")]
use contact_afu::{
    config, ode,
    paper::{self, PaperError, SimulateError, Size, Work},
    query::Flow,
    query::Query,
};

use super::failure::{Failure, Kind};
use super::machine::One;
#[cfg(feature = "ode")]
use super::{link, origin, output, progress};

/// Repeat the paper's experiment (Figures 6 and 7) with ODE and the simulated AFU
///
/// The command runs a simulation of ODE, the Open Dynamics Engine: the diamond, spheres in the shape of an octahedron
/// that are pulled to its centre. It times ODE and an f32 kernel on the collisions on this machine, and runs the same
/// collisions through the simulated AFU. The folder gets report.html, the figures as SVG and CSV, and results.json. If
/// the command is stopped, the same command resumes.
///
/// Without the feature `ode` the command ends with status 3 and says how to build it. In the repository,
/// ./scripts/paper installs and builds everything.
#[derive(Args, Debug)]
#[cfg_attr(not(feature = "ode"), allow(dead_code, reason = "only the program with ODE reads them"))]
pub struct Paper {
    /// Folder to write
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Measure fewer points, in some seconds
    #[arg(long)]
    quick: bool,
    /// The paper's hMax: layers of the diamond from its centre to a tip, 1 to 40
    #[arg(long, value_name = "LAYERS", default_value_t = 3, help_heading = "The benchmark")]
    h_max: u32,
    /// The paper's dSph: the gap between neighbouring spheres of radius 0.5; at least -1
    #[arg(
        long,
        value_name = "GAP",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        help_heading = "The benchmark"
    )]
    d_sph: f64,
    /// The paper's tCol: the kind of collision to record
    ///
    /// `fake` pairs do not touch. `real` pairs touch and have a normal. `grazing` pairs touch with coincident (equal)
    /// centres, which needs --d-sph -1.
    #[arg(long, value_name = "KIND", default_value = "real", value_parser = ["fake", "real", "grazing"], help_heading = "The benchmark")]
    t_col: String,
    /// The paper's nColMax: collisions to record, 10 to 1000000; each point of a figure uses the first of them
    #[arg(long, value_name = "N", default_value_t = 90_000, value_parser = clap::value_parser!(u32).range(10..=1_000_000), help_heading = "The benchmark")]
    n_col_max: u32,
    /// Executions of each collision for ODE's average time, 1 to 10000
    #[arg(long, value_name = "TIMES", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10_000), help_heading = "The benchmark")]
    executions: u32,
    /// The paper's X: transactions per point for the AFU's average time, 1 to 1000; always 1 above 1000 collisions
    #[arg(long, value_name = "X", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = "The benchmark")]
    transactions: u32,
    /// Link between AFU and memory: a name or file as in `afu cosim`
    #[arg(long, value_name = "NAME|FILE", default_value = "harp1")]
    link: String,
    /// Seed of the link
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Write into the folder even if afu did not make it; other files in it stay
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    machine: One,
}

#[cfg(feature = "ode")]
pub fn run(options: &Paper) -> Result<(), Failure> {
    let config = options.machine.at_full_rate(options.machine.machine.config()?, &options.link)?;
    if config.query != Query::SphereSphere {
        return Err(config::Error::SpheresAlone(config.query, "the paper's experiment").into());
    }
    let plan = paper::Plan {
        size: if options.quick { Size::Quick } else { Size::Full },
        h_max: options.h_max,
        d_sph: options.d_sph,
        flow: Flow::ALL.into_iter().find(|flow| flow.name() == options.t_col).unwrap_or(Flow::Real),
        n_col_max: options.n_col_max as usize,
        executions: options.executions,
        transactions: options.transactions,
        link: link::read(&options.link, config.clock_mhz)?,
        config,
        seed: options.seed,
        command: origin::command(),
        processor: origin::processor(),
    };
    let mut bar = progress::bar("recording collisions, timing ODE:", "points", 0);
    let results = paper::run(&plan, &options.out, options.force, |work| match work {
        Work::Measured(points, of) => {
            bar.set_length(of as u64);
            bar.set_position(points as u64);
        }
        Work::Building => {
            bar.finish_and_clear();
            bar = progress::spinner("building the AFU's model");
        }
        Work::Simulated(0, of) => {
            bar.finish_and_clear();
            bar = progress::bar("simulating the AFU:", "collisions", of as u64);
        }
        Work::Simulated(collisions, _) => bar.set_position(collisions as u64),
    });
    bar.finish_and_clear();
    let results = results?;
    paper::write(&results, &options.out)?;
    if let Some(summary) = results.summary() {
        output::show(&summary.table(), false)?;
    }
    output::show(&format!("{}", options.out.join("report.html").display()), false)
}

#[cfg(feature = "ode")]
impl From<PaperError> for Failure {
    fn from(error: PaperError) -> Self {
        match error {
            PaperError::Ode(error) => error.into(),
            PaperError::Verify(error) | PaperError::Simulate(SimulateError::Verify(error)) => error.into(),
            PaperError::Folder(error) => error.into(),
            PaperError::Simulate(SimulateError::Wrong { .. }) => Self::caused(Kind::Failed, error),
            PaperError::Simulate(SimulateError::Store(_)) => Self::caused(Kind::Other, error),
        }
    }
}

#[cfg(feature = "ode")]
impl From<ode::Error> for Failure {
    fn from(error: ode::Error) -> Self {
        use ode::Error::{Flow, Number, TooFew};
        let kind = if matches!(error, Number { .. } | TooFew { .. } | Flow(_)) { Kind::Usage } else { Kind::Other };
        Self::caused(kind, error)
    }
}

#[cfg(not(feature = "ode"))]
pub fn run(_: &Paper) -> Result<(), Failure> {
    let install = contact_afu::tools::ode_install("paper --out DIR");
    let message = format!(
        "this program was built without the Open Dynamics Engine, which `afu paper` measures; to get it: {install}"
    );
    Err(Failure::new(Kind::Tool, message))
}
