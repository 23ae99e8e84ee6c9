//! Errors on the way from Verilog to a model.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why no model was built. (Not derived with thiserror, because build.rs shares this file and has few dependencies.)
#[derive(Debug)]
pub enum Error {
    /// A program that is needed is missing, or too old.
    MissingTool {
        /// Its name.
        name: String,
        /// What was found instead.
        found: String,
        /// The command that installs it.
        install: String,
    },
    /// Verilator refused the Verilog.
    Refused {
        /// The top module.
        top: String,
        /// Verilator's messages.
        text: String,
    },
    /// The C++ compiler or linker failed.
    Compile {
        /// The file it was working on.
        what: String,
        /// Its messages.
        text: String,
    },
    /// A file list cannot be used.
    FileList {
        /// The list.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// Verilator's output is not as expected.
    Unexpected {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A file or folder could not be read or written, or a program could not be run.
    Io {
        /// The verb: read, write, create, run.
        action: &'static str,
        /// The path.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
}

impl Error {
    pub(super) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io { action, path: path.to_owned(), source }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MissingTool { name, found, install } => {
                write!(f, "{name} is missing ({found}); install it: {install}")
            }
            Self::Refused { top, text } => write!(f, "Verilator refused {top}:\n{text}"),
            Self::Compile { what, text } => write!(f, "the C++ compiler failed on {what}:\n{text}"),
            Self::FileList { path, what } => write!(f, "{}: {what}", path.display()),
            Self::Unexpected { path, what } => write!(f, "{}: {what} (an unsupported Verilator?)", path.display()),
            Self::Io { action, path, source } => write!(f, "cannot {action} {}: {source}", path.display()),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}
