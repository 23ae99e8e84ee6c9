//! `afu sweep`: the same job for each number of SCPUs.

use std::path::PathBuf;

use clap::Args;
use contact_afu::config::Config;
use contact_afu::sweep::{SweepError, SweepResults, Swept, Task, fill};

use super::failure::{Failure, Kind};
use super::list::List;
use super::machine::{Machine, warn_of_unused_scpus};
use super::{link, output, progress};

/// Run the same job on AFUs of different sizes and compare them
///
/// For each: pairs a second at the clock, cycles a pair, latency, mismatches, seconds to build its model from nothing
/// and to simulate. Rows are written as they come; the same command again resumes, with more SCPUs or intervals if the
/// lists are longer.
#[derive(Args, Debug)]
pub struct Sweep {
    /// Numbers of SCPUs: 1,2,4 or 1..16 (16 included)
    #[arg(long, value_name = "LIST", default_value = "1,2,3,7,10,16")]
    scpus: List,
    /// Cycles from one pair to the next in one SCPU, 1 to 64: a list as above
    #[arg(long, value_name = "LIST", default_value = "1")]
    interval: List,
    /// Pairs: diamond:H, random:N, dense:N, hard:N, or a .csv or .npy file
    #[arg(long, value_name = "SET|FILE", default_value = "diamond:10")]
    pairs: String,
    /// Link between AFU and memory: ideal, late, shuffled, hostile, harp1, harp2, pcie3x8, or a .toml file of a link
    #[arg(long, value_name = "NAME|FILE", default_value = "ideal")]
    link: String,
    /// Seed of random pairs, of the link, and of registers that no reset reaches
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Folder to write: report.html (table and plot), throughput.svg, manifest.json (JSON of all), sweep.csv, and
    /// measurements/, from which the same command resumes
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Write into the folder even if afu did not make it, or if it holds another sweep, whose rows are replaced; other
    /// files in it are left alone
    #[arg(long)]
    force: bool,
    /// Write the figures as JSON too (schema contact-afu/sweep/1); - is standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Count the cells of one SCPU of each AFU too, with Yosys for an ECP5
    #[arg(long)]
    synth: bool,
    #[command(flatten)]
    machine: Machine,
}

pub fn run(options: &Sweep) -> Result<(), Failure> {
    let configs = options.configs()?;
    configs.iter().for_each(warn_of_unused_scpus);
    let base = options.machine.config()?;
    let link = link::read(&options.link, base.clock_mhz)?;
    let pairs = super::pairs::load(base.query, &options.pairs, options.seed)?;
    let task = Task { pairs: &pairs, link: &link, seed: options.seed, counts: options.synth };
    let swept = Swept { scpus: options.scpus.0.clone(), interval: options.interval.0.clone() };
    let mut results = SweepResults::new(&options.pairs, &options.link, &task, &base, swept);
    let bar = progress::spinner("");
    let resumed = fill(&mut results, &configs, &task, &options.out, options.force, |config| {
        bar.set_message(format!(
            "{} SCPUs, interval {}: building the model and running it",
            config.scpus, config.interval
        ));
    });
    bar.finish_and_clear();
    let resumed = resumed?;
    if resumed > 0 {
        eprintln!("{resumed} of {} rows are of an earlier run", results.rows.len());
    }
    let stdout_taken = options.json.as_deref().is_some_and(output::is_stdout);
    output::show(&results.table(), stdout_taken)?;
    if let Some(path) = &options.json {
        output::json(path, &results)?;
    }
    let bad: Vec<String> = results.rows.iter().filter(|row| !row.passed()).map(|row| row.scpus.to_string()).collect();
    if bad.is_empty() {
        Ok(())
    } else {
        Err(Failure::new(Kind::Failed, format!("mismatches with {} SCPUs", bad.join(", "))))
    }
}

impl Sweep {
    /// The AFUs, each known to be one that can be generated.
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
