//! Reading and writing by file name.

use super::columns::{Columns, Words};
use super::{FileError, Set, SetError, array, contacts_csv, npy, pairs_csv};
use crate::files;
use crate::query::{CONTACT_WORDS, ContactRecord, PairRecord, Query};
use std::fmt;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

const NUMBER_TYPE: &str = "<f4";
/// Words of a contact with its pair's number.
const HIT_WORDS: usize = CONTACT_WORDS + 1;
/// Words of a contact with the numbers of its two spheres.
const TOUCHING_WORDS: usize = CONTACT_WORDS + 2;
const CONTACT_TYPE: &str = "<u4";

/// The formats a file can have.
enum Kind {
    Csv,
    Npy,
}

fn kind(file: &Path) -> Result<Kind, FileError> {
    match file.extension().and_then(|extension| extension.to_str()) {
        Some(extension) if extension.eq_ignore_ascii_case("csv") => Ok(Kind::Csv),
        Some(extension) if extension.eq_ignore_ascii_case("npy") => Ok(Kind::Npy),
        _ => Err(FileError::Extension(file.to_owned())),
    }
}

/// Pairs, and what reading them changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The pairs.
    pub pairs: Vec<PairRecord>,
    /// The numbers that were rounded; `None` if all were representable.
    pub rounded: Option<Rounded>,
}

/// Numbers of a file that binary32 does not have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded {
    /// The number of rounded numbers.
    pub numbers: u64,
    /// The number of numbers in the file.
    pub of: u64,
    /// `pair` or `sphere`.
    pub record: &'static str,
    /// The number of the first such record.
    pub index: u64,
    /// The field of the record.
    pub field: &'static str,
    /// Its value in the file.
    pub given: f64,
    /// The nearest binary32 number.
    pub taken: f32,
}

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { numbers, of, record, index, field, given, taken } = *self;
        let taken = f64::from(taken);
        let was = if numbers == 1 { "was" } else { "were" };
        write!(f, "{numbers} of {of} numbers {was} rounded to binary32; ")?;
        write!(f, "the first is {field} of {record} {index}: {given} became {taken}")
    }
}

/// Why pairs could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// A set's name is wrong.
    #[error(transparent)]
    Set(#[from] SetError),
    /// A file is wrong.
    #[error(transparent)]
    File(#[from] FileError),
}

/// The pairs of a named set (`diamond:10`, `random:1000` with `seed`) or of a file.
///
/// # Errors
/// Returns an error if the name or the file is wrong.
pub fn load(query: Query, source: &str, seed: u64) -> Result<Vec<PairRecord>, LoadError> {
    load_with_notes(query, source, seed).map(|loaded| loaded.pairs)
}

/// Loads pairs, and reports what reading a file changed.
///
/// # Errors
/// Returns the errors of [`load`].
pub fn load_with_notes(query: Query, source: &str, seed: u64) -> Result<Loaded, LoadError> {
    let path = Path::new(source);
    if Set::is_name(source) || (Set::meant(source).is_some() && !path.exists()) {
        return Ok(Loaded { pairs: source.parse::<Set>()?.pairs_of(query, seed)?, rounded: None });
    }
    Ok(read_with_notes(query, path)?)
}

/// Whether `file` has a name that can be written: `.csv` or `.npy`.
///
/// # Errors
/// Returns an error if the name has another ending.
pub fn check_name(file: &Path) -> Result<(), FileError> {
    kind(file).map(drop)
}

/// The pairs of a `.csv` or `.npy` file.
///
/// # Errors
/// Returns an error if the file cannot be read or is not of that form.
pub fn read_pairs(query: Query, file: &Path) -> Result<Vec<PairRecord>, FileError> {
    read_with_notes(query, file).map(|loaded| loaded.pairs)
}

/// The same, with what reading changed. (Decimals in CSV are always taken as the nearest binary32 number.)
///
/// # Errors
/// Returns the errors of [`read_pairs`].
pub fn read_with_notes(query: Query, file: &Path) -> Result<Loaded, FileError> {
    let (pairs, rounded) = read_records(Columns::of(query), file)?;
    Ok(Loaded { pairs: pairs.into_iter().map(PairRecord).collect(), rounded })
}

/// The records of a `.csv` or `.npy` file, and which numbers were rounded.
pub(crate) fn read_records(columns: Columns, file: &Path) -> Result<(Vec<Words>, Option<Rounded>), FileError> {
    match kind(file)? {
        Kind::Csv => Ok((pairs_csv::read(columns, file, &bytes(file)?)?, None)),
        Kind::Npy => array::read(columns, file, &bytes(file)?),
    }
}

/// The contacts of a `.csv` or `.npy` file.
///
/// # Errors
/// Returns an error if the file cannot be read or is not of that form.
pub fn read_contacts(file: &Path) -> Result<Vec<ContactRecord>, FileError> {
    match kind(file)? {
        Kind::Csv => contacts_csv::read(file, &bytes(file)?),
        Kind::Npy => {
            Ok(npy::read::<CONTACT_WORDS>(file, &bytes(file)?, CONTACT_TYPE)?.into_iter().map(ContactRecord).collect())
        }
    }
}

/// The contacts of a `.csv` or `.npy` file that has only some pairs', each with its pair's number.
///
/// # Errors
/// Returns the errors of [`read_contacts`], and an error if the numbers do not increase.
pub fn read_hits(file: &Path) -> Result<Vec<(u32, ContactRecord)>, FileError> {
    match kind(file)? {
        Kind::Csv => contacts_csv::read_hits(file, &bytes(file)?),
        Kind::Npy => {
            let records: Vec<[u32; HIT_WORDS]> = npy::read(file, &bytes(file)?, CONTACT_TYPE)?;
            if let Some(wrong) = records.windows(2).position(|two| two[0][0] >= two[1][0]) {
                let problem = format!(
                    "expected increasing pair numbers, found {} after {}",
                    records[wrong + 1][0],
                    records[wrong][0]
                );
                return Err(FileError::Npy { file: file.to_owned(), field: "data", problem });
            }
            let hit = |[number, contact @ ..]: [u32; HIT_WORDS]| (number, ContactRecord(contact));
            Ok(records.into_iter().map(hit).collect())
        }
    }
}

/// Writes pairs to a `.csv` or `.npy` file, which is there whole or not at all.
///
/// # Errors
/// Returns an error if the name has another ending or the file cannot be written.
pub fn write_pairs(query: Query, file: &Path, pairs: &[PairRecord]) -> Result<(), FileError> {
    write_records(Columns::of(query), file, pairs.iter().map(|pair| pair.0))
}

/// Writes records to a `.csv` or `.npy` file, which is there whole or not at all.
pub(crate) fn write_records(
    columns: Columns,
    file: &Path,
    records: impl ExactSizeIterator<Item = Words>,
) -> Result<(), FileError> {
    match kind(file)? {
        Kind::Csv => write(file, |out| pairs_csv::write(out, columns, records)),
        Kind::Npy => write(file, |mut out| npy::write(&mut out, NUMBER_TYPE, columns.len(), records)),
    }
}

/// Writes pairs as CSV.
///
/// # Errors
/// Returns the errors of `out`.
pub fn write_pairs_csv(out: impl Write, query: Query, pairs: &[PairRecord]) -> io::Result<()> {
    pairs_csv::write(out, Columns::of(query), pairs.iter().map(|pair| pair.0))
}

/// Writes contacts to a `.csv` or `.npy` file, which is there whole or not at all.
///
/// # Errors
/// Returns an error if the name has another ending or the file cannot be written.
pub fn write_contacts(file: &Path, contacts: &[ContactRecord]) -> Result<(), FileError> {
    match kind(file)? {
        Kind::Csv => write(file, |out| contacts_csv::write(out, (0..).zip(contacts.iter().copied()))),
        Kind::Npy => write(file, |mut out| {
            npy::write(&mut out, CONTACT_TYPE, CONTACT_WORDS, contacts.iter().map(|contact| contact.0))
        }),
    }
}

/// Writes some pairs' contacts, in the order of the pairs' numbers, to a `.csv` or `.npy` file, which is there whole or
/// not at all. In CSV each row names its pair; in npy the number is the first of nine words.
///
/// # Errors
/// Returns the errors of [`write_contacts`].
pub fn write_hits(file: &Path, hits: &[(u32, ContactRecord)]) -> Result<(), FileError> {
    let words = |(number, contact): &(u32, ContactRecord)| {
        let mut words = [*number; HIT_WORDS];
        words[1..].copy_from_slice(&contact.0);
        words
    };
    match kind(file)? {
        Kind::Csv => write(file, |out| contacts_csv::write(out, hits.iter().copied())),
        Kind::Npy => write(file, |mut out| npy::write(&mut out, CONTACT_TYPE, HIT_WORDS, hits.iter().map(words))),
    }
}

/// Writes spheres that touch to a `.csv` or `.npy` file, which is there whole or not at all. In CSV a row begins with
/// the numbers of the two spheres; in npy these are the first two of ten words.
pub(crate) fn write_touching(file: &Path, touching: &[([u32; 2], ContactRecord)]) -> Result<(), FileError> {
    let words = |([first, second], contact): &([u32; 2], ContactRecord)| {
        let mut words = [*first; TOUCHING_WORDS];
        words[1] = *second;
        words[2..].copy_from_slice(&contact.0);
        words
    };
    match kind(file)? {
        Kind::Csv => write(file, |out| contacts_csv::write_touching(out, touching.iter().copied())),
        Kind::Npy => {
            write(file, |mut out| npy::write(&mut out, CONTACT_TYPE, TOUCHING_WORDS, touching.iter().map(words)))
        }
    }
}

fn bytes(file: &Path) -> Result<Vec<u8>, FileError> {
    fs::read(file).map_err(FileError::reading(file))
}

fn write(file: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
    files::replace(file, content).map_err(FileError::writing(file))
}
