//! Errors of a measurement.

use std::io;
use std::path::{Path, PathBuf};

use crate::afu::BuildError;
use crate::files;
use crate::hdl::BuildErrors;
use crate::store::StoreError;
use crate::tools::MissingTool;

/// Why a unit could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum SynthError {
    /// A required program is missing.
    #[error(transparent)]
    MissingTool(#[from] MissingTool),
    /// The AFU could not be generated.
    #[error(transparent)]
    Generate(#[from] BuildError),
    /// The unit or its wrapper is faulty, because of a mistake of the generator or a clock that is impossible.
    #[error("the hardware is faulty:\n{0}")]
    Hardware(#[from] BuildErrors),
    /// A program failed, with its last messages.
    #[error("{program} failed on {unit}:\n{text}")]
    Failed {
        /// The program.
        program: String,
        /// The unit that it was working on.
        unit: String,
        /// Its messages.
        text: String,
    },
    /// The output of a program could not be read.
    #[error("unexpected output of {program} for {unit}: {what}")]
    Unexpected {
        /// The program.
        program: String,
        /// The unit that it was working on.
        unit: String,
        /// What is wrong.
        what: String,
    },
    /// A file or folder could not be read or written, or a program could not be run.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The verb: read, write, create, run.
        action: &'static str,
        /// The path.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// Netlists and routes cannot be stored.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl SynthError {
    /// True if only this unit failed: it cannot be generated, or a program failed on it. False if other units would
    /// fail as well: a program is missing, or the disk is full.
    pub fn is_of_unit(&self) -> bool {
        match self {
            Self::Generate(_) | Self::Hardware(_) | Self::Failed { .. } | Self::Unexpected { .. } => true,
            Self::MissingTool(_) | Self::Io { .. } | Self::Store(_) => false,
        }
    }

    pub(super) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io { action, path: path.to_owned(), source: files::without_path(source) }
    }
}
