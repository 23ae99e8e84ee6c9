//! What `afu sweep`, `afu accuracy` and `afu synth` share: studies that several processes work on.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use contact_afu::report::table::counted;
use contact_afu::store::Store;
use contact_afu::study::{Failed, News, Point, Progress, Record, Role, Shard, State, Worker};
use indicatif::{HumanDuration, ProgressBar};

use super::failure::{Classify, Failure, Kind};
use super::{origin, progress};

/// Options of a study that several processes work on.
#[derive(Args, Debug)]
#[command(next_help_heading = "Several processes")]
pub struct Shared {
    /// Folder for the measurements of the study, which other processes and machines may fill at the same time
    ///
    /// A point that another process is working on is left to it. A point that fails is recorded with its error and does
    /// not stop the others; the same command tries it again. `afu merge` makes the results.
    #[arg(long, value_name = "DIR", group = "place")]
    pub store: Option<PathBuf>,
    /// Measure only part K of M of the points, 1/4 to 4/4 for example; their content decides the part
    #[arg(long, value_name = "K/M", requires = "store", conflicts_with_all = ["out", "json"])]
    shard: Option<Shard>,
    /// Take up the point of a process that gave no sign of life for so many seconds, 1 to 86400
    #[arg(long, value_name = "SECONDS", default_value_t = 60, requires = "store",
        value_parser = clap::value_parser!(u32).range(1..=86_400))]
    lease: u32,
    /// Measure at most N points now
    #[arg(long, value_name = "N", requires = "store", value_parser = clap::value_parser!(u32).range(1..))]
    limit: Option<u32>,
}

impl Shared {
    /// The worker of these options.
    pub fn worker(&self) -> Worker {
        let role = self.shard.map_or(Role::Whole, Role::Part);
        let limit = self.limit.map(|limit| limit as usize);
        Worker::new(role).with_lease(Duration::from_secs(self.lease.into())).with_limit(limit)
    }

    /// True if this process makes no results: it does a part of the points.
    pub fn is_part(&self) -> bool {
        self.shard.is_some() || self.limit.is_some()
    }

    /// Keeps what was asked for in the store, for `afu merge`.
    pub fn keep(&self, kind: &str, request: &impl serde::Serialize) -> Result<(), Failure> {
        let Some(folder) = &self.store else { return Ok(()) };
        let record = Record::new(kind, &origin::study(), request).ends(Kind::Other)?;
        record.keep(&Store::open(folder)).ends(Kind::Other)
    }

    /// True if the process measures all points of its part.
    #[cfg(feature = "cosim")]
    pub fn is_limitless(&self) -> bool {
        self.limit.is_none()
    }

    /// Shows the news of a worker: a line that changes on a terminal, or a line per point of a shared study.
    pub fn show(&self, bar: &ProgressBar, news: &News<'_>) {
        self.tell(bar, news, self.store.is_some());
    }

    /// The same with a line per point of any study.
    #[cfg(feature = "cosim")]
    pub fn show_all(&self, bar: &ProgressBar, news: &News<'_>) {
        self.tell(bar, news, true);
    }

    fn tell(&self, bar: &ProgressBar, news: &News<'_>, has_lines: bool) {
        match news {
            News::Begun(what) => bar.set_message((*what).to_owned()),
            News::Ended(point, failed, now) => {
                let line = self.line(*now);
                bar.set_prefix(format!("{line}; "));
                if has_lines {
                    progress::line(&line);
                }
                if let Some(failed) = failed {
                    bar.suspend(|| eprintln!("{}", failure(point, failed)));
                }
            }
        }
    }

    fn line(&self, now: Progress) -> String {
        let Progress { done, failed, left, seconds_left } = now;
        let who = self.shard.map_or_else(String::new, |shard| format!("shard {shard}: "));
        let failures = if failed == 0 { String::new() } else { format!("{failed} failed, ") };
        let time = seconds_left.filter(|_| left > 0).map(|seconds| {
            format!(
                ", about {} to go",
                HumanDuration(Duration::try_from_secs_f64(seconds.max(1.0)).unwrap_or(Duration::MAX))
            )
        });
        let points = counted((done + failed + left) as u64, "point");
        format!("{who}{done} of {points} done, {failures}{left} left{}", time.unwrap_or_default())
    }

    /// The end of a process that measured: an error if points of its own failed.
    pub fn end(&self, worker: &Worker) -> Result<(), Failure> {
        let failed: Vec<String> = failures(worker.own()).map(|(point, failed)| failure(point, failed)).collect();
        match failed.as_slice() {
            [] => Ok(()),
            [one] => Err(Failure::new(Kind::Failed, one)),
            [first, ..] => {
                let of = counted(worker.own().count() as u64, "point");
                Err(Failure::new(Kind::Failed, format!("{} of {of} failed; the first: {first}", failed.len())))
            }
        }
    }
}

/// The points of a ledger that failed.
pub fn failures<'a>(ledger: impl Iterator<Item = &'a (Point, State)>) -> impl Iterator<Item = (&'a Point, &'a Failed)> {
    ledger.filter_map(|(point, state)| match state {
        State::Failed(failed) => Some((point, failed)),
        State::Made | State::Missing => None,
    })
}

/// A line on a point that failed.
pub fn failure(point: &Point, failed: &Failed) -> String {
    let tried = if failed.attempts == 1 { String::new() } else { format!(" (tried {} times)", failed.attempts) };
    format!("{}{tried}: {}", point.title, failed.error.trim_end())
}

/// The store of a study: a shared one, or one in the folder of its results.
pub fn store(shared: Option<&Path>, out: Option<&Path>) -> Result<Store, Failure> {
    match (shared, out) {
        (Some(folder), _) => Ok(Store::open(folder)),
        (None, Some(out)) => Ok(Store::open(&out.join(contact_afu::store::FOLDER))),
        (None, None) => Store::temporary().ends(Kind::Other),
    }
}
