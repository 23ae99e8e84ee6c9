//! SPL2 of Intel HARP v1, as the AFU below it and the host above it see it, over a [`Link`](super::Link) to memory.
//!
//! [`Spl2`] is one call a clock cycle: what the AFU transmits in it goes in, what it receives comes out. The host
//! writes CSRs; SPL keeps its own and forwards the others. Whatever the AFU must not do is an error of that call. Facts
//! are from public source of the platform (SPL2's RTL, its driver); what was not found there is a parameter of
//! [`Spl2Model`].

mod error;
mod header;
mod model;
mod monitor;
mod pages;
mod reads;
mod writes;

pub use error::Spl2Error;
pub use header::{Header, Receive, Receive0, Transmit};
pub use model::{CsrOffset, DeviceWrite, SPL_ID, Seen, Spl2, Spl2Model};
pub use monitor::Limits;
pub use pages::{MAX_PAGES, PAGE_BYTES, PAGE_LINES, Pages};
