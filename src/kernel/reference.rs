//! The reference kernel: [`contact`] over records, in any format.

use super::record::word;
use super::{Contact, ContactRecord, Fields, Flow, PairRecord, contact};
use crate::number::{Format, Number, Soft};

/// What every other implementation is compared with, bit for bit.
///
/// In binary32 it computes with the machine's `f32`, in any other format with [`Soft`]; records are binary32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    arithmetic: Format,
    fields: Fields,
}

impl Reference {
    /// The kernel that computes in `arithmetic` and gives `fields`; the others are zero words.
    pub const fn new(arithmetic: Format, fields: Fields) -> Self {
        Self { arithmetic, fields }
    }

    /// The contact of one pair.
    pub fn run(&self, pair: &PairRecord) -> ContactRecord {
        if self.arithmetic == Format::BINARY32 { native(pair, self.fields) } else { self.run_soft(pair) }
    }

    /// The contacts of many pairs, in their order.
    pub fn run_all(&self, pairs: &[PairRecord]) -> Vec<ContactRecord> {
        pairs.iter().map(|pair| self.run(pair)).collect()
    }

    /// [`Reference::run`] by way of [`Soft`] in every format: the twin that checks `f32`, and is checked by it.
    pub fn run_soft(&self, pair: &PairRecord) -> ContactRecord {
        let record = Format::BINARY32;
        let spheres = pair.read(|word| Soft::from_bits(record, word.into()));
        let valid = pair.is_valid();
        let contact = contact(spheres, valid, self.arithmetic, record, self.fields);
        write(contact, valid, |number| number.bits() as u32)
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
