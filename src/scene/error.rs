//! Errors of scenes.

/// Why a scene is invalid or cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The value in this line is invalid.
    #[error("{file}:{line}: {key}: {why}")]
    Value {
        /// The scene's file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The key.
        key: String,
        /// The error, and what to do.
        why: String,
    },
    /// The file is not TOML, or has not the form of a scene.
    #[error("{file}:{line}: {why}")]
    Form {
        /// The scene's file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The message of the TOML reader.
        why: String,
    },
    /// The file cannot be read.
    #[error("{file}: {error}")]
    Read {
        /// The file.
        file: String,
        /// The error of the file system.
        error: std::io::Error,
    },
    /// `--with` or `--without` names an unknown effect.
    #[error("no effect is called `{0}`: use {1}")]
    Effect(String, String),
    /// The AFU that the scene calls for cannot be generated.
    #[error(transparent)]
    Afu(#[from] crate::afu::BuildError),
    /// The cycle model has no prediction.
    #[error(transparent)]
    Predict(#[from] crate::afu::PredictError),
    /// Yosys failed.
    #[error(transparent)]
    Synth(#[from] crate::synth::SynthError),
    /// ODE failed.
    #[cfg(feature = "ode")]
    #[error(transparent)]
    Ode(#[from] crate::ode::Error),
    /// The engine that computes the contacts failed.
    #[error("the contacts: {0}")]
    Engine(#[source] crate::kernel::EngineError),
}
