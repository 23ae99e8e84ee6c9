//! The truth: the contact of a pair in exact arithmetic.

use super::{Contact, Scale, contact, margin, scale};
use crate::number::{Format, Precise};
use crate::query::{ContactRecord, FLAGS, Fields, Flow, PairRecord, Query};
use nalgebra::Vector3;

/// The true contact of a pair: [`contact`] with [`Precise`], which decides exactly and from which every number can be
/// rounded correctly.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    query: Query,
    pair: PairRecord,
    contact: Option<Contact<Precise>>,
    flow: Flow,
}

impl Truth {
    /// The truth about two spheres.
    pub fn of(pair: &PairRecord) -> Self {
        Self::of_query(Query::SphereSphere, pair)
    }

    /// The truth about a pair of this query.
    pub fn of_query(query: Query, pair: &PairRecord) -> Self {
        let read = |fields| contact(query, precise(pair), true, Format::BINARY32, Format::BINARY32, fields);
        let without = |flow| Self { query, pair: *pair, contact: None, flow };
        if !pair.is_valid(query) {
            return without(Flow::Invalid);
        }
        // The decision needs no root, and most pairs without contact need nothing more.
        if !read(Fields::HIT).hit {
            return without(Flow::Fake);
        }
        let contact = read(Fields::ALL);
        let flow = if contact.coincident { Flow::Coincident } else { Flow::Real };
        Self { contact: Some(contact), ..without(flow) }
    }

    /// The outcome of the pair.
    pub const fn flow(&self) -> Flow {
        self.flow
    }

    /// True if the bodies touch.
    pub const fn is_contact(&self) -> bool {
        self.contact.is_some()
    }

    /// The penetration depth; `None` without contact.
    pub fn depth(&self) -> Option<Precise> {
        self.contact.map(|contact| contact.depth)
    }

    /// The unit normal, pointing into the first body; `None` without contact.
    pub fn normal(&self) -> Option<[Precise; 3]> {
        self.contact.map(|contact| contact.normal.into())
    }

    /// The point of contact; `None` without contact.
    pub fn position(&self) -> Option<[Precise; 3]> {
        self.contact.map(|contact| contact.position.into())
    }

    /// The record with every number correctly rounded (IEEE 754-2019, clause 4.3.1). A zero is +0, except in the
    /// position of coincident spheres, which is the first centre unchanged.
    pub fn record(&self) -> ContactRecord {
        let mut record = ContactRecord::of_flags(self.flow.flags());
        let Some(contact) = &self.contact else { return record };
        record.0[..FLAGS].copy_from_slice(&contact.numbers().map(|number| number.to_f32().to_bits()));
        if self.flow == Flow::Coincident {
            record = record.at_first_centre(&self.pair);
        }
        record
    }

    /// The margin of the decision, 0 to 1. For two spheres it is |s − d| over the larger of the two, with the distance
    /// d and the sum of the radii s. For a sphere and a plane it is |depth| over the sum of the magnitudes that it is
    /// computed from. The margin of an invalid pair is 1.
    pub fn margin(&self) -> f64 {
        if self.flow == Flow::Invalid { 1.0 } else { margin(self.query, precise(&self.pair)) }
    }

    /// The magnitudes relative to which the errors of an answer are judged.
    pub fn scale(&self) -> Scale {
        scale(self.query, &self.pair)
    }

    /// The largest errors of an answer to this pair; `None` unless both are contacts.
    pub fn errors(&self, answer: ContactRecord) -> Option<UlpErrors> {
        let truth = self.contact.filter(|_| answer.is_contact())?;
        let away = |given: f32, true_value: Precise, unit: f64| {
            if given.is_nan() || given.is_infinite() && true_value.to_f32() == given {
                return if given.is_nan() { f64::INFINITY } else { 0.0 };
            }
            // An infinity counts as the number after the largest one.
            let given = if given.is_infinite() { 2.0_f64.powi(128).copysign(given.into()) } else { given.into() };
            (Precise::from_f64(given) - true_value).abs().to_f64() / unit
        };
        let largest = |given: [f32; 3], truth: &Vector3<Precise>, unit: [f64; 3]| {
            (0..3).map(|i| away(given[i], truth[i], unit[i])).fold(0.0, f64::max)
        };
        let axes = self.scale().axes;
        let unit = |axis: usize| ulp(truth.position[axis].abs().to_f32().max(axes[axis]));
        Some(UlpErrors {
            depth: away(answer.depth(), truth.depth, ulp(truth.depth.abs().to_f32())),
            normal: largest(answer.normal(), &truth.normal, [ulp(1.0); 3]),
            position: largest(answer.position(), &truth.position, [unit(0), unit(1), unit(2)]),
        })
    }
}

/// The largest error of each kind of number, in units in the last place of binary32; infinite for a NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UlpErrors {
    /// The error of the depth, in its own units in the last place.
    pub depth: f64,
    /// The error of the normal's components, in units in the last place of 1.
    pub normal: f64,
    /// The error of the position's components, each in units of the largest magnitude that it is computed from, or its
    /// own.
    pub position: f64,
}

impl UlpErrors {
    /// The largest of the three errors.
    pub fn largest(self) -> f64 {
        self.depth.max(self.normal).max(self.position)
    }
}

/// The unit in the last place: 2^(e − 23), and 2^−149 below the smallest normal number. For an infinity it is that of
/// the largest number.
pub fn ulp(value: f32) -> f64 {
    let biased = (value.to_bits() >> 23 & 0xFF).clamp(1, 254);
    2.0_f64.powi(biased as i32 - 150)
}

/// The words of a pair, without rounding.
fn precise(pair: &PairRecord) -> impl Fn(usize) -> Precise {
    |word| Precise::from_f64(f32::from_bits(pair.0[word]).into())
}
