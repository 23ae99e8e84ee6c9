//! `afu merge`: the results of a study that several processes worked on.

use std::path::PathBuf;

use clap::Args;
#[cfg(feature = "cosim")]
use contact_afu::accuracy::trade;
use contact_afu::report::folder::check_study;
use contact_afu::report::synth_study::{SCHEMA, SynthStudy};
use contact_afu::report::table::counted;
use contact_afu::store::Store;
use contact_afu::study::{Needs, Record, Role, Shard, State, Worker, needs};

use super::failure::{Classify, Failure, Kind};
use super::{origin, output, study};

/// Make the results of a study that several processes measured into one store
///
/// The store was filled by `afu sweep`, `afu accuracy` or `afu synth` with --store. The command writes the files that
/// the same study writes without --store, with the same bytes, and prints its table. If points are missing or failed,
/// it makes the results of the others, names those points and the command that measures them, and ends with status 1.
#[derive(Args, Debug)]
pub struct Merge {
    /// Folder with the measurements
    #[arg(long, value_name = "DIR")]
    store: PathBuf,
    /// Folder to write the results to
    #[arg(long, value_name = "DIR", required_unless_present = "needs")]
    out: Option<PathBuf>,
    /// The study, if the store has several: its name, which the command lists
    #[arg(long, value_name = "NAME")]
    study: Option<String>,
    /// Print what the rest of the study needs, split into M shards, instead of results: minutes and MiB per shard
    ///
    /// The figures follow from what the measured points took. They are one line of words NAME=VALUE for scripts. Time
    /// and memory are left out if no point was measured.
    #[arg(long, value_name = "M", conflicts_with_all = ["out", "json"],
        value_parser = clap::value_parser!(u32).range(1..=i64::from(Shard::MAX)))]
    needs: Option<u32>,
    /// Write into a folder that afu did not make, or replace another study; other files stay
    #[arg(long, requires = "out")]
    force: bool,
    /// Also write the results as JSON to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn run(options: &Merge) -> Result<(), Failure> {
    let store = Store::open(&options.store);
    let record = record(&store, options.study.as_deref())?;
    let mut reader = Worker::new(Role::Reader);
    let ended = options.results(&record, &store, &mut reader)?;
    if let Some(shards) = options.needs {
        let needs = needs(&store, reader.ledger(), shards).ends(Kind::Other)?;
        return output::show(&line(&needs), false);
    }
    options.gaps(&record, &reader)?;
    ended
}

/// The study of a store that is meant.
fn record(store: &Store, name: Option<&str>) -> Result<Record, Failure> {
    let usage = |what: String| Failure::new(Kind::Usage, format!("{}: {what}", store.folder().display()));
    let mut all = Record::all(store).ends(Kind::Other)?;
    if let Some(name) = name {
        all.retain(|record| record.name() == name);
    }
    match all.len() {
        0 if name.is_some() => Err(usage(format!("there is no study {}", name.unwrap_or_default()))),
        0 => Err(usage(
            "there is no study; `afu sweep`, `afu accuracy` or `afu synth` with --store puts one there".to_owned(),
        )),
        1 => Ok(all.remove(0)),
        _ => {
            let list = all.iter().map(|record| format!("\n  --study {}  {}", record.name(), record.command));
            Err(usage(format!("there are {} studies; choose one:{}", all.len(), list.collect::<String>())))
        }
    }
}

impl Merge {
    /// Makes the results, unless only the needs are asked for. The second result is the end of the study itself.
    fn results(&self, record: &Record, store: &Store, reader: &mut Worker) -> Result<Result<(), Failure>, Failure> {
        match record.kind.as_str() {
            #[cfg(feature = "cosim")]
            "sweep" => {
                let request: contact_afu::sweep::Request = self.request(record)?;
                let results = request.read(store, reader)?;
                if let Some(folder) = &self.out {
                    results.check(folder, self.force)?;
                    results.save(folder)?;
                    self.show(&results.table(), &results)?;
                }
                Ok(super::sweep::passed(&results))
            }
            #[cfg(feature = "cosim")]
            "accuracy" => {
                let request: trade::Request = self.request(record)?;
                let plan = request.plan().ends(Kind::Usage)?;
                let mut results = trade::run(&plan, store, reader, |_| ())?.results;
                results.command = request.command;
                if let Some(folder) = &self.out {
                    trade::prepare(folder, self.force)?;
                    super::accuracy::show(&results, Some(folder), self.json.as_deref())?;
                }
                Ok(super::accuracy::passed(&results))
            }
            "synth" => {
                let request: contact_afu::synth::Request = self.request(record)?;
                let results = SynthStudy::new(request.read(store, reader)?, reader);
                if let Some(folder) = &self.out {
                    check_study(folder, SCHEMA, self.force)?;
                    results.save(folder)?;
                    super::synth::show(&results, self.json.as_deref())?;
                }
                Ok(Ok(()))
            }
            kind => Err(Failure::new(
                Kind::Usage,
                format!("{}: this program has no command `{kind}`", store.folder().display()),
            )),
        }
    }

    fn request<T: serde::de::DeserializeOwned>(&self, record: &Record) -> Result<T, Failure> {
        record.of().ok_or_else(|| {
            let text = "the study is of another version of afu, and needs that version";
            Failure::new(Kind::Usage, format!("{}: {text}", self.store.display()))
        })
    }

    #[cfg(feature = "cosim")]
    fn show(&self, table: &str, results: &impl serde::Serialize) -> Result<(), Failure> {
        output::show(table, self.json.as_deref().is_some_and(output::is_stdout))?;
        self.json.as_deref().map_or(Ok(()), |path| output::json(path, results))
    }

    /// Says what is missing and what failed, and how to measure it.
    fn gaps(&self, record: &Record, reader: &Worker) -> Result<(), Failure> {
        let ledger = reader.ledger();
        let failed: Vec<String> =
            study::failures(ledger.iter()).map(|(point, failed)| study::failure(point, failed)).collect();
        let missing: Vec<&str> = ledger
            .iter()
            .filter(|(_, state)| *state == State::Missing)
            .map(|(point, _)| point.title.as_str())
            .collect();
        if failed.is_empty() && missing.is_empty() {
            return Ok(());
        }
        failed.iter().for_each(|line| eprintln!("failed: {line}"));
        missing.iter().for_each(|title| eprintln!("missing: {title}"));
        let command = format!("{} --store {}", record.command, origin::quoted(&[&self.store.display().to_string()]));
        let (points, missing, failed) = (counted(ledger.len() as u64, "point"), missing.len(), failed.len());
        let text = format!("{points}: {missing} missing, {failed} failed; to measure them: {command}");
        Err(Failure::new(Kind::Failed, text))
    }
}

/// Time with half as much again, for slower machines, and with one point more, for one that begins late. Memory with a
/// quarter more.
fn line(needs: &Needs) -> String {
    let Needs { points, measured, mean_seconds, longest_seconds, shard_seconds, peak_memory_mib } = needs;
    let mut line = format!("points={points} measured={measured}");
    if let Some(mean) = mean_seconds {
        let minutes = ((1.5 * shard_seconds + longest_seconds) / 60.0).ceil() + 1.0;
        let memory = (peak_memory_mib * 5).div_ceil(4).max(256);
        line +=
            &format!(" mean_seconds={mean:.2} longest_seconds={longest_seconds:.2} shard_seconds={shard_seconds:.0}");
        line += &format!(" time_minutes={minutes:.0} memory_mib={memory}");
    }
    line
}
