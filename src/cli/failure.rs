//! How the program ends: one line on standard error and an exit code that scripts can tell apart.

use std::process::ExitCode;

/// What kind of end it was. The numbers are part of the command line's contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A mismatch, a failed check, or a job that does not finish.
    Failed = 1,
    /// Bad usage or bad input.
    Usage = 2,
    /// A tool that this needs is missing.
    Tool = 3,
    /// Anything else.
    Other = 4,
    /// The rest of a study needs points of other shards.
    #[cfg(feature = "cosim")]
    Waiting = 5,
}

/// An error and what kind of end it makes.
#[derive(Debug)]
pub struct Failure {
    kind: Kind,
    error: anyhow::Error,
}

impl Failure {
    /// Of a kind, with a message.
    pub fn new(kind: Kind, message: impl std::fmt::Display) -> Self {
        Self { kind, error: anyhow::anyhow!("{message}") }
    }

    /// Of a kind, with the error that made it.
    pub fn caused(kind: Kind, error: impl Into<anyhow::Error>) -> Self {
        Self { kind, error: error.into() }
    }

    /// Says it on standard error, and gives the exit code.
    pub fn report(&self) -> ExitCode {
        eprintln!("afu: {}", self.text());
        ExitCode::from(self.kind as u8)
    }

    /// The error and its causes. A cause that the message before it tells already is not told again.
    fn text(&self) -> String {
        let mut text = String::new();
        for cause in self.error.chain().map(ToString::to_string) {
            if text.is_empty() {
                text = cause;
            } else if !text.contains(&cause) {
                text = format!("{text}: {cause}");
            }
        }
        text
    }
}

/// Gives the error of a result its kind, at the edge where that is known.
pub trait Classify<T> {
    /// The same, with the error being of this kind.
    fn ends(self, kind: Kind) -> Result<T, Failure>;
}

impl<T, E: Into<anyhow::Error>> Classify<T> for Result<T, E> {
    fn ends(self, kind: Kind) -> Result<T, Failure> {
        self.map_err(|error| Failure::caused(kind, error))
    }
}

impl From<contact_afu::config::Error> for Failure {
    fn from(error: contact_afu::config::Error) -> Self {
        Self::caused(Kind::Usage, error)
    }
}

impl From<contact_afu::report::folder::Error> for Failure {
    fn from(error: contact_afu::report::folder::Error) -> Self {
        use contact_afu::report::folder::Error::{Foreign, Io, NotAFolder, Other, Path, Text};
        let kind = match error {
            Foreign(_) | NotAFolder(_) | Other { .. } => Kind::Usage,
            Path(_) | Io { .. } | Text { .. } => Kind::Other,
        };
        Self::caused(kind, error)
    }
}

#[cfg(feature = "cosim")]
impl From<contact_afu::verify::VerifyError> for Failure {
    fn from(error: contact_afu::verify::VerifyError) -> Self {
        use contact_afu::cosim::CosimError;
        use contact_afu::verify::VerifyError;
        let kind = match error {
            VerifyError::Generate(error) => return error.into(),
            VerifyError::Reference(_) => Kind::Other,
            VerifyError::Manifest(_)
            | VerifyError::Link(_)
            | VerifyError::Pairs(_)
            | VerifyError::Radius(_)
            | VerifyError::Set(_)
            | VerifyError::Tile(_)
            | VerifyError::Search(_) => Kind::Usage,
            VerifyError::Model(CosimError::MissingTool { .. }) => Kind::Tool,
            VerifyError::Model(CosimError::Source(_)) => Kind::Usage,
            VerifyError::Drive(_) | VerifyError::Host(_) if error.is_job_failure() => Kind::Failed,
            VerifyError::Model(_) | VerifyError::Drive(_) | VerifyError::Host(_) => Kind::Other,
        };
        Self::caused(kind, error)
    }
}
