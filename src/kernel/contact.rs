//! The contact that a kernel computes, and the steps that all kernels share.

use crate::number::{Format, Number};
use crate::query::{Fields, NUMBERS};
use nalgebra::Vector3;

/// A contact in the arithmetic of the kernel. Without a hit every number is zero.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T: Number> {
    /// True if the bodies touch.
    pub hit: T::Bool,
    /// True if they touch with coincident centres. The normal is then chosen, not computed.
    pub coincident: T::Bool,
    /// The point of contact.
    pub position: Vector3<T>,
    /// The unit normal, pointing into the first body.
    pub normal: Vector3<T>,
    /// The penetration depth.
    pub depth: T,
}

impl<T: Number> Contact<T> {
    /// The decision only: every number is zero.
    #[inline(always)]
    pub(super) fn decision(hit: T::Bool, coincident: T::Bool, unasked: T) -> Self {
        let nowhere = Vector3::new(unasked, unasked, unasked);
        Self { hit, coincident, position: nowhere, normal: nowhere, depth: unasked }
    }

    /// The numbers in the order of a record: see [`GROUPS`](crate::query::GROUPS).
    #[inline(always)]
    pub fn numbers(&self) -> [T; NUMBERS] {
        let Self { position: p, normal: n, depth, .. } = self;
        [p.x, p.y, p.z, n.x, n.y, n.z, *depth]
    }
}

/// How a kernel's numbers become those of a record: zero without a hit, then converted to the record's format. Numbers
/// that are not asked for are not computed.
#[derive(Clone, Copy)]
pub(super) struct Delivery<T: Number> {
    pub hit: T::Bool,
    /// Zero in the kernel's own format.
    pub zero: T,
    /// Zero in the record's format, for numbers that are not asked for.
    pub unasked: T,
    pub record: Format,
    pub fields: Fields,
}

impl<T: Number> Delivery<T> {
    #[inline(always)]
    fn number(&self, asked: bool, value: T, name: &str) -> T {
        if asked { T::select(self.hit, value, self.zero).to(self.record).named(name) } else { self.unasked }
    }

    #[inline(always)]
    pub fn position(&self, component: impl Fn(usize) -> T) -> Vector3<T> {
        self.vector(self.fields.position, component, ["position_x", "position_y", "position_z"])
    }

    #[inline(always)]
    pub fn normal(&self, component: impl Fn(usize) -> T) -> Vector3<T> {
        self.vector(self.fields.normal, component, ["normal_x", "normal_y", "normal_z"])
    }

    #[inline(always)]
    pub fn depth(&self, value: T) -> T {
        self.number(self.fields.depth, value, "depth")
    }

    #[inline(always)]
    fn vector(&self, asked: bool, component: impl Fn(usize) -> T, names: [&str; 3]) -> Vector3<T> {
        let of = |axis: usize| self.number(asked, component(axis), names[axis]);
        Vector3::new(of(0), of(1), of(2))
    }
}

/// Names the components for generated hardware.
#[inline(always)]
pub(super) fn named<T: Number>(v: Vector3<T>, [x, y, z]: [&str; 3]) -> Vector3<T> {
    Vector3::new(v.x.named(x), v.y.named(y), v.z.named(z))
}

/// The magnitudes relative to which the errors of a contact are judged.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// For the depth: the sum of the magnitudes that it is computed from.
    pub depth: f64,
    /// For the position: the largest magnitude that it is computed from.
    pub position: f64,
    /// For each component of the position: the largest magnitude that it is computed from.
    pub axes: [f32; 3],
}
