//! Records: where the words of pairs and contacts lie in lines of memory, and how an AFU describes itself. Declared
//! once, and used by hardware, host, checks and documentation.

mod capability;
mod contacts;
mod job_error;
mod layout;
mod pack;
mod spheres;

#[cfg(test)]
pub(crate) use capability::AROUND_CYCLES;
pub use capability::{Capability, Part};
pub(crate) use contacts::Contacts;
pub use job_error::JobError;
pub use layout::{Layout, OtherRadius};
pub(crate) use pack::{Line, pack, pack_contacts, unpack_pairs};
pub use spheres::SetTooLarge;
pub(crate) use spheres::{numbers_of, pack_hits, pack_spheres, sphere_lines, unpack_spheres};

/// Bits of a line of memory.
pub(crate) const LINE_BITS: u32 = 512;
/// Bits of a number of pairs or of an index.
pub const COUNT_BITS: u32 = 32;
