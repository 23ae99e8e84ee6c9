//! Errors of a job that has no outcome.

use std::fmt;

use super::monitor::ProtocolError;
use crate::config::Results;
use crate::cosim::error::SimulationError;

/// Why a job has no outcome.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DriveError {
    /// The model's ports do not fit, or the model stopped the simulation.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The AFU broke the line port's protocol.
    #[error("protocol broken in cycle {cycle}: {what}")]
    Protocol {
        /// The cycle, counted from the start of the driver.
        cycle: u64,
        /// The violation.
        what: ProtocolError,
    },
    /// The AFU has another number of SCPUs.
    #[error("expected an AFU with SCPUs = {expected}, found {found}")]
    Scpus {
        /// The value that the job expects.
        expected: u32,
        /// The number that the AFU reports.
        found: u32,
    },
    /// The AFU gives other results than the job expects.
    #[error("expected an AFU with results {expected}, found {found}")]
    OtherResults {
        /// The value that the job expects.
        expected: Results,
        /// The results that the AFU reports.
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
    /// The job does not finish.
    #[error(
        "the job did not finish after {cycles} cycles: waiting for {waiting} ({} of {} requested lines read, {} of {} lines written)",
        reads.1, reads.0, writes.1, writes.0
    )]
    TimedOut {
        /// Cycles since the start of the job.
        cycles: u64,
        /// What the job waits for.
        waiting: Waiting,
        /// Read requests accepted, and answered.
        reads: (u64, u64),
        /// Write requests accepted, and acknowledged.
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
    /// The link accepts a request.
    Ready,
    /// The AFU makes a request. No response is outstanding.
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
