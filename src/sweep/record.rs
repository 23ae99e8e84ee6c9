//! The file that a sweep grows in, and is resumed from.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Row;
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
    /// Seed of pairs and link.
    pub seed: u64,
    /// The configuration, but for what the rows say.
    pub config: Config,
    /// The rows, in the order asked for.
    pub rows: Vec<Row>,
}

/// Why a sweep's folder could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The folder belongs to somebody else, or the file system refused.
    #[error(transparent)]
    Folder(#[from] folder::Error),
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
    /// A sweep without rows.
    pub fn new(pairs: &str, pairs_sha256: String, link: &str, seed: u64, config: &Config) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            pairs: pairs.to_owned(),
            pairs_sha256,
            link: link.to_owned(),
            seed,
            config: config.clone(),
            rows: Vec::new(),
        }
    }

    /// The rows that an earlier run of the same sweep left in `folder`; none if it was another sweep, or is none.
    ///
    /// # Errors
    /// When the folder is not ours (`force` takes it all the same) or cannot be read.
    pub fn earlier(&self, folder: &Path, force: bool) -> Result<Vec<Row>, RecordError> {
        folder::check(folder, force)?;
        let path = folder.join(MANIFEST);
        let text = match fs::read(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(RecordError::Read { path, error }),
        };
        // What cannot be read as such a record is another one.
        let Ok(mut record) = serde_json::from_slice::<Self>(&text) else { return Ok(Vec::new()) };
        let rows = std::mem::take(&mut record.rows);
        let same = record == Self { rows: Vec::new(), ..self.clone() };
        Ok(if same { rows } else { Vec::new() })
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
            unmet: 0,
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
        let mut record = Record::new("diamond:3", "ab".to_owned(), "ideal", 1, &Config::default());
        assert_eq!(record.earlier(&folder, false).expect("nothing there"), []);
        record.rows = vec![row(1), row(2)];
        record.save(&folder).expect("written");
        assert_eq!(record.earlier(&folder, false).expect("ours"), record.rows);
        let other = Record { seed: 2, ..record.clone() };
        assert_eq!(other.earlier(&folder, false).expect("ours"), []);
        let csv = fs::read_to_string(folder.join(CSV)).expect("written");
        assert!(csv.starts_with("scpus,interval,pairs,contacts,mismatches,") && csv.lines().count() == 3, "{csv}");

        fs::write(folder.join(MANIFEST), "{}").expect("written");
        assert!(matches!(record.earlier(&folder, false), Err(RecordError::Folder(_))));
        assert_eq!(record.earlier(&folder, true).expect("forced"), []);
    }
}
