//! Errors that end a simulation behind AXI4.

use crate::cosim::error::SimulationError;
use crate::link::LinkError;
use crate::link::axi::AxiError;

/// Why a simulation behind AXI4 ended.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MachineError {
    /// The model's ports do not fit, or the model stopped the simulation.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The link's model holds a value outside its range.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The AFU broke a rule of AXI4 or AXI4-Lite.
    #[error("protocol broken in cycle {cycle}: {what}")]
    Protocol {
        /// The cycle, counted from the start of the machine.
        cycle: u64,
        /// The violation.
        what: AxiError,
    },
    /// A register's access has no response.
    #[error("no response to a {what} of register {offset:#04x} after {cycles} cycles")]
    NoResponse {
        /// Read or write.
        what: &'static str,
        /// The register's byte offset.
        offset: u32,
        /// The cycles.
        cycles: u64,
    },
}
