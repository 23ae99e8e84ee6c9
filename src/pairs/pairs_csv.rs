//! Pairs as CSV: `x1,y1,z1,r1,x2,y2,z2,r2`, and in a corpus `name` before them.

use super::table::Row;
use super::{FileError, table};
use crate::kernel::{PAIR_FIELDS, PairRecord};
use std::io::{self, Write};
use std::path::Path;

/// The columns of a corpus: what each pair is called, and its words.
const NAMED: [&str; 9] = ["name", "x1", "y1", "z1", "r1", "x2", "y2", "z2", "r2"];

/// Reads pairs; names, where there are any, are for people.
pub fn read(file: &Path, text: &[u8]) -> Result<Vec<PairRecord>, FileError> {
    let mut pairs = Vec::new();
    if has_names(text) {
        table::read(file, text, &NAMED, |row| record(&row, 1).map(|pair| pairs.push(pair)))?;
    } else {
        table::read(file, text, &PAIR_FIELDS, |row| record(&row, 0).map(|pair| pairs.push(pair)))?;
    }
    Ok(pairs)
}

fn has_names(text: &[u8]) -> bool {
    let header = text.split(|&byte| byte == b'\n').find(|line| !line.trim_ascii().is_empty()).unwrap_or_default();
    header.split(|&byte| byte == b',').any(|name| name.trim_ascii() == b"name")
}

/// The pair whose words begin in column `first`.
fn record<const N: usize>(row: &Row<'_, N>, first: usize) -> Result<PairRecord, FileError> {
    let mut words = [0; 8];
    for (i, word) in words.iter_mut().enumerate() {
        *word = row.number(first + i)?.to_bits();
    }
    Ok(PairRecord(words))
}

/// Every value reads back to the same word, but for a NaN's, which reads back canonical.
pub fn write(out: impl Write, pairs: &[PairRecord]) -> io::Result<()> {
    let mut out = csv::Writer::from_writer(out);
    // The error of the file system itself, by which a closed pipe is known.
    let plain = |error: csv::Error| match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    };
    out.write_record(PAIR_FIELDS).map_err(plain)?;
    for pair in pairs {
        out.write_record(pair.values().map(table::decimal)).map_err(plain)?;
    }
    out.flush()
}
