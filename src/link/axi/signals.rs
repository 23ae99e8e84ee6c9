//! The channels of AXI4 in one cycle; `None` for a channel whose VALID is low.

use crate::link::Line;

/// The response of an access that succeeded.
pub const OKAY: u8 = 0;
/// The response of an access that the slave refused.
pub const SLVERR: u8 = 2;
/// The response of an access to which no slave belongs.
pub const DECERR: u8 = 3;

/// The channel AW or AR.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Address {
    pub(crate) id: u8,
    /// Byte address.
    pub(crate) address: u64,
    /// Beats, less one.
    pub(crate) length: u8,
    /// Bytes of a beat, as a power of two.
    pub(crate) size: u8,
    pub(crate) burst: u8,
    pub(crate) lock: u8,
    pub(crate) cache: u8,
    pub(crate) prot: u8,
    pub(crate) qos: u8,
}

impl Address {
    pub(crate) fn beats(&self) -> u64 {
        u64::from(self.length) + 1
    }
}

/// The channel W.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WriteBeat {
    /// The data, in the low bits.
    pub(crate) data: Line,
    /// The bytes that are written.
    pub(crate) strobes: u64,
    pub(crate) last: bool,
}

/// The channel R.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ReadBeat {
    /// The data, in the low bits.
    pub(crate) data: Line,
    pub(crate) response: u8,
    pub(crate) last: bool,
}

/// The outputs of a master in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ToMemory {
    pub(crate) aw: Option<Address>,
    pub(crate) w: Option<WriteBeat>,
    pub(crate) ar: Option<Address>,
    pub(crate) b_ready: bool,
    pub(crate) r_ready: bool,
}

/// The outputs of a memory in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct FromMemory {
    pub(crate) aw_ready: bool,
    pub(crate) w_ready: bool,
    pub(crate) ar_ready: bool,
    /// The response of a write burst.
    pub(crate) b: Option<u8>,
    pub(crate) r: Option<ReadBeat>,
}
