//! Errors of files: one line that names file, line and field.

use std::io;
use std::path::{Path, PathBuf};

/// Why a file of pairs or contacts could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file name ends in neither .csv nor .npy.
    #[error("{}: the name must end in .csv or .npy", .0.display())]
    Extension(PathBuf),
    /// The file system refused.
    #[error("{}: cannot be {doing}: {source}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// `read` or `written`.
        doing: &'static str,
        /// What the file system said.
        source: io::Error,
    },
    /// A line of a CSV file is wrong.
    #[error("{}, line {line}: {problem}", file.display())]
    Line {
        /// The file.
        file: PathBuf,
        /// The line, counted from 1.
        line: u64,
        /// What is wrong.
        problem: String,
    },
    /// A field of a CSV file is wrong.
    #[error("{}, line {line}, field {field}: {problem}", file.display())]
    Field {
        /// The file.
        file: PathBuf,
        /// The line, counted from 1.
        line: u64,
        /// The name of the column.
        field: &'static str,
        /// What is wrong.
        problem: String,
    },
    /// The header of an npy file is wrong, or the amount of data does not match it.
    #[error("{}, {field}: {problem}", file.display())]
    Npy {
        /// The file.
        file: PathBuf,
        /// The part of the header (`descr`, `fortran_order`, `shape`), or `data`.
        field: &'static str,
        /// What is wrong.
        problem: String,
    },
}

impl FileError {
    /// For `map_err`: the file system refused to have `file` read.
    pub(super) fn reading(file: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { file: file.to_owned(), doing: "read", source }
    }

    /// For `map_err`: the file system refused to have `file` written.
    pub(super) fn writing(file: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { file: file.to_owned(), doing: "written", source }
    }
}
