//! The file that a sweep grows in, and is resumed from.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Row, Task, fingerprint, sha256};
use crate::config::Config;
use crate::report::folder::{self, replace_file};
use crate::report::table::table;

/// The schema of a sweep's `manifest.json`.
pub const SCHEMA: &str = "contact-afu/sweep/1";
/// The files of a sweep's folder.
const MANIFEST: &str = "manifest.json";
const CSV: &str = "sweep.csv";

/// A sweep: what every AFU was given, and the rows so far. Its folder holds it twice: as `manifest.json`, which it is
/// resumed from, and the rows alone as `sweep.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    schema: String,
    version: String,
    /// The pairs: a set's name, or a file.
    pub pairs: String,
    /// SHA-256 of the pairs' words.
    pub pairs_sha256: String,
    /// The link's name, or its file.
    pub link: String,
    /// SHA-256 of what the link is like; empty in records of before it was kept.
    #[serde(default)]
    pub link_sha256: String,
    /// Seed of pairs and link.
    pub seed: u64,
    /// The configuration, but for what is swept.
    pub config: Config,
    /// The numbers of SCPUs and the intervals that were asked for: a row for each with each.
    #[serde(default)]
    pub swept: Swept,
    /// The rows, in the order asked for.
    pub rows: Vec<Row>,
}

/// What is different in each row of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swept {
    /// Numbers of SCPUs.
    pub scpus: Vec<u32>,
    /// Intervals.
    pub interval: Vec<u32>,
}

/// Why a sweep's folder could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The folder belongs to somebody else, or the file system refused.
    #[error(transparent)]
    Folder(#[from] folder::Error),
    /// The folder holds results of something else.
    #[error(
        "{}: it holds {}; choose another folder, or give --force to replace what is there",
        folder.display(), differences.join(", and ")
    )]
    Other {
        /// The folder.
        folder: PathBuf,
        /// What is other there.
        differences: Vec<String>,
    },
    /// The record could not be read.
    #[error("{}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The record could not be turned into text.
    #[error("cannot write the record: {0}")]
    Write(String),
}

impl Record {
    /// A sweep of `task` without rows. `pairs` and `link` are the names of what the task has.
    pub fn new(pairs: &str, link: &str, task: &Task, config: &Config, swept: Swept) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            pairs: pairs.to_owned(),
            pairs_sha256: fingerprint(task.pairs),
            link: link.to_owned(),
            // A link is plain values: it has JSON.
            link_sha256: sha256(serde_json::to_string(task.link).unwrap_or_default().as_bytes()),
            seed: task.seed,
            config: config.clone(),
            swept,
            rows: Vec::new(),
        }
    }

    /// The rows that an earlier run of the same sweep left in `folder`; none if there is no such folder, or if `force`
    /// replaces what is there.
    ///
    /// # Errors
    /// If the folder is not ours, or holds another sweep or rows that this one does not ask for, without `force`; if it
    /// cannot be read.
    pub fn earlier(&self, folder: &Path, force: bool) -> Result<Vec<Row>, RecordError> {
        folder::check(folder, force)?;
        let path = folder.join(MANIFEST);
        let text = match fs::read(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(RecordError::Read { path, error }),
        };
        let differences = match serde_json::from_slice::<Self>(&text) {
            Ok(there) => match self.differences(&there) {
                none if none.is_empty() => return Ok(there.rows),
                differences => differences,
            },
            Err(_) => vec![format!("results that are no sweep of version {}", self.version)],
        };
        if force { Ok(Vec::new()) } else { Err(RecordError::Other { folder: folder.to_owned(), differences }) }
    }

    /// What `there` is of, where that is not what this sweep is of.
    fn differences(&self, there: &Self) -> Vec<String> {
        let mut differences = Vec::new();
        let mut compare = |what: &str, there: &str, here: &str| {
            if there != here {
                differences.push(format!("a sweep {what} {there}, not {here}"));
            }
        };
        compare("of schema", &there.schema, &self.schema);
        compare("by version", &there.version, &self.version);
        compare("of", &there.pairs, &self.pairs);
        compare("over", &there.link, &self.link);
        compare("with seed", &there.seed.to_string(), &self.seed.to_string());
        let options = |config: &Config| {
            let Config { scpus, interval, .. } = Config::default();
            let flags = Config { scpus, interval, ..config.clone() }.flags();
            // The first is the interval, and rows have their own.
            match flags.get(2..) {
                Some(options) if !options.is_empty() => options.join(" "),
                _ => "the default options".to_owned(),
            }
        };
        compare("with", &options(&there.config), &options(&self.config));
        if there.pairs == self.pairs && there.seed == self.seed && there.pairs_sha256 != self.pairs_sha256 {
            differences.push(format!("a sweep of {} as it was before it changed", there.pairs));
        }
        let is_known = !there.link_sha256.is_empty() && there.link == self.link;
        if is_known && there.config.clock_mhz == self.config.clock_mhz && there.link_sha256 != self.link_sha256 {
            differences.push(format!("a sweep over {} as it was before it changed", there.link));
        }
        let Swept { scpus, interval } = &self.swept;
        let lost = there.rows.iter().filter(|row| !(scpus.contains(&row.scpus) && interval.contains(&row.interval)));
        let lost: Vec<String> = lost.map(|row| format!("{} at interval {}", row.scpus, row.interval)).collect();
        if !lost.is_empty() {
            differences.push(format!("rows that are not asked for now (SCPUs: {})", lost.join(", ")));
        }
        differences
    }

    /// Writes the folder as it is now; each file is replaced whole.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn save(&self, folder: &Path) -> Result<(), RecordError> {
        fs::create_dir_all(folder).map_err(|error| RecordError::Read { path: folder.to_owned(), error })?;
        let mut json = serde_json::to_vec_pretty(self).map_err(|error| RecordError::Write(error.to_string()))?;
        json.push(b'\n');
        replace_file(&folder.join(MANIFEST), &json)?;
        replace_file(&folder.join(CSV), &self.csv()?)?;
        Ok(())
    }

    fn csv(&self) -> Result<Vec<u8>, RecordError> {
        let fail = |error: &dyn std::fmt::Display| RecordError::Write(error.to_string());
        let mut out = csv::Writer::from_writer(Vec::new());
        self.rows.iter().try_for_each(|row| out.serialize(row)).map_err(|error| fail(&error))?;
        out.into_inner().map_err(|error| fail(&error))
    }

    /// The table for people.
    pub fn table(&self) -> String {
        let title = format!(
            "{} over link {}, seed {}, {} arithmetic, {} MHz",
            self.pairs, self.link, self.seed, self.config.profile, self.config.clock_mhz
        );
        format!("{title}\n{}", table(&Row::HEADING, self.rows.iter().map(Row::cells)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::PairRecord;
    use crate::link::LinkModel;

    fn row(scpus: u32) -> Row {
        Row {
            scpus,
            interval: 1,
            scpu_luts: None,
            scpu_ffs: None,
            scpu_dsps: None,
            pairs: 10,
            contacts: 3,
            mismatches: 0,
            failed_checks: 0,
            cycles: 100,
            cycles_per_pair: Some(10.0),
            pairs_per_second: Some(2e7),
            efficiency: Some(0.05),
            bytes_read: 320,
            bytes_written: 320,
            latency_cycles: None,
            clock_mhz: 200.0,
            build_seconds: 1.5,
            simulation_seconds: 0.5,
            rtl_sha256: "00".to_owned(),
        }
    }

    #[test]
    fn the_same_sweep_is_resumed_and_another_is_not() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let folder = room.path().join("out");
        let pairs = [PairRecord::default()];
        let task = Task { pairs: &pairs, link: &LinkModel::ideal(), seed: 1, counts: false };
        let swept = Swept { scpus: vec![1, 2], interval: vec![1] };
        let mut record = Record::new("diamond:3", "ideal", &task, &Config::default(), swept);
        assert_eq!(record.earlier(&folder, false).expect("nothing there"), []);
        record.rows = vec![row(1), row(2)];
        record.save(&folder).expect("written");
        assert_eq!(record.earlier(&folder, false).expect("ours"), record.rows);
        let csv = fs::read_to_string(folder.join(CSV)).expect("written");
        assert!(csv.starts_with("scpus,interval,pairs,contacts,mismatches,") && csv.lines().count() == 3, "{csv}");

        let manifest = fs::read(folder.join(MANIFEST)).expect("written");
        let swept = |scpus: &[u32]| Swept { scpus: scpus.to_vec(), interval: vec![1, 2] };
        let more = Record { swept: swept(&[4, 2, 1]), ..record.clone() };
        assert_eq!(more.earlier(&folder, false).expect("the same and more"), record.rows);
        let paper = Config { profile: "paper".parse().expect("a profile"), ..Config::default() };
        let base = record.clone();
        for (other, words) in [
            (Record { pairs: "diamond:4".to_owned(), ..base.clone() }, "a sweep of diamond:3, not diamond:4;"),
            (Record { pairs_sha256: "ab".to_owned(), ..base.clone() }, "diamond:3 as it was before it changed;"),
            (Record { link: "late".to_owned(), ..base.clone() }, "a sweep over ideal, not late;"),
            (Record { link_sha256: "ab".to_owned(), ..base.clone() }, "over ideal as it was before it changed;"),
            (Record { seed: 2, ..base.clone() }, "a sweep with seed 1, not 2;"),
            (Record { version: "9".to_owned(), ..base.clone() }, "a sweep by version 0.1.0, not 9;"),
            (Record { config: paper, ..base.clone() }, "not --profile paper;"),
            (Record { swept: swept(&[1, 4]), ..base.clone() }, "not asked for now (SCPUs: 2 at interval 1);"),
        ] {
            let refused = other.earlier(&folder, false).expect_err("another").to_string();
            assert!(refused.contains(words) && refused.contains("--force"), "{words}: {refused}");
            assert_eq!(other.earlier(&folder, true).expect("forced"), []);
            assert_eq!(fs::read(folder.join(MANIFEST)).expect("written"), manifest, "nothing is replaced by asking");
        }

        fs::write(folder.join(MANIFEST), r#"{"schema": "contact-afu/manifest/1"}"#).expect("written");
        let refused = record.earlier(&folder, false).expect_err("Verilog").to_string();
        assert!(refused.contains("results that are no sweep"), "{refused}");
        fs::write(folder.join(MANIFEST), "{}").expect("written");
        assert!(matches!(record.earlier(&folder, false), Err(RecordError::Folder(_))));
        assert_eq!(record.earlier(&folder, true).expect("forced"), []);
    }
}
