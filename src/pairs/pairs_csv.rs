//! Pairs, or spheres, as CSV: one column per word, and in a corpus `name` before them.

use super::columns::{Columns, Words};
use super::table::Row;
use super::{FileError, table};
use std::io::{self, Write};
use std::path::Path;

/// The column of a corpus that says what each pair is called.
const NAME: &str = "name";

/// Reads records; names, where there are any, are for people.
pub fn read(columns: Columns, file: &Path, text: &[u8]) -> Result<Vec<Words>, FileError> {
    let first = usize::from(has_names(text));
    let names: Vec<&'static str> = [NAME][..first].iter().copied().chain(columns.names()).collect();
    let mut records = Vec::new();
    table::read(file, text, &names, |row| record(columns, &row, first).map(|words| records.push(words)))?;
    Ok(records)
}

fn has_names(text: &[u8]) -> bool {
    let header = text.split(|&byte| byte == b'\n').find(|line| !line.trim_ascii().is_empty()).unwrap_or_default();
    header.split(|&byte| byte == b',').any(|name| name.trim_ascii() == NAME.as_bytes())
}

/// The record whose words begin in column `first`.
fn record(columns: Columns, row: &Row<'_>, first: usize) -> Result<Words, FileError> {
    let mut words = Words::default();
    for (i, word) in words[..columns.len()].iter_mut().enumerate() {
        *word = row.number(first + i)?.to_bits();
    }
    Ok(words)
}

/// Every value reads back as the same word, except NaNs, which read back as the canonical NaN.
pub fn write(out: impl Write, columns: Columns, records: impl Iterator<Item = Words>) -> io::Result<()> {
    let mut out = csv::Writer::from_writer(out);
    // The error of the file system itself, by which a closed pipe is known.
    let plain = |error: csv::Error| match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    };
    out.write_record(columns.names()).map_err(plain)?;
    for words in records {
        let values = words[..columns.len()].iter().map(|word| table::decimal(f32::from_bits(*word)));
        out.write_record(values).map_err(plain)?;
    }
    out.flush()
}
