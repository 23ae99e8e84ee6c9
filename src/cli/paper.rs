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

/// Run the paper's experiment again: its Figures 6 and 7, on real ODE and the simulated AFU
///
/// Records collisions in ODE's diamond, times ODE and the f32 kernel on them on this machine, sends them through the
/// simulated AFU, and writes figure6.svg, figure7.svg, per-collision.svg, CSVs, results.json and report.html. What was
/// simulated is kept: the same command again goes on where it was stopped.
///
/// Measuring ODE needs the feature `ode`; without it this command ends with status 3 and says how to get it. In the
/// repository ./scripts/paper does everything.
#[derive(Args, Debug)]
#[cfg_attr(not(feature = "ode"), allow(dead_code, reason = "only the program with ODE reads them"))]
pub struct Paper {
    /// Folder to write
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Fewer points: some seconds
    #[arg(long)]
    quick: bool,
    /// The paper's hMax: layers of the diamond from its centre to a tip, 1 to 40
    #[arg(long, value_name = "LAYERS", default_value_t = 3, help_heading = "The benchmark")]
    h_max: u32,
    /// The paper's dSph: the gap between neighbouring spheres, whose radius is 0.5
    #[arg(
        long,
        value_name = "GAP",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        help_heading = "The benchmark"
    )]
    d_sph: f64,
    /// The paper's tCol, the kind of collision that counts
    #[arg(long, value_name = "KIND", default_value = "real", value_parser = ["fake", "real", "grazing"], help_heading = "The benchmark")]
    t_col: String,
    /// The paper's nColMax: the most collisions, of which points have the first ones; at least 10
    #[arg(long, value_name = "N", default_value_t = 90_000, value_parser = clap::value_parser!(u32).range(10..=1_000_000), help_heading = "The benchmark")]
    n_col_max: u32,
    /// How often each collision is executed for ODE's average
    #[arg(long, value_name = "TIMES", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10_000), help_heading = "The benchmark")]
    executions: u32,
    /// The paper's X: transactions that the AFU's average is of, for up to 1000 collisions; above, one
    #[arg(long, value_name = "X", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = "The benchmark")]
    transactions: u32,
    /// Link between AFU and memory: a name or file as in `afu cosim`
    #[arg(long, value_name = "NAME|FILE", default_value = "harp1")]
    link: String,
    /// Seed of the link
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Write into the folder even if afu did not make it; other files in it are left alone
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
    let message =
        format!("this program was built without the Open Dynamics Engine, which `afu paper` measures; {install}");
    Err(Failure::new(Kind::Tool, message))
}
