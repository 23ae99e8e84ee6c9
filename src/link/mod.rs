//! A simulated link between an AFU's line port and memory: how late, in what order, how fast, with which faults.
//!
//! [`LinkModel`] is data; [`Link`] is that data at work on a [`Memory`], one function call a clock cycle, the same for
//! the same seed. Nothing here knows Verilator: a test can drive a link by hand. Imports nothing of ours.

mod cycle;
mod fault;
mod memory;
mod model;
mod queue;
mod regulator;
pub mod spl2;

pub use cycle::{Link, ReadRequest, ReadResponse, Replies, Requests, Traffic, WriteRequest, WriteResponse};
pub use fault::Fault;
pub use memory::{LINE_BYTES, Line, Memory, Violation};
pub use model::{Direction, LinkError, LinkModel, MAX_OUTSTANDING, Order, Stalls, Stragglers};
