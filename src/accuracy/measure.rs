//! Contenders on a set of pairs, judged against the truth and measured.

use super::spread::Gathered;
use super::{Answer, Contender, ErrorStatistics, Row, Standard, StudyError, Tally, judge};
use crate::kernel::EngineError;
use crate::query::{PairRecord, Query};
use crate::store::{Key, Store, StoreError, sha256};
use serde::{Deserialize, Serialize};
use std::thread;

/// The number of pairs that are judged at a time. The truth about each takes 2 KB.
const BATCH: usize = 4096;

/// A contender that failed.
#[derive(Debug, thiserror::Error)]
#[error("{contender}: {error}")]
pub struct ContenderError {
    /// The contender.
    pub contender: String,
    /// The contender's error.
    pub error: EngineError,
}

/// A row for each contender on `pairs` of a query, all valid, which are called `set`. A row comes from `store`, or is
/// measured and stored. `progress` is called with the number of pairs done. Returns the rows, and the number of rows
/// that the store had.
///
/// # Errors
/// Returns an error if a contender fails, or if a row cannot be read or stored.
pub fn measure(
    query: Query,
    set: &str,
    pairs: &[PairRecord],
    contenders: &mut [Box<dyn Contender>],
    store: &Store,
    mut progress: impl FnMut(u64),
) -> Result<(Vec<Row>, usize), StudyError> {
    let mut rows = Vec::new();
    let mut open = Vec::new();
    for (index, contender) in contenders.iter().enumerate() {
        let (mut row, key) = unjudged(query, set, &contender.name(), pairs)?;
        match store.get(&key)? {
            Some(judged) => {
                row = row.with(judged);
                progress(pairs.len() as u64);
            }
            None => open.push((index, key)),
        }
        rows.push(row);
    }
    let resumed = rows.len() - open.len();
    let mut those: Vec<&mut Box<dyn Contender>> = Vec::new();
    for (index, contender) in contenders.iter_mut().enumerate() {
        if open.iter().any(|(of, _)| *of == index) {
            those.push(contender);
        }
    }
    let judged = judge_all(query, pairs, &mut those, progress)?;
    for ((index, key), judged) in open.into_iter().zip(judged) {
        store.put(&key, &judged)?;
        let row = &mut rows[index];
        *row = row.clone().with(judged);
    }
    Ok((rows, resumed))
}

/// The row of a contender before its answers are judged, and the key that they are kept under.
pub(super) fn unjudged(
    query: Query,
    set: &str,
    contender: &str,
    pairs: &[PairRecord],
) -> Result<(Row, Key), StoreError> {
    let row = Row::new(set, contender, hash(query, contender, pairs));
    let key = Key::new("errors/1", &(contender, &row.key))?;
    Ok((row, key))
}

/// The answers of contenders to `pairs`, judged. The truth about a pair is found once for all of them. `progress` is
/// called with the pairs done.
///
/// # Errors
/// Returns an error if a contender fails.
pub(super) fn judge_all(
    query: Query,
    pairs: &[PairRecord],
    contenders: &mut [&mut Box<dyn Contender>],
    mut progress: impl FnMut(u64),
) -> Result<Vec<Judged>, ContenderError> {
    let mut all: Vec<(Tally, Gathered)> = contenders.iter().map(|_| Default::default()).collect();
    // Without contenders the truth is not needed either.
    let anyone = !contenders.is_empty();
    for batch in pairs.chunks(BATCH).take_while(|_| anyone) {
        let standards = standards(query, batch);
        for (contender, (tally, errors)) in contenders.iter_mut().zip(&mut all) {
            let answers =
                contender.answers(batch).map_err(|error| ContenderError { contender: contender.name(), error })?;
            let (counted, found) = count_up(&standards, &answers);
            *tally = tally.plus(&counted);
            errors.extend(found);
            progress(batch.len() as u64);
        }
    }
    Ok(all.into_iter().map(|(tally, errors)| Judged { tally, errors: errors.errors() }).collect())
}

/// The stored part of a row. The request gives the rest.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Judged {
    tally: Tally,
    errors: ErrorStatistics,
}

impl Row {
    /// The row with what was judged.
    pub(super) fn with(self, judged: Judged) -> Self {
        Self { tally: judged.tally, errors: judged.errors, ..self }
    }
}

/// The truth about each pair, found on all processors.
fn standards(query: Query, pairs: &[PairRecord]) -> Vec<Standard> {
    in_parallel(pairs, |part| part.iter().map(|pair| Standard::of(query, pair)).collect())
}

/// Applies `work` to parts of `pairs` in parallel, and returns the results in order.
pub(super) fn in_parallel<T: Send>(pairs: &[PairRecord], work: impl Fn(&[PairRecord]) -> Vec<T> + Sync) -> Vec<T> {
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let share = pairs.len().div_ceil(workers).max(1);
    let work = &work;
    thread::scope(|scope| {
        let parts: Vec<_> = pairs.chunks(share).map(|part| scope.spawn(move || work(part))).collect();
        // A worker ends only by returning. If it panics, so does this.
        parts.into_iter().flat_map(|part| part.join().unwrap_or_default()).collect()
    })
}

fn count_up(standards: &[Standard], answers: &[Answer]) -> (Tally, Gathered) {
    let (mut tally, mut errors) = (Tally::default(), Gathered::default());
    for (standard, answer) in standards.iter().zip(answers) {
        let found = judge(standard, answer);
        tally.add(standard.is_contact(), &found);
        if standard.is_contact() && answer.hit {
            errors.add(&found);
        }
    }
    (tally, errors)
}

/// The tally and the errors of answers to valid pairs.
pub fn assess(query: Query, pairs: &[PairRecord], answers: &[Answer]) -> (Tally, ErrorStatistics) {
    let (tally, errors) = count_up(&standards(query, pairs), answers);
    (tally, errors.errors())
}

/// SHA-256 of everything that affects a row: this program's version, the contender, the query unless it is the default,
/// and the pairs.
fn hash(query: Query, contender: &str, pairs: &[PairRecord]) -> String {
    let query = if query.is_default() { String::new() } else { format!("{query} ") };
    with_pairs(format!("{} {contender} {query}", env!("CARGO_PKG_VERSION")), pairs)
}

/// SHA-256 of a text and pairs.
pub(super) fn with_pairs(text: String, pairs: &[PairRecord]) -> String {
    let mut bytes = text.into_bytes();
    bytes.extend(pairs.iter().flat_map(|pair| pair.0).flat_map(u32::to_le_bytes));
    sha256(&bytes)
}
