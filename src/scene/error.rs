//! What can be wrong with a scene.

/// Why there is no scene, or no run of it.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A value that makes no sense, at its line.
    #[error("{file}:{line}: {key}: {why}")]
    Value {
        /// The scene's file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The key.
        key: String,
        /// What is wrong, and what to do.
        why: String,
    },
    /// Not TOML, or not of a scene's form.
    #[error("{file}:{line}: {why}")]
    Form {
        /// The scene's file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// What TOML's reader says.
        why: String,
    },
    /// A file that cannot be read.
    #[error("{file}: {error}")]
    Read {
        /// The file.
        file: String,
        /// What the file system says.
        error: std::io::Error,
    },
    /// An effect that is not one, as `--with` and `--without` have it.
    #[error("no effect is called `{0}`: use {1}")]
    Effect(String, String),
    /// The AFU that the scene calls for cannot be made.
    #[error(transparent)]
    Afu(#[from] crate::afu::BuildError),
    /// Yosys.
    #[error(transparent)]
    Synth(#[from] crate::synth::SynthError),
    /// ODE.
    #[cfg(feature = "ode")]
    #[error(transparent)]
    Ode(#[from] crate::ode::Error),
    /// What computes the contacts.
    #[error("the contacts: {0}")]
    Engine(#[source] crate::kernel::EngineError),
}
