//! The outcome of a pair.

use std::fmt;

/// The outcome of a pair in the kernel; the paper calls it a flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Flow {
    /// An invalid pair: an infinity, a NaN or a negative radius.
    Invalid = 0,
    /// No contact (Flow 1 of the paper).
    Fake = 1,
    /// A contact with coincident centres (Flow 2 of the paper; the paper and the files call it grazing).
    Coincident = 2,
    /// A contact with a computed normal (Flow 3 of the paper).
    Real = 3,
}

impl Flow {
    /// Every flow.
    pub const ALL: [Self; 4] = [Self::Invalid, Self::Fake, Self::Coincident, Self::Real];

    /// The flags word of a contact record: bit 0 contact, bits 2:1 flow, bit 3 invalid.
    #[inline(always)]
    pub const fn flags(self) -> u32 {
        match self {
            Self::Invalid => 8,
            Self::Fake => 2,
            Self::Coincident => 5,
            Self::Real => 7,
        }
    }

    /// The name in files and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Invalid => "invalid",
            Self::Fake => "fake",
            Self::Coincident => "grazing",
            Self::Real => "real",
        }
    }

    /// A description for documentation.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Invalid => "invalid pair",
            Self::Fake => "no contact",
            Self::Coincident => "contact, coincident centres",
            Self::Real => "contact",
        }
    }

    /// True for a contact.
    pub const fn is_contact(self) -> bool {
        self.flags() & 1 == 1
    }
}

impl fmt::Display for Flow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
