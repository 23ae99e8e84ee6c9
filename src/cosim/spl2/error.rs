//! What ends a simulation below SPL2.

use crate::cosim::error::SimulationError;
use crate::link::spl2::Spl2Error;

/// What ends a simulation below SPL2.
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
}
