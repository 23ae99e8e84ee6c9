//! `afu accuracy`: what accuracy costs in time and area.

use std::path::{Path, PathBuf};
use std::thread;

use clap::Args;
use contact_afu::accuracy::trade::{self, Ended, Request, Size, Study, TradeError};
use contact_afu::config::Profile;
use contact_afu::report::table::counted;

use super::failure::{Classify, Failure, Kind};
use super::study::Shared;
use super::{link, origin, output, progress, study};

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
    /// Without this option and --store the command prints one row per profile.
    #[arg(long, value_name = "DIR", group = "place")]
    out: Option<PathBuf>,
    /// Study only some ten configurations on fewer pairs, without synthesis unless --synth or --seeds is given
    #[arg(long, requires = "place")]
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
    #[arg(long, value_name = "LIST", value_delimiter = ',', requires = "place", conflicts_with_all = ["no_route", "no_synth"])]
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
    #[arg(long, value_name = "N", default_value_t = 6, requires = "place")]
    neighbours: usize,
    /// Profiles to study, a comma-separated list of half, bfloat, paper, wide, exact, eXfY [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    profile: Vec<Profile>,
    /// Run neither Yosys nor nextpnr: the results then have no areas, and clocks come from the delay model
    #[arg(long)]
    no_synth: bool,
    /// Do not time the same arithmetic in software on this machine: the results then are the same on any machine
    ///
    /// With --store software is not timed either.
    #[arg(long, requires = "place")]
    no_software: bool,
    /// Also write the results as JSON (schema contact-afu/accuracy/1) to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten)]
    shared: Shared,
}

pub fn run(options: &Accuracy) -> Result<(), Failure> {
    let mut request = options.request()?;
    let shared = &options.shared;
    // A front is drawn through routed points only if all of them can be routed.
    let left_out = if options.seeds.is_empty() && shared.store.is_none() {
        request.without_missing_programs()
    } else {
        request.programs().ends(Kind::Tool)?;
        Vec::new()
    };
    let out = options.out.as_deref();
    if let Some(folder) = out {
        trade::prepare(folder, options.force)?;
    }
    shared.keep("accuracy", &request)?;
    let store = study::store(shared.store.as_deref(), out)?;
    let jobs = options.jobs.map_or_else(|| thread::available_parallelism().map_or(1, usize::from), |n| n as usize);
    let mut worker = shared.worker().with_jobs(jobs);
    let bar = progress::study();
    let mut plan = request.plan().ends(Kind::Usage)?;
    plan.left_out.extend(left_out);
    let ended = trade::run(&plan, &store, &mut worker, |news| shared.show_all(&bar, &news));
    bar.finish_and_clear();
    let Ended { mut results, is_waiting } = ended?;
    results.command.clone_from(&request.command);
    if request.software {
        (results.date, results.processor) = (origin::today(), origin::processor());
    }
    if !shared.is_part() {
        show(&results, out, options.json.as_deref())?;
    }
    shared.end(&worker)?;
    if is_waiting && shared.is_limitless() {
        return Err(Failure::new(
            Kind::Waiting,
            "the next stage needs points of other shards, and nobody works on them; run this command again when they are measured",
        ));
    }
    passed(&results)
}

/// Writes the files of a study, if it has a folder, and shows its table.
pub fn show(results: &Study, out: Option<&Path>, json: Option<&Path>) -> Result<(), Failure> {
    let mut text = trade::table(results);
    if let Some(folder) = out {
        trade::write(results, folder)?;
        text += &format!("\n{}", folder.join("report.html").display());
    }
    output::show(&text, json.is_some_and(output::is_stdout))?;
    json.map_or(Ok(()), |path| output::json(path, results))
}

/// An error if a point of the study is wrong.
pub fn passed(results: &Study) -> Result<(), Failure> {
    match results.points.iter().find(|point| point.cycles.mismatches > 0) {
        None => Ok(()),
        Some(point) => {
            let message =
                format!("{}: {} with the reference", point.name, counted(point.cycles.mismatches, "mismatch"));
            Err(Failure::new(Kind::Failed, message))
        }
    }
}

impl Accuracy {
    /// What is asked for.
    fn request(&self) -> Result<Request, Failure> {
        let is_study = self.out.is_some() || self.shared.store.is_some();
        let size = match (is_study, self.quick) {
            (false, _) => Size::Profiles,
            (true, true) => Size::Quick,
            (true, false) => Size::Full,
        };
        let mut request = Request::new(size, &self.link, self.seed);
        link::describe(&self.link)?;
        request.link.1 = link::text(&self.link)?;
        request.profiles.clone_from(&self.profile);
        request.synthesis = (request.synthesis || self.synth || !self.seeds.is_empty()) && !self.no_synth;
        if size == Size::Full {
            request.neighbours = self.neighbours;
        }
        if !self.seeds.is_empty() {
            request.placer_seeds.clone_from(&self.seeds);
        }
        if self.no_route || self.no_synth {
            request.placer_seeds.clear();
        }
        request.software = !self.no_software && self.shared.store.is_none();
        let place = if is_study { " --out DIR" } else { "" };
        let software = if request.software { "" } else { " --no-software" };
        request.command = format!("{}{software}{place}", origin::study());
        Ok(request)
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
