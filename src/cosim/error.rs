//! Errors of models.

use std::path::PathBuf;

use super::verilate;

/// Why there is no model or no instance, or why a simulation ended.
#[derive(Debug, thiserror::Error)]
pub enum CosimError {
    /// Verilator or the C++ compiler is missing.
    #[error("{name} is missing ({found}); install it with: {install}")]
    MissingTool {
        /// The tool.
        name: String,
        /// What was found instead.
        found: String,
        /// The command that installs it.
        install: String,
    },
    /// The model could not be built.
    #[error(transparent)]
    Build(verilate::Error),
    /// The built library could not be loaded.
    #[error("cannot load the model {}: {why}", path.display())]
    Load {
        /// The library.
        path: PathBuf,
        /// Why.
        why: String,
    },
    /// The source cannot be built.
    #[error("{0}")]
    Source(String),
    /// There is no folder for built models.
    #[error("no folder for built models: set AFU_CACHE, XDG_CACHE_HOME or HOME")]
    NoCache,
    /// The simulation failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

impl From<verilate::Error> for CosimError {
    fn from(error: verilate::Error) -> Self {
        match error {
            verilate::Error::MissingTool { name, found, install } => Self::MissingTool { name, found, install },
            other => Self::Build(other),
        }
    }
}

/// Why an instance could not do something.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SimulationError {
    /// The model stopped the simulation: `$fatal`, `$stop`, `$finish` or a check of Verilator's.
    #[error("the simulated AFU stopped: {0}")]
    Stopped(String),
    /// A port is missing, or has another direction or width.
    #[error("port `{name}`: expected {expected}, found {found} in the model")]
    Port {
        /// The port.
        name: String,
        /// The direction and width that were expected.
        expected: String,
        /// The port that was found.
        found: String,
    },
    /// A waveform could not be opened, written or closed.
    #[error("waveform {}: {why}", path.display())]
    Waveform {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
}
