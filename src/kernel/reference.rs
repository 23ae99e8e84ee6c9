//! The reference kernel: [`contact`] over records, in any format.

use super::record::word;
use super::{Contact, ContactRecord, Fields, Filtered, Flow, PairRecord, contact, exact, settle};
use crate::number::{Format, Number, Soft};

/// What every other implementation is compared with, bit for bit.
///
/// In binary32 it computes with the machine's `f32`, in any other format with [`Soft`]; records are binary32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    arithmetic: Arithmetic,
    fields: Fields,
}

/// Which kernel, in which numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// [`contact`], in one format.
    Rounded(Format),
    /// [`exact`], in its own formats.
    Exact,
}

impl Arithmetic {
    /// The format of the pair's and the contact's words: binary32, written by the same rounding.
    pub const fn record(self) -> Format {
        match self {
            Self::Rounded(format) => format.record(),
            Self::Exact => Format::BINARY32,
        }
    }
}

impl Reference {
    /// The kernel that computes in `arithmetic` and gives `fields`; the others are zero words.
    pub const fn new(arithmetic: Format, fields: Fields) -> Self {
        Self::of(Arithmetic::Rounded(arithmetic), fields)
    }

    /// The kernel of the profile `exact`.
    pub const fn exact(fields: Fields) -> Self {
        Self::of(Arithmetic::Exact, fields)
    }

    /// Either of them.
    pub const fn of(arithmetic: Arithmetic, fields: Fields) -> Self {
        Self { arithmetic, fields }
    }

    /// What the kernel gives for one pair. That of `exact` leaves some pairs unsettled: see [`settle`].
    pub fn run(&self, pair: &PairRecord) -> ContactRecord {
        if self.arithmetic == Arithmetic::Rounded(Format::BINARY32) {
            native(pair, self.fields)
        } else {
            self.run_soft(pair)
        }
    }

    /// The contacts of many pairs, in their order, and how many of them the kernel itself did not settle.
    pub fn settled(&self, pairs: &[PairRecord]) -> (Vec<ContactRecord>, u64) {
        let mut contacts = self.run_all(pairs);
        let unsettled = settle(pairs, &mut contacts, self.fields);
        (contacts, unsettled)
    }

    /// What the kernel gives for many pairs, in their order: [`Reference::run`] of each.
    pub fn run_all(&self, pairs: &[PairRecord]) -> Vec<ContactRecord> {
        pairs.iter().map(|pair| self.run(pair)).collect()
    }

    /// [`Reference::run`] by way of [`Soft`] in every format: the twin that checks `f32`, and is checked by it.
    pub fn run_soft(&self, pair: &PairRecord) -> ContactRecord {
        let record = self.arithmetic.record();
        let spheres = pair.read(|word| Soft::from_bits(record, word.into()));
        let valid = pair.is_valid();
        match self.arithmetic {
            Arithmetic::Rounded(format) => {
                let contact = contact(spheres, valid, format, record, self.fields);
                write(contact, valid, |number| number.bits() as u32)
            }
            Arithmetic::Exact => {
                let Filtered { contact, unsettled } = exact(spheres, valid, record, self.fields);
                if unsettled { ContactRecord::UNSETTLED } else { write(contact, valid, |number| number.bits() as u32) }
            }
        }
    }
}

/// The contact of one pair, in the machine's own arithmetic.
#[inline(always)]
pub(super) fn native(pair: &PairRecord, fields: Fields) -> ContactRecord {
    let valid = pair.is_valid();
    let contact = contact(pair.read(f32::from_bits), valid, Format::BINARY32, Format::BINARY32, fields);
    write(contact, valid, word)
}

/// The record of a contact.
#[inline(always)]
fn write<T: Number<Bool = bool>>(contact: Contact<T>, valid: bool, word: impl Fn(T) -> u32) -> ContactRecord {
    // Selections rather than a `match`: the batch kernel is made of this, without branches.
    let touching = if contact.grazing { Flow::Grazing.flags() } else { Flow::Real.flags() };
    let apart = if valid { Flow::Fake.flags() } else { Flow::Invalid.flags() };
    let flags = if contact.hit { touching } else { apart };
    let Contact { position: p, normal: n, depth, .. } = contact;
    let [px, py, pz, nx, ny, nz, depth] = [p.x, p.y, p.z, n.x, n.y, n.z, depth].map(word);
    ContactRecord([px, py, pz, nx, ny, nz, depth, flags])
}
