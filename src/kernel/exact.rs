//! The kernel of the profile `exact`: a decision and a depth from exact squares, or the admission that they need more.

use super::Fields;
use super::contact::{Contact, Pair};
use crate::number::{Format, Window};
use nalgebra::Vector3;

/// A contact as far as the kernel can tell.
#[derive(Clone, Copy, Debug)]
pub struct Filtered<T: Window> {
    /// The contact; no hit where it is unsettled.
    pub contact: Contact<T>,
    /// Whether the pair is valid but its decision, or the leading bits of its depth, need more than the window.
    pub unsettled: T::Bool,
}

/// The contact of a pair that is `valid`; the pair and the contact's numbers are in the format `record`. Fields that
/// are not asked for are zero.
///
/// With T = (r1+r2)² − |p1−p2|² the spheres touch where T ≥ 0, and their depth is T / ((r1+r2) + |p1−p2|), in which
/// nothing cancels. Differences are in [`Format::DIFFERENCE`], T in a window of exact squares ([`Window`]), and what
/// follows in [`Format::TAIL`]. `docs/exact.md` proves that every number is within a unit in the last place.
pub fn exact<T: Window>(pair: Pair<T>, valid: T::Bool, record: Format, fields: Fields) -> Filtered<T> {
    let (difference, tail) = (Format::DIFFERENCE, Format::TAIL);
    let unasked = pair.r1.constant(0.0);
    let wide = |number: T| number.to(difference);
    let apart = |axis: usize, name: &str| wide(pair.p1[axis]).minus_to_odd(wide(pair.p2[axis])).named(name);
    let (x, y, z) = (apart(0, "dx"), apart(1, "dy"), apart(2, "dz"));
    let sum = wide(pair.r1).plus_to_odd(wide(pair.r2)).named("radius_sum");
    let excess = sum.square_excess([x, y, z], tail).named("excess");

    let zero = excess.constant(0.0);
    // In doubt the excess is a NaN, of which nothing holds.
    let unsettled = valid & !(excess.gt(zero) | excess.le(zero));
    let hit = valid & zero.le(excess);

    let [x, y, z] = [(x, "tail_dx"), (y, "tail_dy"), (z, "tail_dz")].map(|(v, name)| v.to(tail).named(name));
    let q = ((x * x + y * y) + z * z).named("distance_squared");
    let coincident = hit & q.le(zero);
    if !fields.need_distance() {
        let nowhere = Vector3::new(unasked, unasked, unasked);
        let contact = Contact { hit, coincident, position: nowhere, normal: nowhere, depth: unasked };
        return Filtered { contact, unsettled };
    }

    let d = q.sqrt().named("distance");
    let inverse = d.recip().named("inverse_distance");
    let [nx, ny, nz] = [(x, "nx"), (y, "ny"), (z, "nz")].map(|(v, name)| (v * inverse).named(name));
    let s = sum.to(tail).named("tail_radius_sum");
    // Coincident centres: the depth is the sum of the radii as it is, and nothing is divided by zero.
    let depth = T::select(coincident, s, excess / (s + d)).named("overlap");
    let r1 = pair.r1.to(tail);
    let k = (depth * depth.constant(0.5) - r1).named("offset");

    let deliver = |asked: bool, value: T, name: &str| {
        if asked { T::select(hit, value, zero).to(record).named(name) } else { unasked }
    };
    let one = zero.constant(1.0);
    let normal = [(nx, one, "normal_x"), (ny, zero, "normal_y"), (nz, zero, "normal_z")];
    let normal =
        normal.map(|(n, if_coincident, name)| deliver(fields.normal, T::select(coincident, if_coincident, n), name));
    let position = [(0, nx, "position_x"), (1, ny, "position_y"), (2, nz, "position_z")].map(|(axis, n, name)| {
        let centre = pair.p1[axis].to(tail);
        deliver(fields.position, T::select(coincident, centre, centre + n * k), name)
    });
    let contact = Contact {
        hit,
        coincident,
        position: position.into(),
        normal: normal.into(),
        depth: deliver(fields.depth, depth, "depth"),
    };
    Filtered { contact, unsettled }
}
