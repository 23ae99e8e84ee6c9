//! What a kernel gives, and what all kernels do alike with it.

use crate::number::{Format, Number};
use crate::query::{Fields, NUMBERS};
use nalgebra::Vector3;

/// What a pair gives. Without a hit every number is zero.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T: Number> {
    /// Whether the bodies touch.
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

impl<T: Number> Contact<T> {
    /// No number, only the decision.
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

/// What becomes of a kernel's numbers: zero without a hit, then converted to the record; nothing at all if not asked
/// for.
#[derive(Clone, Copy)]
pub(super) struct Delivery<T: Number> {
    pub hit: T::Bool,
    /// In the kernel's own format.
    pub zero: T,
    /// Zero in the record's.
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

/// The sizes that the errors of a true contact are judged by.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Of the depth: the sum of the sizes that it is made of.
    pub depth: f64,
    /// Of the position: the largest number that it is made of.
    pub position: f64,
    /// Of each component of the position: the largest number that it is made of.
    pub axes: [f32; 3],
}
