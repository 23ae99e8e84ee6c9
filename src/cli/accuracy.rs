//! `afu accuracy`: what accuracy costs in time.

use std::path::PathBuf;
use std::thread;

use clap::Args;
use contact_afu::accuracy::trade::{self, Size, TradeError, Work};
use contact_afu::config::Profile;

use super::failure::{Failure, Kind};
use super::{link, origin, output, progress};

/// Show what accuracy costs in time: errors against the truth beside latency, throughput and area
///
/// For each arithmetic: wrong decisions and errors on the diamond, crowded scenes and the hard pairs; the time of a
/// lone pair and of many over a link, from the simulated Verilog; area and clock of an SCPU, from synthesis. Models and
/// netlists are kept, so only a first run builds them.
#[derive(Args, Debug)]
pub struct Accuracy {
    /// Folder to write: report.html, front.svg, throughput.svg, link.svg, results.csv, results.json, and
    /// measurements/, from which the same command goes on where it was stopped. Without it, a row a profile
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Some ten configurations and fewer pairs; no areas unless --synth asks for them, no routes unless --seeds does
    #[arg(long, requires = "out")]
    quick: bool,
    /// Count cells in the quick study too: the first time Yosys takes longer than all the rest
    #[arg(long, requires = "quick", conflicts_with = "no_synth")]
    synth: bool,
    /// Write into the folder even if afu did not make it; other files in it are left alone
    #[arg(long, requires = "out")]
    force: bool,
    /// Place and route nothing: the fronts are then those of the delay model
    #[arg(long)]
    no_route: bool,
    /// Place and route the points on the fronts with each of these seeds of the placer, a list, of whose clocks the
    /// median counts; nextpnr must then be there [default: 1 in the full study, where nextpnr is there]
    #[arg(long, value_name = "LIST", value_delimiter = ',', requires = "out", conflicts_with_all = ["no_route", "no_synth"])]
    seeds: Vec<u32>,
    /// Link between AFU and memory: a name or file as in `afu cosim`
    #[arg(long, value_name = "NAME|FILE", default_value = "harp1")]
    link: String,
    /// Seed of pairs and link
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Configurations worked on at a time [default: one a processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256))]
    jobs: Option<u32>,
    /// Neighbours of the front that the full study adds, at most
    #[arg(long, value_name = "N", default_value_t = 6, requires = "out")]
    neighbours: usize,
    /// Only these profiles: a list of half, bfloat, paper, wide, exact, eXfY
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    profile: Vec<Profile>,
    /// Neither Yosys nor nextpnr: no areas, and clocks by the delay model
    #[arg(long)]
    no_synth: bool,
    /// Write the results as JSON too (schema contact-afu/accuracy/1); - is standard output
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
