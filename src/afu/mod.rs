//! The accelerator: record layout, processing units, the controller around them, and the top over the line port.
//!
//! Data flows one way: collector → feeder → slots (one SCPU each) → packer → dispatcher. Control watches. Where only
//! contacts come back, sieve and backlog stand before the packer.

mod awaited;
mod backlog;
mod bench;
mod capability;
mod collector;
mod control;
mod counter;
mod dispatcher;
mod feeder;
mod files;
mod fusesoc;
mod generate;
mod in_order;
mod job_error;
mod layout;
mod lines;
pub(crate) mod pack;
mod packer;
pub(crate) mod port;
mod ports;
mod records;
mod results;
mod rounds;
mod scpu;
pub mod shell;
mod sieve;
mod slot;
mod spec;
mod status;
mod timing;
mod top;

pub use capability::Capability;
pub use control::DRAIN_CYCLES;
pub use files::file_list;
pub use generate::{Afu, BuildError, top_name};
pub use job_error::JobError;
pub use layout::{Layout, OtherRadius};
pub use spec::{Spec, SpecError};
pub use timing::Timing;

/// Bits of a line address: 64-byte lines of a 64-bit byte address space.
pub const ADDRESS_BITS: u32 = 58;
/// Bits of a job's epoch, the upper part of a tag.
pub const EPOCH_BITS: u32 = 4;
/// Bits of a pair count or number.
pub const COUNT_BITS: u32 = 32;
/// Bits that hold a number of SCPUs.
pub const SCPU_BITS: u32 = 7;
/// Largest number of SCPUs.
pub const MAX_SCPUS: u32 = 64;
