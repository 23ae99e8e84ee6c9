//! Verilated models in Rust: built, loaded, driven.
//!
//! A [`Model`] is compiled code, built in by `build.rs` or made at run time by the same code ([`verilate`]) and cached;
//! an [`Instance`] is one module with its state, whose ports are memory. [`drive`] gives an AFU a job over a simulated
//! link and checks every cycle of it.

mod abi;
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
