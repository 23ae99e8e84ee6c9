//! SPL2 of Intel HARP v1 over a [`Link`](super::Link) to memory, as seen by the AFU below it and the host above it.
//!
//! [`Spl2`] advances by one call per clock cycle, which takes the AFU's outputs and returns its inputs. The host writes
//! CSRs; SPL keeps its own and forwards the others. If the AFU breaks a rule, the call returns an error. The behaviour
//! follows the platform's public source (SPL2's RTL, its driver). Where the source does not define it, [`Spl2Model`]
//! has a parameter.

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
