//! A simulated link between an AFU's line port and memory: its latency, order, bandwidth and faults.
//!
//! [`LinkModel`] describes a link in cycles. [`Physical`] describes one in nanoseconds, each figure with its source,
//! and becomes a [`LinkModel`] at a clock. [`Link`] runs a model on a [`Memory`], one function call per clock cycle,
//! and gives the same result for the same seed. Nothing here depends on Verilator, so a test can drive a link by hand.
//! This module imports nothing of ours.

#[cfg(feature = "cosim")]
pub mod axi;
mod cycle;
mod description;
mod direction;
mod fault;
mod figure;
mod memory;
mod model;
mod pace;
mod physical;
mod queue;
mod regulator;
pub mod spl2;

pub use cycle::{Link, ReadRequest, ReadResponse, Replies, Requests, Traffic, WriteRequest, WriteResponse};
pub use description::{Description, NAMES};
pub use direction::{Direction, Order, Shape, Stalls, Stragglers};
pub use fault::Fault;
pub use figure::Figure;
pub use memory::{LINE_BYTES, Line, Memory, Violation};
pub use model::{LinkError, LinkModel, SessionCost, USUAL_IN_FLIGHT};
pub use physical::{Joint, OrderName, Physical, PhysicalDirection, PhysicalSession};
