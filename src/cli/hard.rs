//! `afu hard`: profiles and other engines on the hard pairs, judged against exact answers.

use std::path::PathBuf;

use clap::Args;
use contact_afu::accuracy::{self, HardResults, StudyError, Task};
use contact_afu::config::{Config, Profile};
use contact_afu::query::Query;

use super::failure::{Failure, Kind};
use super::{output, progress};

/// Judge arithmetic profiles and other engines on pairs that make floating point fail
///
/// Such hard pairs are tangent or coincident, very small or very large. Answers are judged against arbitrary precision.
/// For each category the tables count false negatives and false positives, NaNs and infinities, and wrong normals,
/// directions, depths and positions. They also count gross failures and pairs that the hardware leaves to the
/// host. docs/hard.md defines the columns. If the command is stopped, the same command resumes.
#[derive(Args, Debug)]
pub struct Hard {
    /// The two bodies of a pair
    #[arg(long, value_name = "QUERY", default_value_t, value_parser = super::usage::query())]
    query: Query,
    /// Number of pairs, divided evenly among the categories
    #[arg(long, value_name = "N", default_value_t = 170_000)]
    pairs: u64,
    /// Seed of the pairs
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Profiles to judge beside the other engines, a comma-separated list [default: paper,wide and for sphere-sphere
    /// also exact]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    profile: Vec<Profile>,
    /// Folder to write: manifest.json with all results, hard.csv, hard.svg (gross failures), measurements/ to resume
    /// from
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write into the folder even if afu did not make it; other files in it stay
    #[arg(long, requires = "out")]
    force: bool,
    /// Also write the results as JSON (schema contact-afu/hard/1) to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn run(options: &Hard) -> Result<(), Failure> {
    let Hard { query, pairs, seed, .. } = *options;
    let task = Task { query, pairs, seed };
    let profiles = options.profiles()?;
    let (mut contenders, absent) =
        accuracy::contenders(query, &profiles).map_err(|error| Failure::new(Kind::Other, error))?;
    let mut results = HardResults::new(task, &absent);
    let bar = progress::bar("hard", "pairs", task.pairs * contenders.len() as u64);
    let folder = options.out.as_deref().map(|folder| (folder, options.force));
    let resumed = accuracy::fill(&mut results, &mut contenders, task, folder, |category, pairs| {
        bar.set_prefix(category.to_owned());
        bar.inc(pairs);
    });
    bar.finish_and_clear();
    let resumed = resumed?;
    if resumed > 0 {
        eprintln!("{resumed} of {} rows come from an earlier run", results.rows.len());
    }
    let stdout_taken = options.json.as_deref().is_some_and(output::is_stdout);
    output::show(&results.tables(), stdout_taken)?;
    match &options.json {
        Some(path) => output::json(path, &results),
        None => Ok(()),
    }
}

impl Hard {
    /// The profiles to judge, each checked against the query.
    fn profiles(&self) -> Result<Vec<Profile>, Failure> {
        let config = |profile| Config { query: self.query, profile, ..Config::default() };
        if self.profile.is_empty() {
            let all = ["paper", "wide", "exact"].into_iter().filter_map(|name| name.parse().ok());
            return Ok(all.filter(|profile: &Profile| config(profile.clone()).check().is_ok()).collect());
        }
        self.profile.iter().try_for_each(|profile| config(profile.clone()).check())?;
        Ok(self.profile.clone())
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Folder(error) => error.into(),
            StudyError::Engine(_) | StudyError::Store(_) => Self::caused(Kind::Other, error),
        }
    }
}
