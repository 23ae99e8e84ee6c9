//! `afu cosim`: pairs through the simulated AFU, every bit compared with the reference kernel.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use contact_afu::config::{self, Config, Input, Results};
use contact_afu::cosim::Trace;
use contact_afu::link::LinkModel;
use contact_afu::query::{PairRecord, Query};
use contact_afu::report::cosim::{Job, Run};
use contact_afu::report::junit;
use contact_afu::report::table::counted;
use contact_afu::report::tally::Tally;
use contact_afu::verify::{Bench, Command, Origin, Progress, Verdict, corpus};
use contact_afu::{pairs, tools};

use super::failure::{Classify, Failure, Kind};
use super::machine::{One, warn_of_unused_scpus};
use super::{link, output, progress};

/// Mismatches that are listed for each job, on the terminal and in the JSON.
const TOLD: usize = 10;
/// The corpus that mismatching pairs join without `--replay`.
const CORPUS: &str = "afu-corpus.csv";

/// Run pairs through the simulated AFU and compare every bit with the reference kernel
///
/// Verilator turns the AFU's Verilog into a model. Each set or file of pairs is a job: the AFU reads the pairs from
/// simulated memory over a model of the link and writes the contacts back. The command compares every bit of memory
/// with the reference kernel and prints one table of all jobs.
#[derive(Args, Debug)]
pub struct Cosim {
    /// Pairs: diamond:H, random:N, dense:N, hard:N (see `afu help pairs`), or a .csv or .npy file [default:
    /// diamond:10; for sphere-plane random:10000]
    ///
    /// Repeat the option to run several jobs.
    #[arg(long, value_name = "SET|FILE")]
    pub(super) pairs: Vec<String>,
    /// Spheres, with --input spheres: diamond:H, gas:N:FILL, probes:Q:M (see `afu help spheres`), or a .csv or .npy
    /// file [default: diamond:10]
    ///
    /// Repeat the option to run several jobs. What the AFU finds, and the order in which it does, is compared with
    /// the search in software.
    #[arg(long, value_name = "SET|FILE")]
    pub(super) spheres: Vec<String>,
    /// File of a second set of spheres: the AFU finds which of them touch which of --spheres
    #[arg(long, value_name = "FILE")]
    pub(super) against: Option<PathBuf>,
    /// Put the spheres in the order of a Hilbert curve first, which makes the search faster
    #[arg(long)]
    pub(super) sort: bool,
    /// Cut the sets into tiles of at most this many spheres, a multiple of 16, and run a job for every two tiles: for
    /// sets that are larger than --table
    #[arg(long, value_name = "N")]
    pub(super) tile: Option<u32>,
    /// Write the contacts to a .csv or .npy file, as they lie in memory; only for a single job
    ///
    /// With --results hits the file holds only the contacts of pairs that touch, each with the index of its pair.
    #[arg(long, value_name = "FILE")]
    pub(super) contacts: Option<PathBuf>,
    /// Link between AFU and memory: ideal, late, shuffled, hostile, harp1, harp2, pcie3x8, zynqmp, ddr4, or a .toml
    /// file
    ///
    /// `ideal` shows what the AFU alone can do. `late`, `shuffled` and `hostile` are made to find faults: high
    /// latency, responses out of order, stalls. `harp1` and `harp2` are Intel's Xeons with an FPGA, `pcie3x8` is a
    /// card on PCI Express, `zynqmp` a port of a Zynq UltraScale+, `ddr4` a channel of memory on a card. docs/link.md
    /// describes the models and the file.
    #[arg(long, value_name = "NAME|FILE", default_value = "ideal")]
    pub(super) link: String,
    /// Seed of random pairs, of the link, and of the initial values of registers without reset
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    pub(super) seed: u64,
    /// Write a waveform to a .vcd or .fst file; only for a single job
    #[arg(long, value_name = "FILE")]
    pub(super) trace: Option<PathBuf>,
    /// Write the results as JSON (schema contact-afu/cosim/1) to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    pub(super) json: Option<PathBuf>,
    /// Write a JUnit report with one test case per job to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    pub(super) junit: Option<PathBuf>,
    /// Simulate the Verilog in this folder, which `afu rtl` wrote; only --scpus may change the AFU
    #[arg(long, value_name = "DIR")]
    pub(super) rtl: Option<PathBuf>,
    /// Corpus of pairs that mismatched before, a .csv file: run it as the first job and add new mismatches
    ///
    /// If the file does not exist, the first mismatch creates it. Without this option, mismatching pairs are added to
    /// afu-corpus.csv in the current folder.
    #[arg(long, value_name = "FILE")]
    pub(super) replay: Option<PathBuf>,
    #[command(flatten)]
    one: One,
}

pub fn run(options: &Cosim) -> Result<(), Failure> {
    if options.input()? == Input::Spheres {
        return super::cosim_spheres::run(options);
    }
    let of_spheres = [
        ("--spheres", !options.spheres.is_empty()),
        ("--against", options.against.is_some()),
        ("--sort", options.sort),
        ("--tile", options.tile.is_some()),
    ];
    if let Some((option, _)) = of_spheres.into_iter().find(|(_, given)| *given) {
        return Err(Failure::new(Kind::Usage, format!("{option} needs an AFU that takes spheres: --input spheres")));
    }
    let link = link::describe(&options.link)?;
    let trace = options.trace()?;
    let query = options.query()?;
    let jobs = options.jobs(query)?;
    let bench = options.bench(trace)?;
    warn_of_unused_scpus(bench.config());
    let link = link.at(bench.config().clock_mhz).ends(Kind::Usage)?;

    let mut run = Run {
        config: bench.config().clone(),
        seed: options.seed,
        replay: options.command(bench.config()),
        tools: tools::simulators(),
        rtl_sha256: bench.rtl_sha256(),
        link: link.name.clone(),
        jobs: Vec::new(),
    };
    let mut told = Vec::new();
    let mut failed_pairs = Vec::new();
    for (name, pairs) in jobs {
        let (job, verdict) = options.job(&bench, &name, &pairs, &link)?;
        let text = verdict.as_ref().map_or_else(String::new, |verdict| tell(&name, verdict));
        if let Some(verdict) = &verdict {
            failed_pairs.extend(verdict.mismatches.iter().map(|mismatch| mismatch.pair));
            if let Some(path) = &options.contacts {
                write_contacts(path, verdict, bench.config())?;
            }
        }
        for line in job.failures.iter().map(|failure| format!("{name}: {failure}")).chain([text.clone()]) {
            if !line.is_empty() {
                eprintln!("{line}");
            }
        }
        told.push(text);
        run.jobs.push(job);
    }

    let stdout_taken = [&options.json, &options.junit].into_iter().flatten().any(|path| output::is_stdout(path));
    output::show(&format!("{}\n{}", run.table(), run.verdict()), stdout_taken)?;
    if let Some(path) = &options.trace {
        let path = path.display();
        output::show(&format!("waves: open them with `gtkwave {path}` or `surfer {path}`"), stdout_taken)?;
    }
    if let Some(path) = &options.json {
        output::json(path, &run.json())?;
    }
    if let Some(path) = &options.junit {
        output::write(path, junit::xml(&run, &told).ends(Kind::Other)?.as_bytes())?;
    }
    options.verdict(&run, failed_pairs)
}

impl Cosim {
    /// The name and pairs of each job. All files are read before anything is built, so a bad file costs no time.
    fn jobs(&self, query: Query) -> Result<Vec<(String, Vec<PairRecord>)>, Failure> {
        let only_one = [("--contacts", &self.contacts), ("--trace", &self.trace)];
        let jobs = self.pairs.len() + usize::from(self.replay.is_some());
        if let Some((option, _)) = only_one.iter().find(|(_, given)| given.is_some() && jobs > 1) {
            return Err(Failure::new(
                Kind::Usage,
                format!("{option} works with one job only: give one --pairs and no --replay"),
            ));
        }
        if [&self.json, &self.junit].into_iter().flatten().filter(|path| output::is_stdout(path)).count() > 1 {
            return Err(Failure::new(
                Kind::Usage,
                "--json - and --junit -: only one of them can write to standard output; give the other a file",
            ));
        }
        if let Some(path) = &self.contacts {
            pairs::check_name(path)?;
        }
        let mut jobs = Vec::new();
        if let Some(path) = &self.replay {
            let name = path.display().to_string();
            let corpus = super::pairs::noted(&name, corpus::read(query, path)?);
            if !corpus.is_empty() {
                jobs.push((name, corpus));
            }
        }
        for source in self.sources(query) {
            let pairs = super::pairs::load(query, &source, self.seed)?;
            jobs.push((source, pairs));
        }
        Ok(jobs)
    }

    /// What the AFU gets, from the folder of `--rtl` or from the options.
    fn input(&self) -> Result<Input, Failure> {
        match &self.rtl {
            Some(folder) => {
                self.one.only_scpus()?;
                Ok(config::read(folder).ends(Kind::Usage)?.input)
            }
            None => Ok(self.one.machine.config()?.input),
        }
    }

    /// The query of the AFU, from the folder of `--rtl` or from the options.
    fn query(&self) -> Result<Query, Failure> {
        match &self.rtl {
            Some(folder) => {
                self.one.only_scpus()?;
                Ok(config::read(folder).ends(Kind::Usage)?.query)
            }
            None => Ok(self.one.machine.config()?.query),
        }
    }

    /// The sets and files of pairs; the default if none is given.
    fn sources(&self, query: Query) -> Vec<String> {
        let default = if query == Query::SphereSphere { "diamond:10" } else { "random:10000" };
        if self.pairs.is_empty() { vec![default.to_owned()] } else { self.pairs.clone() }
    }

    pub(super) fn trace(&self) -> Result<Trace, Failure> {
        let Some(path) = &self.trace else { return Ok(Trace::Off) };
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("vcd") => Ok(Trace::Vcd),
            Some("fst") => Ok(Trace::Fst),
            _ => Err(Failure::new(
                Kind::Usage,
                format!("--trace {}: expected a name that ends in .vcd or .fst", path.display()),
            )),
        }
    }

    pub(super) fn bench(&self, trace: Trace) -> Result<Bench, Failure> {
        let begun = Instant::now();
        let spinner = progress::spinner("building the AFU's model with Verilator and the C++ compiler");
        let bench = match &self.rtl {
            Some(folder) => Bench::of_folder(folder, self.one.only_scpus()?, trace),
            None => Bench::traced(&self.one.config_over(&self.link)?, trace),
        };
        spinner.finish_and_clear();
        let bench = bench?;
        if let Origin::Library(path) = bench.origin() {
            let seconds = begun.elapsed().as_secs_f64();
            eprintln!("model: {}, after {seconds:.1} s (not the built-in model)", path.display());
        }
        Ok(bench)
    }

    /// Runs one job. A job that does not finish or breaks the protocol has failed, without a verdict.
    fn job(
        &self,
        bench: &Bench,
        name: &str,
        pairs: &[PairRecord],
        link: &LinkModel,
    ) -> Result<(Job, Option<Verdict>), Failure> {
        let bar = progress::bar(name, "pairs", pairs.len() as u64);
        let done = bench.run_with(pairs, link, self.seed, self.trace.as_deref(), |done| match done {
            Progress::Simulated(pairs) => bar.set_position(pairs),
            Progress::Comparing => progress::behind(&bar, "comparing every bit with the reference"),
        });
        bar.finish_and_clear();
        let name = name.to_owned();
        match done {
            Ok(verdict) => {
                let tally = Tally::of(&verdict, bench.config());
                let mismatches = verdict.mismatches.iter().take(TOLD).copied().collect();
                Ok((Job { name, tally, failures: verdict.failed_checks.clone(), mismatches }, Some(verdict)))
            }
            Err(error) if error.is_job_failure() => {
                let tally = Tally { pairs: pairs.len() as u64, ..Tally::default() };
                Ok((Job { name, tally, failures: vec![error.to_string()], mismatches: Vec::new() }, None))
            }
            Err(error) => Err(error.into()),
        }
    }

    fn command(&self, config: &Config) -> String {
        let mut command = match &self.rtl {
            None => Command::new("cosim").config(config),
            Some(folder) => Command::new("cosim").folder(folder, config.scpus),
        };
        for source in self.sources(config.query) {
            command = command.option("--pairs", &source);
        }
        command.option("--link", &self.link).option("--seed", &self.seed.to_string()).line()
    }

    /// Reports failures and adds mismatching pairs to the corpus.
    fn verdict(&self, run: &Run, failed: Vec<PairRecord>) -> Result<(), Failure> {
        if run.passed() {
            return Ok(());
        }
        eprintln!("replay: {}", run.replay);
        if !failed.is_empty() {
            let path = self.replay.as_deref().unwrap_or(Path::new(CORPUS));
            let added = corpus::join(run.config.query, path, failed)?;
            eprintln!(
                "corpus: {} ({}); --replay {} runs it first",
                path.display(),
                counted(added as u64, "new pair"),
                path.display()
            );
        }
        let bad = run.jobs.iter().filter(|job| !job.passed()).count();
        let message = format!(
            "{bad} of {} failed, {}",
            counted(run.jobs.len() as u64, "job"),
            counted(run.total().mismatches, "mismatch")
        );
        Err(Failure::new(Kind::Failed, message))
    }
}

/// Writes the contacts: one for each pair or, with `Results::Hits`, one for each pair that touches, with its index.
fn write_contacts(path: &Path, verdict: &Verdict, config: &Config) -> Result<(), Failure> {
    match config.results {
        Results::All => pairs::write_contacts(path, &verdict.contacts)?,
        Results::Hits => {
            let hits = verdict.numbers.iter().copied().zip(verdict.contacts.iter().copied());
            pairs::write_hits(path, &hits.collect::<Vec<_>>())?;
        }
    }
    Ok(())
}

/// Lists the first mismatches of a job and says how many more there are.
fn tell(job: &str, verdict: &Verdict) -> String {
    let mut told: Vec<String> =
        verdict.mismatches.iter().take(TOLD).map(|found| format!("mismatch: {job}, {found}")).collect();
    if verdict.mismatches.len() > TOLD {
        told.push(format!("({} more mismatches in {job})", verdict.mismatches.len() - TOLD));
    }
    told.join("\n")
}
