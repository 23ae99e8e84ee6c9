//! Arrays of pairs, or of spheres, as NumPy's users have them: of binary16, binary32 or binary64, in either byte order
//! and either order of indices: n × 8, or n × 2 × 4 if both bodies of a pair have the same shape; n × 4 for spheres.

use std::path::Path;

use super::columns::{Columns, Words};
use super::npy_header::{Header, Problem};
use super::{FileError, Rounded};
use crate::count::counted;
use crate::kernel::widen;
use crate::number::Format;

/// The records of an array, and which numbers had to be rounded to binary32.
pub fn read(columns: Columns, file: &Path, bytes: &[u8]) -> Result<(Vec<Words>, Option<Rounded>), FileError> {
    parse(columns, bytes).map_err(|Problem(field, problem)| FileError::Npy { file: file.to_owned(), field, problem })
}

fn parse(columns: Columns, bytes: &[u8]) -> Result<(Vec<Words>, Option<Rounded>), Problem> {
    let (header, data) = Header::split(bytes)?;
    let number = Number::of(&header.descr)?;
    // In C order the words of a record stand together either way; in Fortran order each word of all records does.
    let words = columns.len();
    let (count, rows) = match *header.shape.as_slice() {
        [count, of] if of == words as u64 => (count, 1),
        [count, 2, of] if columns.bodies == 2 && 2 * of == words as u64 => (count, 2),
        _ => {
            let split = if columns.bodies == 2 { format!(" or [n, 2, {}]", words / 2) } else { String::new() };
            return Err(Problem("shape", format!("expected [n, {words}]{split}, found {:?}", header.shape)));
        }
    };
    let fortran_place = |word: usize| word / (words / rows) + rows * (word % (words / rows));
    // The shape is accepted only if the length of the file agrees with it.
    let (size, there) = (number.size(), data.len());
    if count.checked_mul((words * size) as u64) != Some(there as u64) {
        let problem =
            format!("expected {} of {} bytes, found {there} bytes of data", counted(count, "record"), words * size);
        return Err(Problem("shape", problem));
    }
    let count = there / (words * size);
    let mut records = Vec::with_capacity(count);
    let mut rounded: Option<Rounded> = None;
    for index in 0..count {
        let mut record = Words::default();
        for (word, (field, to)) in columns.names().zip(&mut record).enumerate() {
            let place = if header.fortran_order { fortran_place(word) * count + index } else { words * index + word };
            let bits = number.bits(&data[place * size..(place + 1) * size]);
            *to = number.to_binary32(bits);
            if let Some(given) = number.rounded(bits, *to) {
                let is_beyond = given.is_finite() && f32::from_bits(*to).is_infinite();
                if is_beyond {
                    let name = columns.record;
                    let problem =
                        format!("{given:e}, {field} of {name} {index}, is beyond the largest binary32 number");
                    return Err(Problem("data", problem));
                }
                let first = Rounded {
                    numbers: 0,
                    of: (words * count) as u64,
                    record: columns.record,
                    index: index as u64,
                    field,
                    given,
                    taken: f32::from_bits(*to),
                };
                rounded.get_or_insert(first).numbers += 1;
            }
        }
        records.push(record);
    }
    Ok((records, rounded))
}

/// The numbers of an array.
struct Number {
    format: Format,
    is_big_endian: bool,
}

impl Number {
    fn of(descr: &str) -> Result<Self, Problem> {
        let format = match descr.get(1..) {
            Some("f2") => Some(Format::HALF),
            Some("f4") => Some(Format::BINARY32),
            Some("f8") => Some(Format::BINARY64),
            _ => None,
        };
        let is_big_endian = descr.starts_with('>');
        match format {
            Some(format) if is_big_endian || descr.starts_with('<') => Ok(Self { format, is_big_endian }),
            _ => Err(Problem("descr", format!("expected f2, f4 or f8, found '{descr}'; save a.astype(\"<f4\")"))),
        }
    }

    fn size(&self) -> usize {
        self.format.width() as usize / 8
    }

    fn bits(&self, bytes: &[u8]) -> u64 {
        let join = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        if self.is_big_endian { bytes.iter().fold(0, join) } else { bytes.iter().rev().fold(0, join) }
    }

    /// The nearest binary32 number.
    fn to_binary32(&self, bits: u64) -> u32 {
        match self.size() {
            8 => (f64::from_bits(bits) as f32).to_bits(),
            _ => widen(bits as u32, self.format),
        }
    }

    /// The value of `bits`, if binary32 does not have it.
    fn rounded(&self, bits: u64, binary32: u32) -> Option<f64> {
        let value = Some(f64::from_bits(bits)).filter(|_| self.size() == 8)?;
        (!value.is_nan() && value != f64::from(f32::from_bits(binary32))).then_some(value)
    }
}
