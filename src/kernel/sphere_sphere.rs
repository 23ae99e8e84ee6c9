//! Two spheres: Algorithm 1, in the order of operations of the Open Dynamics Engine.

use super::contact::{Contact, Delivery, Scale, named};
use crate::number::{Format, Number, Precise};
use crate::query::{Fields, PairRecord};
use nalgebra::Vector3;

/// Two spheres.
#[derive(Clone, Copy)]
pub(super) struct Spheres<T> {
    pub p1: Vector3<T>,
    pub r1: T,
    pub p2: Vector3<T>,
    pub r2: T,
}

impl<T: Number> Spheres<T> {
    /// Reads the words of a pair, given by their index in the record.
    #[inline(always)]
    pub fn read(word: impl Fn(usize) -> T) -> Self {
        let [x1, y1, z1, r1, x2, y2, z2, r2] = std::array::from_fn(word);
        Self { p1: Vector3::new(x1, y1, z1), r1, p2: Vector3::new(x2, y2, z2), r2 }
    }

    #[inline(always)]
    fn to(self, format: Format) -> Self {
        let centre = |p: Vector3<T>| Vector3::new(p.x.to(format), p.y.to(format), p.z.to(format));
        let (p1, p2) = (centre(self.p1), centre(self.p2));
        Self { p1, r1: self.r1.to(format), p2, r2: self.r2.to(format) }
    }
}

/// See [`contact`](super::contact()). With a NaN distance no comparison holds, so the pair counts as a contact; valid
/// spheres lead to one only in formats so narrow that a coordinate of both overflows.
#[inline(always)]
pub(super) fn contact<T: Number>(
    word: impl Fn(usize) -> T,
    valid: T::Bool,
    arithmetic: Format,
    record: Format,
    fields: Fields,
) -> Contact<T> {
    let pair = Spheres::read(word);
    let unasked = pair.r1.constant(0.0);
    let Spheres { p1, r1, p2, r2 } = pair.to(arithmetic);
    let zero = r1.constant(0.0);

    let apart = named(p1 - p2, ["dx", "dy", "dz"]);
    let q = ((apart.x * apart.x + apart.y * apart.y) + apart.z * apart.z).named("distance_squared");
    // In the order of the difference below: hardware compares the two radii once for both.
    let s = (r2 + r1).named("radius_sum");

    if fields == Fields::HIT {
        // The same decision as below without the root: q is 0 exactly if its rounded root is 0.
        let hit = valid & !q.root_exceeds(s);
        return Contact::decision(hit, hit & q.le(zero), unasked);
    }

    let d = q.sqrt().named("distance");
    let hit = valid & !d.gt(s);
    let coincident = hit & d.le(zero);

    // A coincident pair divides by zero here, but these results are not selected.
    let n = named(apart * d.recip().named("inverse_distance"), ["nx", "ny", "nz"]);
    let k = (((r2 - r1) - d) * d.constant(0.5)).named("offset");
    let x_axis = Vector3::new(zero.constant(1.0), zero, zero);
    let position = p1 + n * k;

    let deliver = Delivery { hit, zero, unasked, record, fields };
    Contact {
        hit,
        coincident,
        position: deliver.position(|axis| T::select(coincident, p1[axis], position[axis])),
        normal: deliver.normal(|axis| T::select(coincident, x_axis[axis], n[axis])),
        // For a coincident pair d is +0, so the difference is s as required.
        depth: deliver.depth(s - d),
    }
}

/// The margin of the decision: |s − d| over the larger of the two, with the distance d and the sum of the radii s; 0 to
/// 1.
pub(super) fn margin(word: impl Fn(usize) -> Precise) -> f64 {
    let pair = Spheres::read(word);
    let apart: Vector3<Precise> = pair.p1 - pair.p2;
    let distance = (apart.x * apart.x + apart.y * apart.y + apart.z * apart.z).sqrt();
    let sum = pair.r1 + pair.r2;
    let larger = distance.max(sum);
    if larger.is_zero() { 0.0 } else { ((distance - sum).abs() / larger).to_f64() }
}

/// The depth is computed from the radii, the position from the first centre and the radii.
pub(super) fn scale(pair: &PairRecord) -> Scale {
    let values = pair.values();
    let [x, y, z, r1, _, _, _, r2] = values;
    Scale {
        depth: f64::from(r1) + f64::from(r2),
        position: values.into_iter().map(|v| f64::from(v).abs()).fold(0.0, f64::max),
        axes: [x, y, z].map(|centre| centre.abs().max(r1.abs()).max(r2.abs())),
    }
}
