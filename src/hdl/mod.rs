//! A small typed hardware language: graphs of bit operations, registers, memories and instances.
//!
//! A [`Graph`] is one module under construction; [`Signal`] is a copyable handle of one of its nodes. A bad
//! operation records an [`Error`] with its place and yields a poisoned handle; [`Graph::finish`] returns all of
//! them together or a [`Module`], from which nothing can be taken that its outputs do not need.

mod at_reset;
mod block_memory;
mod case;
mod cut;
mod delay_block;
mod delay_model;
mod error;
mod evaluate;
mod finish;
mod fold;
mod graph;
mod instance;
mod keywords;
mod loads;
mod lookup;
mod module;
mod share_delays;
mod signal;
mod state;
pub mod verilog;
mod wiring;

pub(crate) use block_memory::{Ports, block_memory};
pub use cut::{Timing, cut};
pub use delay_block::delay_block;
pub use delay_model::DelayModel;
pub(crate) use delay_model::{DEEP_TABLE_BITS, DEEP_TABLE_INDEX_BITS};
pub use error::{BuildErrors, Error};
pub use evaluate::{EvaluateError, Evaluator, Pin};
pub use graph::Graph;
pub use instance::{Instance, InstanceCount};
pub(crate) use module::fits_luts;
pub use module::{Memory, Module, Node, NodeId, Op, Parameter, Port, Primitive, Reset, Rounded, Size, Start};
pub use signal::Signal;
pub use state::{Instantiated, MemoryHandle, Register};
