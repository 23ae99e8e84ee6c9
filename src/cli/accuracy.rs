//! `afu accuracy`: what accuracy costs in time and area.

use std::path::PathBuf;
use std::thread;

use clap::Args;
use contact_afu::accuracy::trade::{self, Size, TradeError, Work};
use contact_afu::config::Profile;

use super::failure::{Failure, Kind};
use super::{link, origin, output, progress};

/// Measure what accuracy costs: errors beside latency, throughput and area
///
/// For each arithmetic the table shows wrong decisions and errors against arbitrary precision, on the paper's diamond,
/// crowded scenes and hard pairs. Beside them stand latency and throughput of the simulated Verilog, and area and clock
/// of one SCPU (sphere collision processing unit) after synthesis. Models and netlists are cached, so only the first
/// run builds them.
#[derive(Args, Debug)]
pub struct Accuracy {
    /// Folder for the full study: report.html, pictures, results.csv, results.json, measurements/ to resume from
    ///
    /// Without this option the command prints one row per profile.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Study only some ten configurations on fewer pairs, without synthesis unless --synth or --seeds is given
    #[arg(long, requires = "out")]
    quick: bool,
    /// Count cells in the quick study too; the first time this takes longer than the rest of the study
    #[arg(long, requires = "quick", conflicts_with = "no_synth")]
    synth: bool,
    /// Write into the folder even if afu did not make it; other files in it stay
    #[arg(long, requires = "out")]
    force: bool,
    /// Skip place and route; clocks then come from the delay model
    #[arg(long)]
    no_route: bool,
    /// Seeds of the placer, a comma-separated list: place and route the points on the fronts with each, and use the
    /// median clock [default: 1 in the full study, if nextpnr is installed]
    ///
    /// A front holds the configurations that no other one beats in both time and error. With this option the command
    /// fails if nextpnr is missing.
    #[arg(long, value_name = "LIST", value_delimiter = ',', requires = "out", conflicts_with_all = ["no_route", "no_synth"])]
    seeds: Vec<u32>,
    /// Link between AFU and memory: a name or file as in `afu cosim`
    #[arg(long, value_name = "NAME|FILE", default_value = "harp1")]
    link: String,
    /// Seed of the pairs and of the link
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Configurations measured in parallel, 1 to 256 [default: the number of processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256))]
    jobs: Option<u32>,
    /// Maximum number of neighbours of the front that the full study adds
    #[arg(long, value_name = "N", default_value_t = 6, requires = "out")]
    neighbours: usize,
    /// Profiles to study, a comma-separated list of half, bfloat, paper, wide, exact, eXfY [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    profile: Vec<Profile>,
    /// Run neither Yosys nor nextpnr: the results then have no areas, and clocks come from the delay model
    #[arg(long)]
    no_synth: bool,
    /// Also write the results as JSON (schema contact-afu/accuracy/1) to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn run(options: &Accuracy) -> Result<(), Failure> {
    let jobs = options.jobs.map_or_else(|| thread::available_parallelism().map_or(1, usize::from), |n| n as usize);
    let size = match (&options.out, options.quick) {
        (None, _) => Size::Profiles,
        (Some(_), true) => Size::Quick,
        (Some(_), false) => Size::Full,
    };
    let mut plan = size.plan(link::describe(&options.link)?, &options.link, options.seed, jobs);
    if !options.profile.is_empty() {
        plan.only(&options.profile);
    }
    plan.synthesis = (plan.synthesis || options.synth || !options.seeds.is_empty()) && !options.no_synth;
    if size == Size::Full {
        plan.neighbours = options.neighbours;
    }
    if !options.seeds.is_empty() {
        (plan.placer_seeds, plan.must_route) = (options.seeds.clone(), true);
    }
    if options.no_route || options.no_synth {
        plan.placer_seeds.clear();
    }
    let folder = options.out.as_deref().map(|folder| (folder, options.force));
    let bar = progress::share("accuracy");
    let (mut planned, mut done) = (0.0, 0.0);
    let results = trade::run(&plan, folder, |work| {
        match work {
            Work::Planned(more) => planned += more,
            Work::Begun(what) => bar.set_prefix(what),
            Work::Done(seconds) => done += seconds,
            Work::Configuration(line) => progress::line(&format!("accuracy: {line}")),
        }
        bar.set_length(planned as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let mut results = results?;
    (results.date, results.command, results.processor) = (origin::today(), origin::command(), origin::processor());
    if let Some(folder) = &options.out {
        trade::write(&results, folder)?;
    }
    let mut text = trade::table(&results);
    if let Some(folder) = &options.out {
        text += &format!("\n{}", folder.join("report.html").display());
    }
    output::show(&text, options.json.as_deref().is_some_and(output::is_stdout))?;
    if let Some(path) = &options.json {
        output::json(path, &results)?;
    }
    match results.points.iter().find(|point| point.cycles.mismatches > 0) {
        None => Ok(()),
        Some(point) => {
            let message = format!("{}: {} mismatches with the reference", point.name, point.cycles.mismatches);
            Err(Failure::new(Kind::Failed, message))
        }
    }
}

impl From<TradeError> for Failure {
    fn from(error: TradeError) -> Self {
        match error {
            TradeError::Verify(error) => error.into(),
            TradeError::Synth(error) => error.into(),
            TradeError::Study(error) => error.into(),
            TradeError::Link(_) => Self::caused(Kind::Usage, error),
        }
    }
}
