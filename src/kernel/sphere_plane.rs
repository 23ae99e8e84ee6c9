//! A sphere and a plane, in the order of operations of ODE's `dCollideSpherePlane`.

use super::contact::{Contact, Delivery, Scale, named};
use crate::number::{Format, Number, Precise};
use crate::query::{Fields, PairRecord};
use nalgebra::Vector3;

/// A sphere, and the plane of all points p with n · p = d.
struct SpherePlane<T> {
    c: Vector3<T>,
    r: T,
    n: Vector3<T>,
    d: T,
}

impl<T: Number> SpherePlane<T> {
    #[inline(always)]
    fn read(word: impl Fn(usize) -> T) -> Self {
        let [x, y, z, r, nx, ny, nz, d] = std::array::from_fn(word);
        Self { c: Vector3::new(x, y, z), r, n: Vector3::new(nx, ny, nz), d }
    }
}

/// See [`contact`](super::contact()). A NaN depth is not at least 0, and so no contact; valid words lead to one only in
/// an arithmetic in which a product overflows to infinity.
#[inline(always)]
pub(super) fn contact<T: Number>(
    word: impl Fn(usize) -> T,
    valid: T::Bool,
    arithmetic: Format,
    record: Format,
    fields: Fields,
) -> Contact<T> {
    let unasked = word(0).constant(0.0);
    let SpherePlane { c, r, n, d } = SpherePlane::read(|i| word(i).to(arithmetic));
    let zero = r.constant(0.0);

    let along = ((n.x * c.x + n.y * c.y) + n.z * c.z).named("along_normal");
    let depth = ((d - along).named("beyond") + r).named("overlap");
    let hit = valid & zero.le(depth);
    let never = hit & !hit;
    if fields == Fields::HIT {
        return Contact::decision(hit, never, unasked);
    }

    let surface = c - named(n * r, ["offset_x", "offset_y", "offset_z"]);
    let deliver = Delivery { hit, zero, unasked, record, fields };
    Contact {
        hit,
        coincident: never,
        position: deliver.position(|axis| surface[axis]),
        normal: deliver.normal(|axis| n[axis]),
        depth: deliver.depth(depth),
    }
}

/// The margin of the decision: |depth| over the sum of the magnitudes that it is computed from; 0 to 1.
pub(super) fn margin(word: impl Fn(usize) -> Precise) -> f64 {
    let SpherePlane { c, r, n, d } = SpherePlane::read(word);
    let products = [n.x * c.x, n.y * c.y, n.z * c.z];
    let depth = (d - (products[0] + products[1] + products[2])) + r;
    let size = products.into_iter().fold(d.abs() + r, |size, product| size + product.abs());
    if size.is_zero() { 0.0 } else { (depth.abs() / size).to_f64() }
}

/// The depth is computed from three products, the plane's distance and the radius; the position from centre and radius.
pub(super) fn scale(pair: &PairRecord) -> Scale {
    let [x, y, z, r, nx, ny, nz, d] = pair.values();
    let product = |a: f32, b: f32| (f64::from(a) * f64::from(b)).abs();
    let axes = [x, y, z].map(|centre| centre.abs().max(r.abs()));
    Scale {
        depth: product(x, nx) + product(y, ny) + product(z, nz) + f64::from(d).abs() + f64::from(r),
        position: axes.into_iter().map(f64::from).fold(0.0, f64::max),
        axes,
    }
}
