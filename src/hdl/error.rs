//! Errors in building a graph, with names and the place in the generator's source.

use std::fmt;
use std::panic::Location;

/// One bad operation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The module under construction.
    pub module: String,
    /// The error, with the signals concerned.
    pub message: String,
    /// The place of the operation in the generator's source.
    pub place: &'static Location<'static>,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} ({}:{})", self.module, self.message, self.place.file(), self.place.line())
    }
}

/// Every bad operation of a graph, in the order they were made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct BuildErrors(pub Vec<Error>);

impl fmt::Display for BuildErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.0.iter().enumerate() {
            if index > 0 {
                f.write_str("\n")?;
            }
            error.fmt(f)?;
        }
        Ok(())
    }
}
