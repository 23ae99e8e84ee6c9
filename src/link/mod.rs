//! A simulated link between an AFU's line port and memory: how late, in what order, how fast, with which faults.
//!
//! [`LinkModel`] is data, in cycles; [`Physical`] is data in nanoseconds, each figure with its source, which a clock
//! turns into the former. [`Link`] is a model at work on a [`Memory`], one function call a clock cycle, the same for
//! the same seed. Nothing here knows Verilator: a test can drive a link by hand. Imports nothing of ours.

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
pub use model::{LinkError, LinkModel, MAX_OUTSTANDING, SessionCost};
pub use physical::{Joint, OrderName, Physical, PhysicalDirection, PhysicalSession};
