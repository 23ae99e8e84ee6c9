//! Algorithm 1: the contact of two spheres, in the order of operations of the Open Dynamics Engine.

use super::Fields;
use crate::number::{Format, Number};
use nalgebra::Vector3;

/// Two spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair<T> {
    /// Centre of the first.
    pub p1: Vector3<T>,
    /// Its radius.
    pub r1: T,
    /// Centre of the second.
    pub p2: Vector3<T>,
    /// Its radius.
    pub r2: T,
}

impl<T: Number> Pair<T> {
    #[inline(always)]
    fn to(self, format: Format) -> Self {
        let [p1, p2] = [self.p1, self.p2].map(|p| Vector3::new(p.x.to(format), p.y.to(format), p.z.to(format)));
        Self { p1, r1: self.r1.to(format), p2, r2: self.r2.to(format) }
    }
}

/// What a pair gives. Without a hit every number is zero.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T: Number> {
    /// Whether the spheres touch.
    pub hit: T::Bool,
    /// Whether they touch with coincident centres, so that the normal is chosen and not computed.
    pub coincident: T::Bool,
    /// Where they touch.
    pub position: Vector3<T>,
    /// The direction that parts them, pointing into the first.
    pub normal: Vector3<T>,
    /// How deep they overlap.
    pub depth: T,
}

/// The contact of a pair that is `valid`, computed in the format `arithmetic`; the pair and the contact's numbers
/// are in the format `record`. Fields that are not asked for are zero.
///
/// The order of every sum and product is part of the contract: each rounds once, and hardware, reference and peers
/// must round alike. Touching counts as contact. So does a NaN distance, which is greater than nothing; valid spheres
/// have one only in arithmetic so narrow that a coordinate of both becomes infinite.
#[inline(always)]
pub fn contact<T: Number>(
    pair: Pair<T>,
    valid: T::Bool,
    arithmetic: Format,
    record: Format,
    fields: Fields,
) -> Contact<T> {
    let unasked = pair.r1.constant(0.0);
    let Pair { p1, r1, p2, r2 } = pair.to(arithmetic);
    let zero = r1.constant(0.0);

    let apart = named(p1 - p2, ["dx", "dy", "dz"]);
    let q = ((apart.x * apart.x + apart.y * apart.y) + apart.z * apart.z).named("distance_squared");
    let s = (r1 + r2).named("radius_sum");

    if !fields.need_distance() {
        // The same decisions as below, without the root: q is 0 exactly when its rounded root is.
        let hit = valid & !q.root_exceeds(s);
        let nowhere = Vector3::new(unasked, unasked, unasked);
        return Contact { hit, coincident: hit & q.le(zero), position: nowhere, normal: nowhere, depth: unasked };
    }

    let d = q.sqrt().named("distance");
    let hit = valid & !d.gt(s);
    let coincident = hit & d.le(zero);

    // Division by a coincident pair's zero does no harm: its results are not selected.
    let n = named(apart * d.recip().named("inverse_distance"), ["nx", "ny", "nz"]);
    let k = (((r2 - r1) - d) * d.constant(0.5)).named("offset");
    let x_axis = Vector3::new(zero.constant(1.0), zero, zero);

    let deliver = |asked: bool, value: T, name: &str| {
        if asked { T::select(hit, value, zero).to(record).named(name) } else { unasked }
    };
    let vector = |asked: bool, if_coincident: Vector3<T>, value: Vector3<T>, names: [&str; 3]| {
        let component = |i: usize| deliver(asked, T::select(coincident, if_coincident[i], value[i]), names[i]);
        Vector3::new(component(0), component(1), component(2))
    };
    Contact {
        hit,
        coincident,
        position: vector(fields.position, p1, p1 + n * k, ["position_x", "position_y", "position_z"]),
        normal: vector(fields.normal, x_axis, n, ["normal_x", "normal_y", "normal_z"]),
        // A coincident pair's depth is s: its d is +0, so the difference is that already.
        depth: deliver(fields.depth, s - d, "depth"),
    }
}

/// Names the components for generated hardware.
#[inline(always)]
fn named<T: Number>(v: Vector3<T>, [x, y, z]: [&str; 3]) -> Vector3<T> {
    Vector3::new(v.x.named(x), v.y.named(y), v.z.named(z))
}
