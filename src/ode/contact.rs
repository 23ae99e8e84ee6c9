//! Contacts in ODE's form.

use super::numbers::LARGEST;
use super::{Sphere, sys};
use crate::query::ContactRecord;

/// Where two spheres touch, in ODE's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The position.
    pub position: [f64; 3],
    /// The direction in which they separate, pointing into the first.
    pub normal: [f64; 3],
    /// The depth of the overlap.
    pub depth: f64,
}

impl Contact {
    /// The contact of a record, or `None` if it is no contact. `f32` converts to `f64` without rounding.
    pub fn from_record(record: ContactRecord) -> Option<Self> {
        let wide = |v: [f32; 3]| v.map(f64::from);
        record.is_contact().then(|| Self {
            position: wide(record.position()),
            normal: wide(record.normal()),
            depth: record.depth().into(),
        })
    }

    /// False if a number is beyond what spheres of a world can give, or a NaN.
    pub(super) fn is_plausible(&self) -> bool {
        let mut numbers = self.position.iter().chain(&self.normal).chain([&self.depth]);
        numbers.all(|v| v.abs() <= 4.0 * LARGEST)
    }

    pub(super) fn read(raw: &sys::dContactGeom) -> Self {
        let three = |v: &sys::dVector3| [v[0], v[1], v[2]];
        Self { position: three(&raw.pos), normal: three(&raw.normal), depth: raw.depth }
    }

    /// ODE's structure, for the geoms `g1` and `g2`.
    pub(super) fn raw(&self, g1: sys::dGeomID, g2: sys::dGeomID) -> sys::dContactGeom {
        let four = |[x, y, z]: [f64; 3]| [x, y, z, 0.0];
        let (pos, normal) = (four(self.position), four(self.normal));
        // ODE's own collider of spheres writes -1 for the sides.
        sys::dContactGeom { pos, normal, depth: self.depth, g1, g2, side1: -1, side2: -1 }
    }
}

/// Two spheres of a world and their contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The sphere that the normal points into.
    pub first: Sphere,
    /// The other sphere.
    pub second: Sphere,
    /// The contact.
    pub contact: Contact,
}

/// The surface, which decides the effect of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Coulomb's coefficient, from 0.
    pub friction: f64,
    /// The speed after the contact as a share of the speed before it: 0 to 1.
    pub bounce: f64,
    /// The approach speed below which they do not bounce, length / time.
    pub bounce_speed: f64,
}

impl Surface {
    /// Without friction and bounce.
    pub const SMOOTH: Self = Self { friction: 0.0, bounce: 0.0, bounce_speed: 0.0 };

    pub(super) fn raw(&self) -> sys::dSurfaceParameters {
        // SAFETY: numbers only, and all of them may be zero.
        let none: sys::dSurfaceParameters = unsafe { std::mem::zeroed() };
        let mode = if self.bounce > 0.0 { sys::dContactBounce as i32 } else { 0 };
        sys::dSurfaceParameters { mode, mu: self.friction, bounce: self.bounce, bounce_vel: self.bounce_speed, ..none }
    }
}
