//! Records as npy: an array of n × 8 little-endian words, read and written without touching a bit.

use super::FileError;
use super::npy_header::{Header, Problem};
use std::io::{self, Write};
use std::path::Path;

/// Words of a record, and its bytes.
const WIDTH: u64 = 8;
const BYTES: u64 = 4 * WIDTH;

/// Reads an array whose elements are of the type `descr` (`<f4` or `<u4`).
pub fn read(file: &Path, bytes: &[u8], descr: &str) -> Result<Vec<[u32; 8]>, FileError> {
    parse(bytes, descr).map_err(|Problem(field, problem)| FileError::Npy { file: file.to_owned(), field, problem })
}

fn parse(bytes: &[u8], descr: &str) -> Result<Vec<[u32; 8]>, Problem> {
    let (header, data) = Header::split(bytes)?;
    if header.descr != descr {
        return Err(Problem("descr", format!("'{}' should be '{descr}'", header.descr)));
    }
    let &[count, WIDTH] = header.shape.as_slice() else {
        return Err(Problem("shape", format!("{:?} should be [n, {WIDTH}]", header.shape)));
    };
    if header.fortran_order && count > 1 {
        return Err(Problem("fortran_order", "True should be False (see numpy.ascontiguousarray)".to_owned()));
    }
    // The shape is believed only where the file bears it out.
    if count.checked_mul(BYTES) != Some(data.len() as u64) {
        let there = data.len();
        return Err(Problem("shape", format!("{count} records of {BYTES} bytes, but the data has {there} bytes")));
    }
    let (words, _) = data.as_chunks::<4>();
    let (records, _) = words.as_chunks::<8>();
    Ok(records.iter().map(|record| record.map(u32::from_le_bytes)).collect())
}

/// Writes records as elements of the type `descr`.
pub fn write(out: &mut impl Write, descr: &str, records: impl ExactSizeIterator<Item = [u32; 8]>) -> io::Result<()> {
    let shape = vec![records.len() as u64, WIDTH];
    out.write_all(&Header { descr: descr.to_owned(), fortran_order: false, shape }.bytes())?;
    for word in records.flatten() {
        out.write_all(&word.to_le_bytes())?;
    }
    Ok(())
}
