//! Pairs as CSV: `x1,y1,z1,r1,x2,y2,z2,r2`.

use super::{FileError, table};
use crate::kernel::{PAIR_FIELDS, PairRecord};
use std::io::{self, Write};
use std::path::Path;

pub fn read(file: &Path, text: &[u8]) -> Result<Vec<PairRecord>, FileError> {
    let mut pairs = Vec::new();
    table::read(file, text, &PAIR_FIELDS, |row| {
        let mut words = [0; 8];
        for (i, word) in words.iter_mut().enumerate() {
            *word = row.number(i)?.to_bits();
        }
        pairs.push(PairRecord(words));
        Ok(())
    })?;
    Ok(pairs)
}

/// Every value reads back to the same word, but for a NaN's, which reads back canonical.
pub fn write(out: impl Write, pairs: &[PairRecord]) -> io::Result<()> {
    let mut out = csv::Writer::from_writer(out);
    out.write_record(PAIR_FIELDS)?;
    for pair in pairs {
        out.write_record(pair.values().map(table::decimal))?;
    }
    out.flush()
}
