//! The kernel of the profile `exact`: it decides and computes the depth from exact squares, or reports the pair as
//! unsettled.

use super::contact::{Contact, Delivery};
use super::sphere_sphere::Spheres;
use crate::number::{Format, Window};
use crate::query::Fields;
use nalgebra::Vector3;

/// A contact, or an unsettled pair.
#[derive(Clone, Copy, Debug)]
pub struct Filtered<T: Window> {
    /// The contact; no hit if the pair is unsettled.
    pub contact: Contact<T>,
    /// True if the pair is valid, but its decision or the leading bits of its depth need more than the window.
    pub unsettled: T::Bool,
}

/// The contact of two spheres that are `valid`. Words are given by their index in the record; words and results are in
/// the format `record`. Fields that are not asked for are zero.
///
/// With T = (r1+r2)² − |p1−p2|² the spheres touch if T ≥ 0, and their depth is T · 1/((r1+r2) + |p1−p2|), in which
/// nothing cancels. Differences are in [`Format::DIFFERENCE`], T is in a window of exact squares ([`Window`]), and the
/// rest is in [`Format::TAIL`]. `docs/exact.md` proves that every number is within one unit in the last place.
pub fn exact<T: Window>(word: impl Fn(usize) -> T, valid: T::Bool, record: Format, fields: Fields) -> Filtered<T> {
    let pair = Spheres::read(word);
    let (difference, tail) = (Format::DIFFERENCE, Format::TAIL);
    let unasked = pair.r1.constant(0.0);
    let wide = |number: T| number.to(difference);
    let apart = |axis: usize, name: &str| wide(pair.p1[axis]).minus_to_odd(wide(pair.p2[axis])).named(name);
    let (x, y, z) = (apart(0, "dx"), apart(1, "dy"), apart(2, "dz"));
    let sum = wide(pair.r1).plus_to_odd(wide(pair.r2)).named("radius_sum");
    let excess = sum.square_excess([x, y, z], tail).named("excess");

    let zero = excess.constant(0.0);
    // If the window does not suffice, the excess is a NaN, for which every comparison is false.
    let unsettled = valid & !(excess.gt(zero) | excess.le(zero));
    let hit = valid & zero.le(excess);

    let [x, y, z] = [(x, "tail_dx"), (y, "tail_dy"), (z, "tail_dz")].map(|(v, name)| v.to(tail).named(name));
    let q = ((x * x + y * y) + z * z).named("distance_squared");
    let coincident = hit & q.le(zero);
    if fields == Fields::HIT {
        return Filtered { contact: Contact::decision(hit, coincident, unasked), unsettled };
    }

    let d = q.sqrt().named("distance");
    let inverse = d.recip().named("inverse_distance");
    let [nx, ny, nz] = [(x, "nx"), (y, "ny"), (z, "nz")].map(|(v, name)| (v * inverse).named(name));
    let s = sum.to(tail).named("tail_radius_sum");
    let over = (s + d).recip().named("inverse_of_sum");
    let overlap = (excess * over).named("overlap");
    let r1 = pair.r1.to(tail);
    let k = (overlap * overlap.constant(0.5) - r1).named("offset");
    // Coincident centres: the depth is the sum of the radii itself, and nothing that was divided by zero is used.
    let depth = T::select(coincident, s, overlap);

    let deliver = Delivery { hit, zero, unasked, record, fields };
    let n = Vector3::new(nx, ny, nz);
    let x_axis = Vector3::new(zero.constant(1.0), zero, zero);
    let normal = deliver.normal(|axis| T::select(coincident, x_axis[axis], n[axis]));
    let position = deliver.position(|axis| {
        let centre = pair.p1[axis].to(tail);
        T::select(coincident, centre, centre + n[axis] * k)
    });
    let contact = Contact { hit, coincident, position, normal, depth: deliver.depth(depth) };
    Filtered { contact, unsettled }
}
