//! `afu hard`: profiles and peers on the hard pairs, judged against the truth.

use std::path::PathBuf;

use clap::Args;
use contact_afu::accuracy::{self, HardResults, StudyError, Task};
use contact_afu::config::Profile;

use super::failure::{Failure, Kind};
use super::{output, progress};

/// Judge profiles and other engines on the hard pairs against the truth in arbitrary precision
///
/// For each category: contacts missed or invented, numbers that are none, normals, directions, depths and positions
/// that are wrong, gross failures (BAD), and pairs left unsettled. The same command again resumes.
#[derive(Args, Debug)]
pub struct Hard {
    /// Pairs of all categories together
    #[arg(long, value_name = "N", default_value_t = 170_000)]
    pairs: u64,
    /// Their seed
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::usage::seed)]
    seed: u64,
    /// Profiles to judge, beside the other engines
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "paper,wide,exact")]
    profile: Vec<Profile>,
    /// Folder to write: manifest.json (JSON of all), hard.csv, and measurements/, from which the same command resumes
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
    let task = Task { pairs: options.pairs, seed: options.seed };
    let (mut contenders, absent) =
        accuracy::contenders(&options.profile).map_err(|error| Failure::new(Kind::Other, error))?;
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

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Folder(error) => error.into(),
            StudyError::Engine(_) | StudyError::Store(_) => Self::caused(Kind::Other, error),
        }
    }
}
