//! `afu sweep`: the same job on AFUs of different sizes.

use std::path::PathBuf;

use clap::Args;
use contact_afu::config::{Config, Input};
use contact_afu::query::{Fields, PairRecord};
use contact_afu::report::table::counted;
use contact_afu::spheres::Spheres;
use contact_afu::sweep::{Job, Request, SweepError, SweepResults, Swept, Task};

use super::failure::{Failure, Kind};
use super::list::List;
use super::machine::{Machine, no_scpus, warn_of_unused_scpus};
use super::study::Shared;
use super::{link, output, progress, study};

/// Run the same job on AFUs of different sizes: throughput and latency
///
/// The table has one row per AFU: pairs per second at the clock, cycles per pair, latency, mismatches; with --input
/// spheres, time per sphere, candidates, contacts, and what the cycle model says. Each row is written when it is
/// measured, and host.csv has the seconds that its model and its simulation took. If the command is stopped, or the
/// lists grow, the same command measures only the rows that are missing.
#[derive(Args, Debug)]
pub struct Sweep {
    /// Numbers of SCPUs (sphere collision processing units), 1 to 64: 1,2,4 or 1..16 (includes 16) [default:
    /// 1,2,3,7,10,16; for input spheres with contacts 1]
    #[arg(long, value_name = "LIST")]
    scpus: Option<List>,
    /// Initiation intervals, 1 to 64 cycles between two pairs in one SCPU: 1,2,4 or 1..16 (includes 16) [default: 1]
    #[arg(long, value_name = "LIST")]
    interval: Option<List>,
    /// Boxes of spheres that are compared in a cycle, for --input spheres: powers of two, 16 to 256 [default: 16]
    #[arg(long, value_name = "LIST")]
    lanes: Option<List>,
    /// Kernels that decide candidates, for --input spheres: powers of two, 1 to 16 [default: 4]
    #[arg(long, value_name = "LIST")]
    deciders: Option<List>,
    /// Bits of each number of a box, for --input spheres: 10 to 32 [default: 24]
    ///
    /// Fewer bits make a smaller AFU and more candidates, and the same contacts.
    #[arg(long, value_name = "LIST")]
    box_bits: Option<List>,
    /// Pairs: diamond:H, random:N, dense:N, hard:N (see `afu help pairs`), or a .csv or .npy file [default: diamond:10]
    #[arg(long, value_name = "SET|FILE")]
    pairs: Option<String>,
    /// Spheres, with --input spheres: diamond:H, gas:N:FILL, probes:Q:M (see `afu help spheres`), or a .csv or .npy
    /// file [default: diamond:10]
    #[arg(long, value_name = "SET|FILE")]
    spheres: Option<String>,
    /// File of a second set of spheres: the AFU finds which of them touch which of --spheres
    #[arg(long, value_name = "FILE")]
    against: Option<PathBuf>,
    /// Put the spheres in the order of a Hilbert curve first, which makes the search faster
    #[arg(long)]
    sort: bool,
    /// Link between AFU and memory: a name or file as in `afu cosim`
    #[arg(long, value_name = "NAME|FILE", default_value = "ideal")]
    link: String,
    /// Seed of random pairs or spheres, of the link, and of the initial values of registers without reset
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
    ///
    /// With --input spheres the whole AFU is counted, which takes minutes for each.
    #[arg(long)]
    synth: bool,
    #[command(flatten)]
    machine: Machine,
    #[command(flatten)]
    shared: Shared,
}

/// Numbers of SCPUs without `--scpus`, where pairs are sent.
const SCPUS: [u32; 6] = [1, 2, 3, 7, 10, 16];
/// The job without `--pairs` and `--spheres`.
const DEFAULT: &str = "diamond:10";

pub fn run(options: &Sweep) -> Result<(), Failure> {
    let base = options.machine.config()?;
    let swept = options.swept(&base)?;
    let configs = swept.configs(&base);
    configs.iter().try_for_each(Config::check)?;
    configs.iter().for_each(warn_of_unused_scpus);
    let link = link::read(&options.link, base.clock_mhz)?;
    let given = options.given(&base)?;
    let (name, job) = match &given {
        Given::Pairs(name, pairs) => (name, Job::Pairs(pairs)),
        Given::Spheres(name, sets) => (name, Job::Spheres(sets)),
    };
    let task = Task { job, link: &link, seed: options.seed, counts: options.synth };
    let results = SweepResults::new(name, &options.link, &task, &base, swept);
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
    let bad = results.rows.iter().filter(|row| !row.passed()).map(|row| row.size());
    let bad: Vec<String> = bad.map(|size| size.title()).collect();
    if bad.is_empty() {
        Ok(())
    } else {
        Err(Failure::new(Kind::Failed, format!("mismatches or failed checks with {}", bad.join("; "))))
    }
}

/// What every AFU is sent, with its name.
enum Given {
    Pairs(String, Vec<PairRecord>),
    Spheres(String, Spheres),
}

impl Sweep {
    /// The lists, each with its default. A list is empty where such AFUs have no such option.
    fn swept(&self, base: &Config) -> Result<Swept, Failure> {
        let given = |list: &Option<List>, usual: &[u32]| list.as_ref().map_or_else(|| usual.to_vec(), |l| l.0.clone());
        if base.input == Input::Direct {
            let (scpus, interval) = (given(&self.scpus, &SCPUS), given(&self.interval, &[1]));
            let of_search = [
                ("--lanes", self.lanes.is_some()),
                ("--deciders", self.deciders.is_some()),
                ("--box-bits", self.box_bits.is_some()),
                ("--spheres", self.spheres.is_some()),
                ("--against", self.against.is_some()),
                ("--sort", self.sort),
            ];
            if let Some((option, _)) = of_search.into_iter().find(|(_, given)| *given) {
                let message = format!("{option} needs AFUs that take spheres: give --input spheres as well");
                return Err(Failure::new(Kind::Usage, message));
            }
            return Ok(Swept { scpus, interval, ..Swept::default() });
        }
        if self.pairs.is_some() {
            let message = "--pairs does not go with --input spheres; give the spheres with --spheres";
            return Err(Failure::new(Kind::Usage, message));
        }
        let (scpus, interval) = if base.contact == Fields::HIT {
            let of_scpus = [("--scpus", &self.scpus), ("--interval", &self.interval)];
            if let Some((option, _)) = of_scpus.into_iter().find(|(_, given)| given.is_some()) {
                return Err(no_scpus(option));
            }
            (Vec::new(), Vec::new())
        } else {
            (given(&self.scpus, &[1]), given(&self.interval, &[1]))
        };
        let search = &base.search;
        Ok(Swept {
            scpus,
            interval,
            lanes: given(&self.lanes, &[search.lanes]),
            deciders: given(&self.deciders, &[search.deciders]),
            box_bits: given(&self.box_bits, &[search.box_bits]),
        })
    }

    /// The pairs or the spheres.
    fn given(&self, base: &Config) -> Result<Given, Failure> {
        if base.input == Input::Direct {
            let name = self.pairs.as_deref().unwrap_or(DEFAULT);
            return Ok(Given::Pairs(name.to_owned(), super::pairs::load(base.query, name, self.seed)?));
        }
        let name = self.spheres.as_deref().unwrap_or(DEFAULT);
        let sets = super::spheres::sets(name, self.against.as_deref(), self.sort, self.seed)?;
        let (count, table) = (sets.first.len(), base.search.table);
        if count > table as usize {
            let message = format!("{name}: {count} spheres; the AFU's table holds {table}; use a larger --table");
            return Err(Failure::new(Kind::Usage, message));
        }
        let mut name = name.to_owned();
        if let Some(against) = &self.against {
            name += &format!(" against {}", against.display());
        }
        if self.sort {
            name += ", sorted";
        }
        Ok(Given::Spheres(name, sets))
    }
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Verify(error) => error.into(),
            SweepError::Synth(error) => error.into(),
            SweepError::Folder(error) => error.into(),
            SweepError::Store(_) | SweepError::Cache(_) | SweepError::Predict(_) => Self::caused(Kind::Other, error),
        }
    }
}
