//! Errors that end a simulation below SPL2.

use crate::cosim::error::SimulationError;
use crate::link::spl2::Spl2Error;

/// Why a simulation below SPL2 ended.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MachineError {
    /// The model's ports do not fit, or the model stopped the simulation.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The AFU broke the port's protocol.
    #[error("protocol broken in cycle {cycle}: {what}")]
    Protocol {
        /// The cycle, counted from the start of the machine.
        cycle: u64,
        /// The violation.
        what: Spl2Error,
    },
}
