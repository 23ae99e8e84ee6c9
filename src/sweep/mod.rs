//! The same job for many AFUs: what each number of SCPUs gives, in a table that grows row by row and is resumed.

mod record;
mod row;

pub use record::{Record, RecordError, SCHEMA, Swept};
pub use row::Row;

use std::path::Path;
use std::time::Instant;

use sha2::{Digest, Sha256};

use crate::config::Config;
use crate::kernel::PairRecord;
use crate::link::LinkModel;
use crate::synth::{Area, Options, SynthError, Target, Unit, synthesise};
use crate::verify::{Bench, VerifyError, rtl_sha256};

/// What every AFU of a sweep is given.
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

/// Fills `record` with a row for each of `configs`: those of an earlier run whose Verilog is still the same, and the
/// others measured now. The folder is written after each. Says how many rows are of an earlier run.
///
/// # Errors
/// As [`Bench::new`] and [`Bench::run`]; as [`Record::earlier`]; if the folder cannot be written.
pub fn fill(
    record: &mut Record,
    configs: &[Config],
    task: &Task,
    folder: &Path,
    force: bool,
    mut begins: impl FnMut(&Config),
) -> Result<usize, SweepError> {
    let earlier = record.earlier(folder, force)?;
    let mut rows = Vec::new();
    for config in configs {
        let known = earlier.iter().find(|row| (row.scpus, row.interval) == (config.scpus, config.interval));
        let same = known.map(|row| Ok::<_, SweepError>(rtl_sha256(config)? == row.rtl_sha256)).transpose()?;
        rows.push(known.filter(|_| same == Some(true)).cloned());
    }
    let resumed = rows.iter().flatten().count();
    for index in 0..rows.len() {
        if rows[index].is_none() {
            begins(&configs[index]);
            rows[index] = Some(measure(&configs[index], task)?);
            record.rows = rows.iter().flatten().cloned().collect();
            record.save(folder)?;
        }
        if let Some(row) = rows[index].take_if(|row| task.counts && row.scpu_luts.is_none()) {
            rows[index] = Some(row.with_area(area(&configs[index])?));
        }
    }
    record.rows = rows.into_iter().flatten().collect();
    record.save(folder)?;
    Ok(resumed)
}

/// What one SCPU takes of an ECP5.
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

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Why a sweep did not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// No folder for its model.
    #[error("no temporary folder for models: {0}")]
    Cache(std::io::Error),
    /// No count of cells.
    #[error(transparent)]
    Synth(#[from] SynthError),
    /// No model, or no end of the job.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// The folder is not ours, or could not be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
}
