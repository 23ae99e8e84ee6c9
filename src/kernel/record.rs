//! Pairs and contacts as memory holds them: eight 32-bit words each, floating-point fields as raw binary32 words.

use super::contact::Pair;
use nalgebra::Vector3;
use std::fmt;

/// The names of a pair's words, in order.
pub const PAIR_FIELDS: [&str; 8] = ["x1", "y1", "z1", "r1", "x2", "y2", "z2", "r2"];

const SIGN: u32 = 0x8000_0000;
const INFINITY: u32 = 0x7F80_0000;
/// The only NaN in any record that this crate computes.
const NAN: u32 = 0x7FC0_0000;

/// Two spheres: x1 y1 z1 r1 x2 y2 z2 r2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct PairRecord(pub [u32; 8]);

impl PairRecord {
    /// Two spheres, each x y z and radius.
    pub fn from_spheres(first: [f32; 4], second: [f32; 4]) -> Self {
        let word = |i: usize| if i < 4 { first[i].to_bits() } else { second[i - 4].to_bits() };
        Self(std::array::from_fn(word))
    }

    /// The eight words read as numbers.
    pub fn values(self) -> [f32; 8] {
        self.0.map(f32::from_bits)
    }

    /// The first word that makes the pair invalid: an infinity, a NaN or a negative radius (−0 is none).
    pub fn invalid_field(self) -> Option<usize> {
        (0..8).find(|&i| {
            let word = self.0[i];
            word & INFINITY == INFINITY || i % 4 == 3 && word > SIGN
        })
    }

    /// Whether every word is finite and no radius is negative. Without branches, for the batch kernel.
    #[inline(always)]
    pub fn is_valid(self) -> bool {
        let finite = self.0.iter().fold(true, |all, word| all & (word & INFINITY != INFINITY));
        finite & (self.0[3] <= SIGN) & (self.0[7] <= SIGN)
    }

    /// The two spheres, each word made a number.
    #[inline(always)]
    pub fn read<T>(self, number: impl Fn(u32) -> T) -> Pair<T> {
        let [x1, y1, z1, r1, x2, y2, z2, r2] = self.0.map(number);
        Pair { p1: Vector3::new(x1, y1, z1), r1, p2: Vector3::new(x2, y2, z2), r2 }
    }
}

/// Which way a pair went through the kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Flow {
    /// Not a pair of spheres: an infinity, a NaN or a negative radius.
    Invalid = 0,
    /// No contact (Flow 1 of the paper).
    Fake = 1,
    /// A contact of coincident centres (Flow 2). The paper and files call it "grazing", which in English means
    /// tangent.
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
}

impl fmt::Display for Flow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A contact: position x y z, normal x y z, depth, flags.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct ContactRecord(pub [u32; 8]);

impl ContactRecord {
    /// What the kernel of the profile `exact` writes for a pair that needs more than its window: bit 4 of the flags,
    /// and nothing else. The host puts the contact in its place before anyone reads it.
    pub const UNSETTLED: Self = Self([0, 0, 0, 0, 0, 0, 0, 16]);

    /// Whether it is no contact yet, but the admission that the pair needs more.
    pub const fn is_unsettled(self) -> bool {
        self.flags() & 16 != 0
    }

    /// The flags word: see [`Flow::flags`].
    pub const fn flags(self) -> u32 {
        self.0[7]
    }

    /// Whether the pair touches.
    pub const fn is_contact(self) -> bool {
        self.flags() & 1 == 1
    }

    /// Which way the pair went; nothing when the flags are none that a kernel writes.
    pub fn flow(self) -> Option<Flow> {
        Flow::ALL.into_iter().find(|flow| flow.flags() == self.flags())
    }

    /// Where the spheres touch.
    pub fn position(self) -> [f32; 3] {
        [self.0[0], self.0[1], self.0[2]].map(f32::from_bits)
    }

    /// The direction that parts them, pointing into the first.
    pub fn normal(self) -> [f32; 3] {
        [self.0[3], self.0[4], self.0[5]].map(f32::from_bits)
    }

    /// How deep they overlap.
    pub fn depth(self) -> f32 {
        f32::from_bits(self.0[6])
    }
}

/// The word of a computed number: every NaN is the canonical one, whatever the machine made of it.
#[inline(always)]
pub(super) fn word(value: f32) -> u32 {
    if value.is_nan() { NAN } else { value.to_bits() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_words_are_found_in_every_place() {
        let good = PairRecord::from_spheres([1.0, -2.0, f32::MAX, -0.0], [0.0, -0.0, f32::MIN, 1e-45]);
        assert!(good.is_valid());
        for (i, name) in PAIR_FIELDS.into_iter().enumerate() {
            for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1e-45] {
                let mut pair = good;
                pair.0[i] = bad.to_bits();
                let expected = (i % 4 == 3 || !bad.is_finite()).then_some(i);
                assert_eq!(pair.is_valid(), expected.is_none());
                assert_eq!(pair.invalid_field(), expected, "{bad} as {name}");
            }
        }
    }

    #[test]
    fn flags_are_those_of_the_design() {
        assert_eq!(Flow::ALL.map(Flow::flags), [8, 2, 5, 7]);
        for flow in Flow::ALL {
            let record = ContactRecord([0, 0, 0, 0, 0, 0, 0, flow.flags()]);
            assert_eq!(record.flow(), Some(flow));
            assert_eq!(record.is_contact(), matches!(flow, Flow::Coincident | Flow::Real));
        }
        assert_eq!(ContactRecord::default().flow(), None);
    }
}
