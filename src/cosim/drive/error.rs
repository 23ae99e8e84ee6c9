//! Errors of a job without outcome.

use std::fmt;

use super::monitor::ProtocolError;
use crate::config::Results;
use crate::cosim::error::SimulationError;

/// Why a job has no outcome.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DriveError {
    /// The model's ports do not fit, or it ended itself.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The AFU broke the line port's protocol.
    #[error("protocol broken in cycle {cycle}: {what}")]
    Protocol {
        /// The cycle, counted from the driver's first.
        cycle: u64,
        /// How.
        what: ProtocolError,
    },
    /// The AFU has another number of SCPUs.
    #[error("expected an AFU with SCPUs = {expected}, found {found}")]
    Scpus {
        /// The value that the job expects.
        expected: u32,
        /// As the AFU says.
        found: u32,
    },
    /// The AFU gives other results than the job expects.
    #[error("expected an AFU with results {expected}, found {found}")]
    OtherResults {
        /// The value that the job expects.
        expected: Results,
        /// As the AFU says.
        found: Results,
    },
    /// The job does not fit in memory.
    #[error("the job does not fit: {0}")]
    Job(&'static str),
    /// A job was started while another runs.
    #[error("the AFU is busy with another job")]
    Busy,
    /// The outcome was requested of a job that is not finished.
    #[error("no job has finished")]
    NotDone,
    /// The job does not end.
    #[error(
        "the job did not finish after {cycles} cycles: waiting for {waiting} ({} of {} requested lines read, {} of {} lines written)",
        reads.1, reads.0, writes.1, writes.0
    )]
    TimedOut {
        /// Cycles since its start.
        cycles: u64,
        /// For what.
        waiting: Waiting,
        /// Lines it asked for, and got.
        reads: (u64, u64),
        /// Lines it sent, and those acknowledged.
        writes: (u64, u64),
    },
}

/// What an unfinished job waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waiting {
    /// The link's response to a request.
    Response {
        /// True for a read.
        is_read: bool,
        /// The tag.
        tag: u16,
        /// Cycles since it was accepted.
        cycles: u64,
    },
    /// The link, to accept a request.
    Ready,
    /// The AFU: the link owes it nothing.
    Afu,
}

impl fmt::Display for Waiting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Response { is_read, tag, cycles } => {
                let what = if *is_read { "the data of a read" } else { "the acknowledgement of a write" };
                write!(f, "{what}, tag {tag:#05x}, asked for {cycles} cycles ago")
            }
            Self::Ready => write!(f, "the link to accept a request"),
            Self::Afu => write!(f, "the AFU, which the link owes nothing"),
        }
    }
}
