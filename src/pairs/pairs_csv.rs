//! Pairs as CSV: a column a word of the query's, and in a corpus `name` before them.

use super::table::Row;
use super::{FileError, table};
use crate::query::{PairRecord, Query};
use std::io::{self, Write};
use std::path::Path;

/// The column of a corpus that says what each pair is called.
const NAME: &str = "name";

/// Reads pairs; names, where there are any, are for people.
pub fn read(query: Query, file: &Path, text: &[u8]) -> Result<Vec<PairRecord>, FileError> {
    let first = usize::from(has_names(text));
    let columns: Vec<&'static str> = [NAME][..first].iter().copied().chain(query.shape().names()).collect();
    let mut pairs = Vec::new();
    table::read(file, text, &columns, |row| record(query, &row, first).map(|pair| pairs.push(pair)))?;
    Ok(pairs)
}

fn has_names(text: &[u8]) -> bool {
    let header = text.split(|&byte| byte == b'\n').find(|line| !line.trim_ascii().is_empty()).unwrap_or_default();
    header.split(|&byte| byte == b',').any(|name| name.trim_ascii() == NAME.as_bytes())
}

/// The pair whose words begin in column `first`.
fn record(query: Query, row: &Row<'_>, first: usize) -> Result<PairRecord, FileError> {
    let mut pair = PairRecord::default();
    for (i, (_, word)) in query.shape().names().zip(&mut pair.0).enumerate() {
        *word = row.number(first + i)?.to_bits();
    }
    Ok(pair)
}

/// Every value reads back as the same word, except NaNs, which read back as the canonical NaN.
pub fn write(out: impl Write, query: Query, pairs: &[PairRecord]) -> io::Result<()> {
    let mut out = csv::Writer::from_writer(out);
    // The error of the file system itself, by which a closed pipe is known.
    let plain = |error: csv::Error| match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    };
    out.write_record(query.shape().names()).map_err(plain)?;
    for pair in pairs {
        let values = query.shape().names().zip(pair.values());
        out.write_record(values.map(|(_, value)| table::decimal(value))).map_err(plain)?;
    }
    out.flush()
}
