//! The reference kernel: [`contact`] over records, in any format.

use super::record::word;
use super::{Contact, ContactRecord, Fields, Filtered, Flow, PairRecord, contact, exact, narrow, settle, widen};
use crate::number::{Format, Number, Soft};

/// What every other implementation is compared with, bit for bit.
///
/// In binary32 it computes with the machine's `f32`, in any other format with [`Soft`]. Pairs and contacts are given as
/// binary32; where records in memory are shorter ([`Reference::with_record`]), pairs are rounded to them first, and the
/// contact's words are those of memory, widened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    arithmetic: Arithmetic,
    fields: Fields,
    record: Format,
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
    /// The format of the pair's and the contact's words, of the widths of `record`: written by the same rounding.
    pub const fn record(self, record: Format) -> Format {
        match self {
            Self::Rounded(format) => format.record(record),
            Self::Exact => record,
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
        Self { arithmetic, fields, record: Format::BINARY32 }
    }

    /// The same over records in memory of the widths of `record`.
    #[must_use]
    pub const fn with_record(self, record: Format) -> Self {
        Self { record, ..self }
    }

    /// What the kernel gives for one pair. That of `exact` leaves some pairs unsettled: see [`settle`].
    pub fn run(&self, pair: &PairRecord) -> ContactRecord {
        if self.arithmetic == Arithmetic::Rounded(Format::BINARY32) && self.record == Format::BINARY32 {
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
        let record = self.arithmetic.record(self.record);
        let pair = pair.rounded(record);
        let spheres = pair.read(|word| Soft::from_bits(record, narrow(word, record).into()));
        let valid = pair.is_valid();
        let word = |number: Soft| widen(number.bits() as u32, record);
        match self.arithmetic {
            Arithmetic::Rounded(format) => {
                let contact = contact(spheres, valid, format, record, self.fields);
                write(contact, valid, word)
            }
            Arithmetic::Exact => {
                let Filtered { contact, unsettled } = exact(spheres, valid, record, self.fields);
                if unsettled { ContactRecord::UNSETTLED } else { write(contact, valid, word) }
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
    let touching = if contact.coincident { Flow::Coincident.flags() } else { Flow::Real.flags() };
    let apart = if valid { Flow::Fake.flags() } else { Flow::Invalid.flags() };
    let flags = if contact.hit { touching } else { apart };
    let Contact { position: p, normal: n, depth, .. } = contact;
    let [px, py, pz, nx, ny, nz, depth] = [p.x, p.y, p.z, n.x, n.y, n.z, depth].map(word);
    ContactRecord([px, py, pz, nx, ny, nz, depth, flags])
}
