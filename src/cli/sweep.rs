//! `afu sweep`: the same job for each number of SCPUs.

use std::path::PathBuf;

use clap::Args;
use contact_afu::config::Config;
use contact_afu::report::table::counted;
use contact_afu::sweep::{Request, SweepError, SweepResults, Swept, Task};

use super::failure::{Failure, Kind};
use super::list::List;
use super::machine::{Machine, warn_of_unused_scpus};
use super::study::Shared;
use super::{link, output, progress, study};

/// Run the same job on AFUs of different sizes: throughput and latency
///
/// The table has one row per AFU: pairs per second at the clock, cycles per pair, latency, mismatches. Each row is
/// written when it is measured, and host.csv has the seconds that its model and its simulation took. If the command is
/// stopped, or the lists grow, the same command measures only the rows that are missing.
#[derive(Args, Debug)]
pub struct Sweep {
    /// Numbers of SCPUs (sphere collision processing units), 1 to 64: 1,2,4 or 1..16 (includes 16)
    #[arg(long, value_name = "LIST", default_value = "1,2,3,7,10,16")]
    scpus: List,
    /// Initiation intervals, 1 to 64 cycles between two pairs in one SCPU: 1,2,4 or 1..16 (includes 16)
    #[arg(long, value_name = "LIST", default_value = "1")]
    interval: List,
    /// Pairs: diamond:H, random:N, dense:N, hard:N (see `afu help pairs`), or a .csv or .npy file
    #[arg(long, value_name = "SET|FILE", default_value = "diamond:10")]
    pairs: String,
    /// Link between AFU and memory: a name or file as in `afu cosim`
    #[arg(long, value_name = "NAME|FILE", default_value = "ideal")]
    link: String,
    /// Seed of random pairs, of the link, and of the initial values of registers without reset
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Folder to write: report.html (table and plot), throughput.svg, manifest.json with all results, sweep.csv,
    /// host.csv (seconds to build and simulate), and measurements/ to resume from
    #[arg(long, value_name = "DIR", required_unless_present = "store")]
    out: Option<PathBuf>,
    /// Write into a folder that afu did not make, or replace another sweep; other files stay
    #[arg(long, requires = "out")]
    force: bool,
    /// Also write the results as JSON (schema contact-afu/sweep/2) to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Also count the LUTs, flip-flops and DSP blocks of one SCPU of each AFU: Yosys, for an ECP5
    #[arg(long)]
    synth: bool,
    #[command(flatten)]
    machine: Machine,
    #[command(flatten)]
    shared: Shared,
}

pub fn run(options: &Sweep) -> Result<(), Failure> {
    let configs = options.configs()?;
    configs.iter().for_each(warn_of_unused_scpus);
    let base = options.machine.config()?;
    let link = link::read(&options.link, base.clock_mhz)?;
    let pairs = super::pairs::load(base.query, &options.pairs, options.seed)?;
    let task = Task { pairs: &pairs, link: &link, seed: options.seed, counts: options.synth };
    let swept = Swept { scpus: options.scpus.0.clone(), interval: options.interval.0.clone() };
    let results = SweepResults::new(&options.pairs, &options.link, &task, &base, swept);
    let out = options.out.as_deref();
    if let Some(folder) = out {
        results.check(folder, options.force)?;
    }
    let request = Request::new(results, &configs, &task)?;
    options.shared.keep("sweep", &request)?;
    let store = study::store(options.shared.store.as_deref(), out)?;
    let resumed = request.known(&store);
    let mut worker = options.shared.worker();
    let bar = progress::study();
    let results = request.run(&configs, &task, &store, &mut worker, out, |news| options.shared.show(&bar, &news));
    bar.finish_and_clear();
    let results = results?;
    if resumed > 0 {
        eprintln!("{resumed} of {} come from an earlier run", counted(configs.len() as u64, "row"));
    }
    if !options.shared.is_part() {
        let stdout_taken = options.json.as_deref().is_some_and(output::is_stdout);
        output::show(&results.table(), stdout_taken)?;
        if let Some(path) = &options.json {
            output::json(path, &results)?;
        }
    }
    options.shared.end(&worker)?;
    passed(&results)
}

/// An error if an AFU of the sweep is wrong.
pub fn passed(results: &SweepResults) -> Result<(), Failure> {
    let bad: Vec<String> = results.rows.iter().filter(|row| !row.passed()).map(|row| row.scpus.to_string()).collect();
    if bad.is_empty() {
        Ok(())
    } else {
        Err(Failure::new(Kind::Failed, format!("mismatches or failed checks at SCPUs = {}", bad.join(", "))))
    }
}

impl Sweep {
    /// The configurations of the AFUs, each checked.
    fn configs(&self) -> Result<Vec<Config>, Failure> {
        let base = self.machine.config()?;
        let mut configs = Vec::new();
        for &interval in &self.interval.0 {
            for &scpus in &self.scpus.0 {
                let config = Config { scpus, interval, ..base.clone() };
                config.check()?;
                configs.push(config);
            }
        }
        Ok(configs)
    }
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Verify(error) => error.into(),
            SweepError::Synth(error) => error.into(),
            SweepError::Folder(error) => error.into(),
            SweepError::Store(_) | SweepError::Cache(_) => Self::caused(Kind::Other, error),
        }
    }
}
