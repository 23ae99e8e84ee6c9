//! Contenders over the hard categories.

use super::{Contender, Record, RecordError};
use super::{ContenderError, measure};
use crate::kernel::PairRecord;
use crate::pairs::CATEGORIES;
use std::path::Path;

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
    #[error(transparent)]
    Engine(#[from] ContenderError),
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
    let mut all = 0;
    let categories = CATEGORIES.len() as u64;
    for (number, category) in (0..).zip(CATEGORIES) {
        let count = (task.pairs + categories - 1 - number) / categories;
        let pairs: Vec<PairRecord> = category.pairs(count, task.seed).collect();
        let name = category.name();
        let (rows, resumed) = measure(name, &pairs, contenders, &earlier, |pairs| progress(name, pairs))?;
        all += resumed;
        record.rows.extend(rows);
        if let Some((folder, _)) = folder {
            record.save(folder)?;
        }
    }
    Ok(all)
}
