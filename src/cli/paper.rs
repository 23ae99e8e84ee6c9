//! `afu paper`: the paper's experiment, on real ODE and the simulated AFU.

use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::machine::One;

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
    pub(super) out: PathBuf,
    /// Fewer points: some seconds
    #[arg(long)]
    pub(super) quick: bool,
    /// The paper's hMax: layers of the diamond from its centre to a tip, 1 to 40
    #[arg(long, value_name = "LAYERS", default_value_t = 3, help_heading = "The benchmark")]
    pub(super) h_max: u32,
    /// The paper's dSph: the gap between neighbouring spheres, whose radius is 0.5
    #[arg(
        long,
        value_name = "GAP",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        help_heading = "The benchmark"
    )]
    pub(super) d_sph: f64,
    /// The paper's tCol, the kind of collision that counts
    #[arg(long, value_name = "KIND", default_value = "real", value_parser = ["fake", "real", "grazing"], help_heading = "The benchmark")]
    pub(super) t_col: String,
    /// The paper's nColMax: the most collisions, of which points have the first ones; at least 10
    #[arg(long, value_name = "N", default_value_t = 90_000, value_parser = clap::value_parser!(u32).range(10..=1_000_000), help_heading = "The benchmark")]
    pub(super) n_col_max: u32,
    /// How often each collision is executed for ODE's average
    #[arg(long, value_name = "TIMES", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10_000), help_heading = "The benchmark")]
    pub(super) executions: u32,
    /// The paper's X: transactions that the AFU's average is of, for up to 1000 collisions; above, one
    #[arg(long, value_name = "X", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = "The benchmark")]
    pub(super) transactions: u32,
    /// Link between AFU and memory: a name or file as in `afu cosim`
    #[arg(long, value_name = "NAME|FILE", default_value = "harp1")]
    pub(super) link: String,
    /// Seed of the link
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    pub(super) seed: u64,
    /// Write into the folder even if afu did not make it; other files in it are left alone
    #[arg(long)]
    pub(super) force: bool,
    #[command(flatten)]
    pub(super) machine: One,
}

#[cfg(feature = "ode")]
pub fn run(options: &Paper) -> Result<(), Failure> {
    super::experiment::run(options)
}

#[cfg(not(feature = "ode"))]
pub fn run(_: &Paper) -> Result<(), Failure> {
    let install = contact_afu::tools::ode_install("paper --out DIR");
    let message =
        format!("this program was built without the Open Dynamics Engine, which `afu paper` measures; {install}");
    Err(Failure::new(super::failure::Kind::Tool, message))
}
