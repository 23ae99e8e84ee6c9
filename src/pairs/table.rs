//! A CSV file with known columns.

use super::{FileError, cure};
use std::path::Path;

/// A row: its place in the file's text, and its fields in the order of the requested columns.
pub struct Row<'a> {
    file: &'a Path,
    text: &'a [u8],
    begin: u64,
    columns: &'a [&'static str],
    fields: &'a [&'a str],
}

/// Reads a file whose header names exactly `columns`, in any order, and gives each row to `take`.
pub fn read(
    file: &Path,
    text: &[u8],
    columns: &[&'static str],
    mut take: impl FnMut(Row<'_>) -> Result<(), FileError>,
) -> Result<(), FileError> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(text);
    let mut record = csv::StringRecord::new();
    if !reader.read_record(&mut record).map_err(|error| broken(file, text, error))? {
        let problem = format!("the file is empty; it must begin with the header {}", columns.join(","));
        return Err(FileError::Line { file: file.to_owned(), line: 1, problem });
    }
    let places = header(file, text, columns, &record)?;
    let expected = columns.len();
    while reader.read_record(&mut record).map_err(|error| broken(file, text, error))? {
        let begin = record.position().map_or(0, csv::Position::byte);
        let line = || line_at(text, begin);
        if let Some(problem) = cure::of_row(&record).filter(|_| record.len() != expected) {
            return Err(FileError::Line { file: file.to_owned(), line: line(), problem });
        }
        if record.len() > expected {
            let problem = format!("expected {expected} fields, as in the header, found {}", record.len());
            return Err(FileError::Line { file: file.to_owned(), line: line(), problem });
        }
        let mut fields = vec![""; expected];
        for (i, &place) in places.iter().enumerate() {
            let missing = || FileError::Field {
                file: file.to_owned(),
                line: line(),
                field: columns[i],
                problem: format!("missing: the line has {} of {expected} fields", record.len()),
            };
            fields[i] = record.get(place).ok_or_else(missing)?;
        }
        take(Row { file, text, begin, columns, fields: &fields })?;
    }
    Ok(())
}

/// The position of each column.
fn header(
    file: &Path,
    text: &[u8],
    columns: &[&'static str],
    record: &csv::StringRecord,
) -> Result<Vec<usize>, FileError> {
    let line = line_at(text, record.position().map_or(0, csv::Position::byte));
    let known = |name: &str| columns.contains(&name);
    if let Some(unknown) = record.iter().find(|name| !known(name)) {
        let problem = cure::of_header(record, columns)
            .unwrap_or_else(|| format!("unknown column `{unknown}`: expected the header {}", columns.join(",")));
        return Err(FileError::Line { file: file.to_owned(), line, problem });
    }
    let mut places = vec![0; columns.len()];
    for (place, &field) in places.iter_mut().zip(columns) {
        let mut found = record.iter().enumerate().filter(|(_, name)| *name == field);
        let problem = match (found.next(), found.next()) {
            (Some((i, _)), None) => {
                *place = i;
                continue;
            }
            (None, _) => "the header has no such column",
            (Some(_), Some(_)) => "the header has this column twice",
        };
        return Err(FileError::Field { file: file.to_owned(), line, field, problem: problem.to_owned() });
    }
    Ok(places)
}

/// The error of the CSV reader itself, for text that is not UTF-8.
fn broken(file: &Path, text: &[u8], error: csv::Error) -> FileError {
    let line = line_at(text, error.position().map_or(0, csv::Position::byte));
    let problem = match error.kind() {
        csv::ErrorKind::Utf8 { .. } => "expected text in UTF-8".to_owned(),
        _ => format!("not CSV: {error}"),
    };
    FileError::Line { file: file.to_owned(), line, problem }
}

/// The line, from 1, of the row that begins at `begin`. (The reader's own count is too low by the empty lines before a
/// row. The second half of a CR LF counts as an empty line.)
fn line_at(text: &[u8], begin: u64) -> u64 {
    let (before, rest) = text.split_at((begin as usize).min(text.len()));
    let empty = rest.iter().take_while(|byte| matches!(byte, b'\r' | b'\n'));
    1 + before.iter().chain(empty).filter(|&&byte| byte == b'\n').count() as u64
}

impl Row<'_> {
    /// The text of column `i`.
    pub fn text(&self, i: usize) -> &str {
        self.fields[i]
    }

    /// An error in column `i`.
    pub fn error(&self, i: usize, problem: String) -> FileError {
        FileError::Field {
            file: self.file.to_owned(),
            line: line_at(self.text, self.begin),
            field: self.columns[i],
            problem,
        }
    }

    /// Column `i` as the binary32 number nearest to its decimals. NaN and infinities can be written as such. A decimal
    /// beyond the largest number is an error.
    pub fn number(&self, i: usize) -> Result<f32, FileError> {
        let text = self.text(i);
        let value = text.parse::<f32>().map_err(|_| self.error(i, cure::of_number(text)))?;
        if value.is_infinite() && text.contains(|c: char| c.is_ascii_digit()) {
            return Err(self.error(i, format!("`{text}` is beyond the largest binary32 number")));
        }
        Ok(value)
    }
}

/// The shortest decimals that read back as `value`.
pub fn decimal(value: f32) -> String {
    let mut text = format!("{value:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
    text
}
