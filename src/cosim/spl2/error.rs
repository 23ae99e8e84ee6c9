//! Why a transaction has no outcome.

use crate::afu::shell::spl2::map;
use crate::cosim::error::SimulationError;
use crate::link::spl2::Spl2Error;

/// Why a transaction has no outcome.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MachineError {
    /// The model's ports do not fit, or it ended itself.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The AFU broke the port's protocol.
    #[error("protocol broken in cycle {cycle}: {what}")]
    Protocol {
        /// The cycle, counted from the machine's first.
        cycle: u64,
        /// How.
        what: Spl2Error,
    },
    /// No AFU_ID came.
    #[error("no AFU_ID in the DSM after {0} cycles")]
    Silent(u64),
    /// Another AFU, or another version of this one.
    #[error("AFU_ID {afu_id:032x} version {version}: expected {:032x} version {}", map::AFU_ID, map::VERSION)]
    Identity {
        /// Which it is.
        afu_id: u128,
        /// And of which version.
        version: u32,
    },
    /// Another number of SCPUs.
    #[error("expected an AFU of {expected} SCPUs, this one has {found}")]
    Scpus {
        /// As the job wants it.
        expected: u32,
        /// As the AFU says.
        found: u32,
    },
    /// The buffers lie outside of the workspace, or over each other.
    #[error("the workspace: {0}")]
    Workspace(&'static str),
    /// The status never came.
    #[error(
        "the job did not finish after {cycles} cycles: no status, waiting for {} ({} reads and {} writes without a response)",
        if *in_flight == (0, 0) { "the AFU" } else { "the link" }, in_flight.0, in_flight.1
    )]
    NoStatus {
        /// Cycles since the start word.
        cycles: u64,
        /// Reads and writes without a response.
        in_flight: (usize, usize),
    },
}
