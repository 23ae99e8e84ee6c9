//! Builds, loads and drives Verilated models.
//!
//! A [`Model`] is compiled code. `build.rs` builds one in, and the same code ([`verilate`]) makes and caches others at
//! run time. An [`Instance`] is one module with its state, whose ports are memory. [`drive`] runs a job on an AFU over
//! a simulated link and checks every cycle.

mod abi;
pub mod axi;
pub mod drive;
mod error;
mod instance;
mod model;
mod port;
mod source;
pub mod spl2;
pub mod verilate;

pub use crate::outcome::Outcome;
pub use drive::{Driver, Job};
pub use error::{CosimError, SimulationError};
pub use instance::{Clock, Instance};
pub use model::Model;
pub use port::Port;
pub use source::Source;
pub use verilate::{File, Trace};
