//! Records as npy: an array of n × W little-endian words, read and written without touching a bit.

use super::FileError;
use super::npy_header::{Header, Problem};
use crate::count::counted;
use std::io::{self, Write};
use std::path::Path;

/// Reads an array of records of `W` words, whose elements are of the type `descr` (`<f4` or `<u4`).
pub fn read<const W: usize>(file: &Path, bytes: &[u8], descr: &str) -> Result<Vec<[u32; W]>, FileError> {
    parse(bytes, descr).map_err(|Problem(field, problem)| FileError::Npy { file: file.to_owned(), field, problem })
}

fn parse<const W: usize>(bytes: &[u8], descr: &str) -> Result<Vec<[u32; W]>, Problem> {
    let (header, data) = Header::split(bytes)?;
    if header.descr != descr {
        return Err(Problem("descr", format!("expected '{descr}', found '{}'", header.descr)));
    }
    let count = match *header.shape.as_slice() {
        [count, width] if width == W as u64 => count,
        _ => return Err(Problem("shape", format!("expected [n, {W}], found {:?}", header.shape))),
    };
    if header.fortran_order && count > 1 {
        return Err(Problem("fortran_order", "expected False, found True (see numpy.ascontiguousarray)".to_owned()));
    }
    // The shape is used only if the size of the file agrees with it.
    let record_bytes = 4 * W as u64;
    if count.checked_mul(record_bytes) != Some(data.len() as u64) {
        let there = data.len();
        return Err(Problem(
            "shape",
            format!("expected {} of {record_bytes} bytes, found {there} bytes of data", counted(count, "record")),
        ));
    }
    let (words, _) = data.as_chunks::<4>();
    let (records, _) = words.as_chunks::<W>();
    Ok(records.iter().map(|record| record.map(u32::from_le_bytes)).collect())
}

/// An array of f64, the last index fastest.
pub fn numbers(shape: Vec<u64>, values: impl Iterator<Item = f64>) -> Vec<u8> {
    let mut bytes = Header { descr: "<f8".to_owned(), fortran_order: false, shape }.bytes();
    bytes.extend(values.flat_map(f64::to_le_bytes));
    bytes
}

/// Writes the first `words` words of records as elements of the type `descr`.
pub fn write(
    out: &mut impl Write,
    descr: &str,
    words: usize,
    records: impl ExactSizeIterator<Item: AsRef<[u32]>>,
) -> io::Result<()> {
    let shape = vec![records.len() as u64, words as u64];
    out.write_all(&Header { descr: descr.to_owned(), fortran_order: false, shape }.bytes())?;
    for record in records {
        for word in &record.as_ref()[..words] {
            out.write_all(&word.to_le_bytes())?;
        }
    }
    Ok(())
}
