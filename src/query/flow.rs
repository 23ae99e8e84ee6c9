//! Which way a pair went.

use std::fmt;

/// Which way a pair went through the kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Flow {
    /// Not a pair of the query's bodies: an infinity, a NaN or a negative radius.
    Invalid = 0,
    /// No contact (Flow 1 of the paper).
    Fake = 1,
    /// A contact of coincident centres (Flow 2; the paper and the files call it grazing).
    Coincident = 2,
    /// A contact with a normal of its own (Flow 3).
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

    /// The name files and reports use.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Invalid => "invalid",
            Self::Fake => "fake",
            Self::Coincident => "grazing",
            Self::Real => "real",
        }
    }

    /// What it says of a pair.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Invalid => "invalid pair",
            Self::Fake => "no contact",
            Self::Coincident => "contact, coincident centres",
            Self::Real => "contact",
        }
    }

    /// Whether it is a contact.
    pub const fn is_contact(self) -> bool {
        self.flags() & 1 == 1
    }
}

impl fmt::Display for Flow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
