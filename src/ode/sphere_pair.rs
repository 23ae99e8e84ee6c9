//! ODE's own collision of two bodies, as a function.

use super::dcollide::dcollide;
use super::numbers::within;
use super::{Collider, Contact, Error, Ode, sys};
use crate::query::Query;
use std::ptr::null_mut;

/// A sphere and the other body of a query, outside any world. They stay in place until they are moved.
#[derive(Debug)]
pub struct SpherePair {
    query: Query,
    geoms: [sys::dGeomID; 2],
    _ode: Ode,
}

impl SpherePair {
    /// Two spheres of radius 0 at the origin.
    ///
    /// # Errors
    /// Returns an error if ODE runs without its own collider, or has no memory.
    pub fn new(ode: &Ode) -> Result<Self, Error> {
        Self::of_query(Query::SphereSphere, ode)
    }

    /// The bodies of a query: spheres of radius 0, and planes, at the origin.
    ///
    /// # Errors
    /// Returns the errors of [`SpherePair::new`].
    pub fn of_query(query: Query, ode: &Ode) -> Result<Self, Error> {
        ode.needs(Collider::Own)?;
        // SAFETY: ODE is started. A geom may be in no space, 0 is a valid radius, and (1, 0, 0) a valid normal.
        let geoms = unsafe {
            let second = match query {
                Query::SphereSphere => sys::dCreateSphere(null_mut(), 0.0),
                Query::SpherePlane => sys::dCreatePlane(null_mut(), 1.0, 0.0, 0.0, 0.0),
            };
            [sys::dCreateSphere(null_mut(), 0.0), second]
        };
        if geoms.iter().any(|geom| geom.is_null()) {
            return Err(Error::Memory);
        }
        Ok(Self { query, geoms, _ode: ode.clone() })
    }

    /// Moves both: a sphere to x y z and radius, a plane to its normal, which ODE scales to length 1, and its distance.
    ///
    /// # Errors
    /// Returns an error if a number is not finite or a radius is negative. Both bodies are then unchanged.
    pub fn set(&mut self, first: [f64; 4], second: [f64; 4]) -> Result<(), Error> {
        let is_plane = self.query == Query::SpherePlane;
        for ([x, y, z, last], is_plane) in [(first, false), (second, is_plane)] {
            for coordinate in [x, y, z] {
                within("a coordinate", coordinate, f64::MIN..=f64::MAX)?;
            }
            let (what, least) = if is_plane { ("a distance", f64::MIN) } else { ("a radius", 0.0) };
            within(what, last, least..=f64::MAX)?;
        }
        for (geom, [x, y, z, last], is_plane) in [(self.geoms[0], first, false), (self.geoms[1], second, is_plane)] {
            // SAFETY: the geom lives as long as `self`, and is a plane, or a sphere without a body.
            unsafe {
                if is_plane {
                    sys::dGeomPlaneSetParams(geom, x, y, z, last);
                } else {
                    sys::dGeomSetPosition(geom, x, y, z);
                    sys::dGeomSphereSetRadius(geom, last);
                }
            }
        }
        Ok(())
    }

    /// ODE's geoms of the two bodies.
    pub(super) fn geoms(&self) -> [sys::dGeomID; 2] {
        self.geoms
    }

    /// The contact that ODE's `dCollide` finds, or `None`.
    #[inline]
    pub fn collide(&self) -> Option<Contact> {
        let [first, second] = self.geoms;
        // SAFETY: both live as long as `self`.
        unsafe { dcollide(first, second) }
    }
}

impl Drop for SpherePair {
    fn drop(&mut self) {
        for geom in self.geoms {
            // SAFETY: created in `new`, in no space, and destroyed once. ODE runs until `_ode` is dropped, after this.
            unsafe { sys::dGeomDestroy(geom) };
        }
    }
}
