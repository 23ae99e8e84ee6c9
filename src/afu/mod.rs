//! The accelerator: record layout, processing units, the controller around them, and the top over the line port.
//!
//! Data flows one way: collector → feeder → slots (one SCPU each) → packer → dispatcher. Control watches. If only
//! contacts come back, a sieve and a backlog precede the packer.

mod awaited;
mod backlog;
mod banks;
mod bench;
mod collector;
mod control;
mod counter;
mod credits;
mod dispatcher;
mod feeder;
mod files;
mod fusesoc;
mod gather;
mod generate;
mod in_order;
mod lines;
mod package;
mod packer;
pub(crate) mod port;
mod ports;
mod queue;
mod records;
mod resolver;
mod results;
mod rounds;
mod scpu;
pub mod shell;
mod sieve;
mod slice;
mod slot;
mod spec;
mod spheres;
mod status;
mod timing;
mod top;
mod wide;

pub use crate::record::{COUNT_BITS, JobError};
pub use control::DRAIN_CYCLES;
pub use files::file_list;
pub use generate::{Afu, BuildError, top_name};
pub use package::{Package, PackageError};
pub use spec::{Spec, SpecError};
pub use spheres::{PredictError, Predicted, SearchModel};
pub use timing::Timing;

/// Bits of a line address: 64-byte lines of a 64-bit byte address space.
pub const ADDRESS_BITS: u32 = 58;
/// Bits of a job's epoch, the upper part of a tag.
pub(crate) const EPOCH_BITS: u32 = 4;
/// Bits that hold a number of SCPUs.
pub(crate) const SCPU_BITS: u32 = 7;
/// Largest number of SCPUs.
pub(crate) const MAX_SCPUS: u32 = 64;
