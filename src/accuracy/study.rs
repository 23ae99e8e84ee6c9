//! Contenders over categories: the engine.

use super::{Answer, Contender, Record, RecordError, Row, Standard, Tally, judge};
use crate::kernel::{EngineError, PairRecord};
use crate::pairs::CATEGORIES;
use sha2::{Digest, Sha256};
use std::path::Path;
use std::thread;

/// Pairs that are judged at a time: the truth about each takes 2 KB.
const BATCH: usize = 4096;

/// What contenders are given.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// Pairs of all categories together: those of the set `hard:N`.
    pub pairs: u64,
    /// Their seed.
    pub seed: u64,
}

/// Why a study did not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// An engine failed.
    #[error("{contender}: {error}")]
    Engine {
        /// Which.
        contender: String,
        /// Its own error.
        error: EngineError,
    },
    /// The folder is not ours, or could not be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// Fills `record` with a row for each category and contender: those of an earlier run in `folder` whose pairs, name and
/// version are the same, and the others measured now. The folder, where there is one, is written after each category.
/// `progress` hears of every pair and contender done. Says how many rows are of an earlier run.
///
/// # Errors
/// When an engine fails, or the folder is not ours (`force` takes it all the same) or cannot be written.
pub fn fill(
    record: &mut Record,
    contenders: &mut [Box<dyn Contender>],
    task: Task,
    folder: Option<(&Path, bool)>,
    mut progress: impl FnMut(&str, u64),
) -> Result<usize, StudyError> {
    let earlier = folder.map_or(Ok(Vec::new()), |(folder, force)| record.earlier(folder, force))?;
    let mut resumed = 0;
    let categories = CATEGORIES.len() as u64;
    for (number, category) in (0..).zip(CATEGORIES) {
        let count = (task.pairs + categories - 1 - number) / categories;
        let pairs: Vec<PairRecord> = category.pairs(count, task.seed).collect();
        let mut rows: Vec<Row> = contenders
            .iter()
            .map(|contender| Row::new(category.name(), &contender.name(), key(&contender.name(), &pairs)))
            .collect();
        let mut open = Vec::new();
        for (index, row) in rows.iter_mut().enumerate() {
            match earlier.iter().find(|known| known.key == row.key) {
                Some(known) => {
                    row.tally = known.tally;
                    resumed += 1;
                    progress(category.name(), count);
                }
                None => open.push(index),
            }
        }
        // No contender is left to answer: no need of the truth either.
        for batch in pairs.chunks(if open.is_empty() { usize::MAX } else { BATCH }).take_while(|_| !open.is_empty()) {
            let standards = standards(batch);
            for &index in &open {
                let contender = &mut contenders[index];
                let answers = contender
                    .answers(batch)
                    .map_err(|error| StudyError::Engine { contender: contender.name(), error })?;
                rows[index].tally = rows[index].tally.plus(&count_up(&standards, &answers));
                progress(category.name(), batch.len() as u64);
            }
        }
        record.rows.extend(rows);
        if let Some((folder, _)) = folder {
            record.save(folder)?;
        }
    }
    Ok(resumed)
}

/// The truth about each pair, found on all processors.
fn standards(pairs: &[PairRecord]) -> Vec<Standard> {
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let share = pairs.len().div_ceil(workers).max(1);
    thread::scope(|scope| {
        let work = |part: &[PairRecord]| part.iter().map(Standard::of).collect::<Vec<_>>();
        let parts: Vec<_> = pairs.chunks(share).map(|part| scope.spawn(move || work(part))).collect();
        // A worker only ever ends by returning: a panic in it is one here.
        parts.into_iter().flat_map(|part| part.join().unwrap_or_default()).collect()
    })
}

fn count_up(standards: &[Standard], answers: &[Answer]) -> Tally {
    let mut tally = Tally::default();
    for (standard, answer) in standards.iter().zip(answers) {
        tally.add(standard.is_contact(), &judge(standard, answer));
    }
    tally
}

/// SHA-256 of everything that decides a row: this program's version, the contender, the pairs.
fn key(contender: &str, pairs: &[PairRecord]) -> String {
    let mut hash = Sha256::new();
    hash.update(format!("{} {contender} ", env!("CARGO_PKG_VERSION")));
    pairs.iter().flat_map(|pair| pair.0).for_each(|word| hash.update(word.to_le_bytes()));
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
