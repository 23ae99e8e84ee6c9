//! How a host and a device agree on a job, one file per kind of registers.

pub(super) mod axi;
pub(super) mod spl2;

use crate::config::Shell;

/// The registers of a device, and with them the handshake of a transaction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Protocol {
    /// Those of the shell `spl2`: written only; everything else is in memory.
    #[default]
    Spl2,
    /// Those of the shell `axi`: read and written, with an interrupt.
    Axi,
}

impl Protocol {
    /// The shell that has these registers.
    pub(super) fn shell(self) -> Shell {
        match self {
            Self::Spl2 => Shell::Spl2,
            Self::Axi => Shell::Axi,
        }
    }

    /// The version of its register map.
    pub(super) fn version(self) -> u32 {
        match self {
            Self::Spl2 => crate::afu::shell::spl2::map::VERSION,
            Self::Axi => crate::afu::shell::axi::map::VERSION,
        }
    }
}

/// What a device says about itself.
pub(super) struct Identity {
    pub(super) afu_id: u128,
    pub(super) version: u32,
    pub(super) capability: u64,
}
