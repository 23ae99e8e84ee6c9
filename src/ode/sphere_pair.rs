//! ODE's own collision of two spheres, as a function.

use super::dcollide::dcollide;
use super::numbers::within;
use super::{Collider, Contact, Error, Ode, sys};

/// Two spheres without bodies, in no world, that stay where they are until moved.
#[derive(Debug)]
pub struct SpherePair {
    geoms: [sys::dGeomID; 2],
    _ode: Ode,
}

impl SpherePair {
    /// Two spheres of radius 0 at the origin.
    ///
    /// # Errors
    /// When ODE runs without its own collider, or has no memory.
    pub fn new(ode: &Ode) -> Result<Self, Error> {
        ode.needs(Collider::Own)?;
        // SAFETY: ODE is started; no space is a place for a geom, and 0 a radius.
        let geoms = [(); 2].map(|()| unsafe { sys::dCreateSphere(std::ptr::null_mut(), 0.0) });
        if geoms.iter().any(|geom| geom.is_null()) {
            return Err(Error::Memory);
        }
        Ok(Self { geoms, _ode: ode.clone() })
    }

    /// Moves both: x y z and radius each.
    ///
    /// # Errors
    /// When a number is not finite or a radius is negative; the spheres stay as they were.
    pub fn set(&mut self, first: [f64; 4], second: [f64; 4]) -> Result<(), Error> {
        for [x, y, z, radius] in [first, second] {
            for coordinate in [x, y, z] {
                within("a coordinate", coordinate, f64::MIN..=f64::MAX)?;
            }
            within("a radius", radius, 0.0..=f64::MAX)?;
        }
        for (geom, [x, y, z, radius]) in self.geoms.into_iter().zip([first, second]) {
            // SAFETY: the geom lives as long as `self`, and is a sphere without a body.
            unsafe {
                sys::dGeomSetPosition(geom, x, y, z);
                sys::dGeomSphereSetRadius(geom, radius);
            }
        }
        Ok(())
    }

    /// The two as ODE has them.
    pub(super) fn geoms(&self) -> [sys::dGeomID; 2] {
        self.geoms
    }

    /// What ODE's `dCollide` says of them.
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
            // SAFETY: made in `new`, in no space, destroyed once; ODE runs until `_ode` is dropped, after this.
            unsafe { sys::dGeomDestroy(geom) };
        }
    }
}
