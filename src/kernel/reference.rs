//! The reference kernel: [`contact`] over records, in any format.

use super::{Contact, Filtered, contact, exact, narrow, settle, widen};
use crate::number::{Format, Number, Soft};
use crate::query::{ContactRecord, Fields, Flow, PairRecord, Query};

/// The only NaN that this crate computes in any record.
const NAN: u32 = 0x7FC0_0000;

/// The reference kernel, with which every implementation is compared bit by bit.
///
/// In binary32 it computes with the machine's `f32`, in any other format with [`Soft`]. Pairs and contacts are in
/// binary32. If records in memory are shorter ([`Reference::with_record`]), pairs are rounded to them first, and the
/// words of a contact are those of memory, widened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    query: Query,
    arithmetic: Arithmetic,
    fields: Fields,
    record: Format,
}

/// The kernel and its number format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// [`contact`] in one format.
    Rounded(Format),
    /// [`exact`] in its own formats.
    Exact,
}

impl Arithmetic {
    /// The format of the words of pairs and contacts: the widths of `record`, with the rounding of this arithmetic.
    pub const fn record(self, record: Format) -> Format {
        match self {
            Self::Rounded(format) => format.record(record),
            Self::Exact => record,
        }
    }
}

impl Reference {
    /// The kernel of two spheres that computes in `arithmetic` and returns `fields`; words of the other fields are
    /// zero.
    pub const fn new(arithmetic: Format, fields: Fields) -> Self {
        Self::of(Arithmetic::Rounded(arithmetic), fields)
    }

    /// The kernel of the profile `exact`.
    pub const fn exact(fields: Fields) -> Self {
        Self::of(Arithmetic::Exact, fields)
    }

    /// The kernel of this arithmetic.
    pub const fn of(arithmetic: Arithmetic, fields: Fields) -> Self {
        Self { query: Query::SphereSphere, arithmetic, fields, record: Format::BINARY32 }
    }

    /// The same kernel for another query. The kernel of `exact` exists for spheres only.
    #[must_use]
    pub const fn of_query(self, query: Query) -> Self {
        Self { query, ..self }
    }

    /// The same kernel for records in memory that have the widths of `record`.
    #[must_use]
    pub const fn with_record(self, record: Format) -> Self {
        Self { record, ..self }
    }

    /// The contact of one pair. The kernel of `exact` leaves some pairs unsettled: see [`settle`].
    pub fn run(&self, pair: &PairRecord) -> ContactRecord {
        if self.arithmetic == Arithmetic::Rounded(Format::BINARY32) && self.record == Format::BINARY32 {
            native(self.query, pair, self.fields)
        } else {
            self.run_soft(pair)
        }
    }

    /// The contacts of many pairs in order, and how many of them the kernel left to [`settle`].
    pub fn settled(&self, pairs: &[PairRecord]) -> (Vec<ContactRecord>, u64) {
        let mut contacts = self.run_all(pairs);
        let unsettled = settle(pairs, &mut contacts, self.fields);
        (contacts, unsettled)
    }

    /// The contacts of many pairs in order: [`Reference::run`] of each.
    pub fn run_all(&self, pairs: &[PairRecord]) -> Vec<ContactRecord> {
        pairs.iter().map(|pair| self.run(pair)).collect()
    }

    /// [`Reference::run`] with [`Soft`] in every format. In binary32 it checks `f32`, and `f32` checks it.
    pub fn run_soft(&self, pair: &PairRecord) -> ContactRecord {
        let record = self.arithmetic.record(self.record);
        let pair = pair.rounded(record);
        let word = |i: usize| Soft::from_bits(record, narrow(pair.0[i], record).into());
        let valid = pair.is_valid(self.query);
        let bits = |number: Soft| widen(number.bits() as u32, record);
        match self.arithmetic {
            Arithmetic::Rounded(format) => {
                write(contact(self.query, word, valid, format, record, self.fields), valid, bits)
            }
            Arithmetic::Exact => {
                let Filtered { contact, unsettled } = exact(word, valid, record, self.fields);
                if unsettled { ContactRecord::UNSETTLED } else { write(contact, valid, bits) }
            }
        }
    }
}

/// The contact of one pair in the machine's own arithmetic.
#[inline(always)]
pub(super) fn native(query: Query, pair: &PairRecord, fields: Fields) -> ContactRecord {
    let valid = pair.is_valid(query);
    let word = |i: usize| f32::from_bits(pair.0[i]);
    let contact = contact(query, word, valid, Format::BINARY32, Format::BINARY32, fields);
    // Any NaN of the machine becomes the canonical one.
    write(contact, valid, |value: f32| if value.is_nan() { NAN } else { value.to_bits() })
}

/// The record of a contact.
#[inline(always)]
fn write<T: Number<Bool = bool>>(contact: Contact<T>, valid: bool, bits: impl Fn(T) -> u32) -> ContactRecord {
    // Selections instead of a `match`, because the batch kernel needs code without branches.
    let touching = if contact.coincident { Flow::Coincident.flags() } else { Flow::Real.flags() };
    let apart = if valid { Flow::Fake.flags() } else { Flow::Invalid.flags() };
    let flags = if contact.hit { touching } else { apart };
    let [a, b, c, d, e, f, g] = contact.numbers();
    ContactRecord([bits(a), bits(b), bits(c), bits(d), bits(e), bits(f), bits(g), flags])
}
