//! Contenders over the hard categories.

use super::{Contender, ContenderError, HardResults, SCHEMA, measure};
use crate::pairs::categories;
use crate::query::{PairRecord, Query};
use crate::report::folder;
use crate::store::{self, Store, StoreError};
use std::path::Path;

/// The pairs that contenders are given.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// The query.
    pub query: Query,
    /// Pairs of all categories together: those of the set `hard:N`.
    pub pairs: u64,
    /// Seed of the pairs.
    pub seed: u64,
}

/// Why a study could not be completed.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// An engine failed.
    #[error(transparent)]
    Engine(#[from] ContenderError),
    /// The folder is not ours, or could not be written.
    #[error(transparent)]
    Folder(#[from] folder::Error),
    /// A row could not be read or kept.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Fills `results` with a row for each category and contender: those that the folder's store holds, and the others
/// measured now. The folder, if there is one, is written after each category. `progress` is called with the category
/// and the number of pairs done. Returns the number of rows that the store held.
///
/// Returns an error if an engine fails, if the folder is not ours or holds another study (unless forced), or if it
/// cannot be read or written.
pub fn fill(
    results: &mut HardResults,
    contenders: &mut [Box<dyn Contender>],
    task: Task,
    folder: Option<(&Path, bool)>,
    mut progress: impl FnMut(&str, u64),
) -> Result<usize, StudyError> {
    let store = open(folder, SCHEMA)?;
    let mut all = 0;
    let categories = categories(task.query);
    let of = categories.len() as u64;
    for (number, category) in (0..).zip(categories) {
        let count = (task.pairs + of - 1 - number) / of;
        let pairs: Vec<PairRecord> = category.pairs(count, task.seed).collect();
        let name = category.name();
        let (rows, resumed) = measure(task.query, name, &pairs, contenders, &store, |pairs| progress(name, pairs))?;
        all += resumed;
        results.rows.extend(rows);
        if let Some((folder, _)) = folder {
            results.save(folder)?;
        }
    }
    Ok(all)
}

/// The store in a folder for results of this schema; `true` accepts a folder that is not ours. Without a folder the
/// store is temporary.
fn open(folder: Option<(&Path, bool)>, schema: &str) -> Result<Store, StudyError> {
    let Some((folder, force)) = folder else { return Ok(Store::temporary()?) };
    folder::check_study(folder, schema, force)?;
    Ok(Store::open(&folder.join(store::FOLDER)))
}
