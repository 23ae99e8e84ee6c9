//! `afu hard`: profiles and peers on the hard pairs, judged against the truth.

use std::path::PathBuf;

use clap::Args;
use contact_afu::accuracy::{self, HardResults, StudyError, Task};
use contact_afu::config::{Config, Profile};
use contact_afu::query::Query;

use super::failure::{Failure, Kind};
use super::{output, progress};

/// Judge profiles and other engines on the hard pairs against the truth in arbitrary precision
///
/// For each category: contacts missed or invented, numbers that are none, normals, directions, depths and positions
/// that are wrong, gross failures (BAD), and pairs left unsettled. The same command again resumes.
#[derive(Args, Debug)]
pub struct Hard {
    /// Which two bodies a pair is of
    #[arg(long, value_name = "QUERY", default_value_t, value_parser = super::usage::query())]
    query: Query,
    /// Pairs of all categories together
    #[arg(long, value_name = "N", default_value_t = 170_000)]
    pairs: u64,
    /// Their seed
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Profiles to judge, beside the other engines [default: paper,wide, and of sphere-sphere exact]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    profile: Vec<Profile>,
    /// Folder to write: manifest.json (JSON of all), hard.csv, hard.svg (gross failures), and measurements/, from which
    /// the same command resumes
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write into the folder even if afu did not make it; other files in it are left alone
    #[arg(long, requires = "out")]
    force: bool,
    /// Write the figures as JSON too (schema contact-afu/hard/1); - is standard output
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
        eprintln!("{resumed} of {} rows are of an earlier run", results.rows.len());
    }
    let stdout_taken = options.json.as_deref().is_some_and(output::is_stdout);
    output::show(&results.tables(), stdout_taken)?;
    match &options.json {
        Some(path) => output::json(path, &results),
        None => Ok(()),
    }
}

impl Hard {
    /// The profiles to judge, each known to be one that the query has.
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
