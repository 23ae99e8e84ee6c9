//! A memory behind an AXI4 slave: bursts in, lines over a [`Link`](super::Link), beats out.
//!
//! [`AxiMemory`] has the link's latency, bandwidth and faults, and answers in the order of the requests, because the
//! AFU uses one ID. A monitor checks the rules of AXI4 on both sides in every cycle.

mod error;
mod lite;
mod memory;
mod monitor;
mod signals;

pub use error::AxiError;
pub(crate) use lite::{LiteMaster, LiteMonitor, LiteSlave};
pub use memory::{AxiMemory, AxiModel, Handshake};
pub(crate) use signals::{Address, FromMemory, ToMemory, WriteBeat};
pub use signals::{DECERR, OKAY, SLVERR};
