//! The same job for many AFUs: one row per AFU, in a table that grows row by row and can be resumed.

mod page;
mod results;
mod row;

pub use results::{SCHEMA, SweepResults, Swept};
pub use row::Row;

use std::path::Path;
use std::time::Instant;

use crate::config::Config;
use crate::link::LinkModel;
use crate::query::PairRecord;
use crate::report::folder;
use crate::store::{self, Key, Store, StoreError, sha256};
use crate::synth::{Area, Options, SynthError, Target, Unit, synthesise};
use crate::verify::{Bench, VerifyError, rtl_sha256};

/// The job of every AFU of a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The pairs.
    pub pairs: &'a [PairRecord],
    /// The link.
    pub link: &'a LinkModel,
    /// Seed of the link and of registers that no reset reaches.
    pub seed: u64,
    /// Whether Yosys counts the cells of one SCPU as well.
    pub counts: bool,
}

impl Task<'_> {
    /// The key of a row: everything that decides it.
    fn key(&self, config: &Config) -> Result<Key, SweepError> {
        let version = env!("CARGO_PKG_VERSION");
        let of = (version, config, rtl_sha256(config)?, fingerprint(self.pairs), self.link, self.seed);
        Ok(Key::new("sweep/1", &of)?)
    }
}

/// Fills `results` with a row for each of `configs`: those that the folder's store holds, and the others measured now.
/// The folder is written after each. Returns how many rows the store held.
///
/// # Errors
/// Returns the errors of [`Bench::new`], [`Bench::run`] and [`SweepResults::check`], and an error if the folder cannot
/// be written.
pub fn fill(
    results: &mut SweepResults,
    configs: &[Config],
    task: &Task,
    folder: &Path,
    force: bool,
    mut begins: impl FnMut(&Config),
) -> Result<usize, SweepError> {
    results.check(folder, force)?;
    let store = Store::open(&folder.join(store::FOLDER));
    let keys = configs.iter().map(|config| task.key(config)).collect::<Result<Vec<_>, _>>()?;
    let mut rows = keys.iter().map(|key| store.get::<Row>(key)).collect::<Result<Vec<_>, _>>()?;
    let resumed = rows.iter().flatten().count();
    for (index, (config, key)) in configs.iter().zip(&keys).enumerate() {
        if rows[index].is_none() {
            begins(config);
            let row = measure(config, task)?;
            store.put(key, &row)?;
            rows[index] = Some(row);
            results.rows = rows.iter().flatten().cloned().collect();
            results.save(folder)?;
        }
        if let Some(row) = rows[index].take_if(|row| task.counts && row.scpu_luts.is_none()) {
            let row = row.with_area(area(config)?);
            store.put(key, &row)?;
            rows[index] = Some(row);
        }
    }
    results.rows = rows.into_iter().flatten().collect();
    results.save(folder)?;
    Ok(resumed)
}

/// The area of one SCPU on an ECP5.
fn area(config: &Config) -> Result<Area, SynthError> {
    let target = Target::Ecp5;
    let unit = Unit::scpu_for(config, target)?;
    Ok(synthesise(&unit, &Options { target, seeds: Vec::new() }, |_| ())?.area)
}

/// Builds the AFU of `config` from nothing, so that build times can be compared, and runs the task on it.
fn measure(config: &Config, task: &Task) -> Result<Row, SweepError> {
    let cache = tempfile::Builder::new().prefix("afu-sweep-").tempdir().map_err(SweepError::Cache)?;
    let begun = Instant::now();
    let bench = Bench::cached_in(config, cache.path())?;
    let build_seconds = begun.elapsed().as_secs_f64();
    let verdict = bench.run(task.pairs, task.link, task.seed)?;
    Ok(Row::of(config, &bench.rtl_sha256(), &verdict, build_seconds))
}

/// SHA-256 of pairs, in hex: whether a file or a set is still what it was.
fn fingerprint(pairs: &[PairRecord]) -> String {
    sha256(&pairs.iter().flat_map(|pair| pair.0).flat_map(u32::to_le_bytes).collect::<Vec<_>>())
}

/// Why a sweep was not completed.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// A temporary folder for models could not be created.
    #[error("no temporary folder for models: {0}")]
    Cache(std::io::Error),
    /// Cells could not be counted.
    #[error(transparent)]
    Synth(#[from] SynthError),
    /// A model could not be built, or a job did not finish.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// The folder is not ours, or could not be read or written.
    #[error(transparent)]
    Folder(#[from] folder::Error),
    /// A row could not be read or kept.
    #[error(transparent)]
    Store(#[from] StoreError),
}
