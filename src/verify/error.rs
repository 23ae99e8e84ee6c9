//! Errors of a job that has no verdict.

use crate::afu::BuildError;
use crate::config::ReadError;
use crate::cosim::CosimError;
use crate::cosim::drive::DriveError;
use crate::host::{HostError, TransportError};
use crate::kernel::EngineError;
use crate::link::LinkError;
use crate::record::{OtherRadius, SetTooLarge};
use crate::spheres::{RefusedArithmetic, TileSizeError};

/// Why there is no verdict. (A mismatch is a verdict.)
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// The configuration cannot be generated.
    #[error(transparent)]
    Generate(#[from] BuildError),
    /// The folder's manifest cannot be read.
    #[error(transparent)]
    Manifest(#[from] ReadError),
    /// There is no model: a tool is missing, or it rejected the Verilog.
    #[error(transparent)]
    Model(#[from] CosimError),
    /// The link model is invalid.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The job does not finish, or the AFU broke the line port's protocol.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// The same below SPL2.
    #[error(transparent)]
    Host(#[from] HostError),
    /// A pair has another radius than the AFU's.
    #[error(transparent)]
    Radius(#[from] OtherRadius),
    /// There are more pairs than a job's count can represent.
    #[error("{0} pairs: expected at most 4294967295 in a job")]
    Pairs(usize),
    /// There are more spheres in a set than the AFU takes.
    #[error(transparent)]
    Set(#[from] SetTooLarge),
    /// No tile has this size.
    #[error(transparent)]
    Tile(#[from] TileSizeError),
    /// The arithmetic has no boxes.
    #[error(transparent)]
    Search(#[from] RefusedArithmetic),
    /// The reference could not decide.
    #[error("the reference: {0}")]
    Reference(EngineError),
}

impl VerifyError {
    /// True if this AFU is to blame: it cannot be generated or built, or its job fails. False if others would fail as
    /// well: a tool is missing, the disk is full, or the link or the pairs cannot be used.
    pub fn is_of_afu(&self) -> bool {
        use crate::cosim::verilate::Error::{Compile, Refused, Unexpected};
        match self {
            Self::Generate(_) | Self::Drive(_) | Self::Host(_) => true,
            Self::Model(CosimError::Build(error)) => {
                matches!(error, Refused { .. } | Compile { .. } | Unexpected { .. })
            }
            Self::Model(CosimError::Load { .. } | CosimError::Simulation(_)) => true,
            Self::Model(CosimError::MissingTool { .. } | CosimError::Source(_) | CosimError::NoCache)
            | Self::Manifest(_)
            | Self::Link(_)
            | Self::Radius(_)
            | Self::Pairs(_)
            | Self::Set(_)
            | Self::Tile(_)
            | Self::Search(_)
            | Self::Reference(_) => false,
        }
    }

    /// True if a job that began failed: it does not finish, breaks the protocol, or stops.
    pub fn is_job_failure(&self) -> bool {
        matches!(
            self,
            Self::Drive(DriveError::TimedOut { .. } | DriveError::Protocol { .. })
                | Self::Host(
                    HostError::NoStatus { .. }
                        | HostError::Transport(
                            TransportError::PageFault { .. }
                                | TransportError::Protocol { .. }
                                | TransportError::Axi { .. }
                        )
                )
        )
    }
}
