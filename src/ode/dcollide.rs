//! ODE's `dCollide`, for two spheres, or a sphere and a plane.

use super::{Contact, sys};
use std::ffi::c_int;
use std::mem::MaybeUninit;

/// Room for the one contact that such bodies can have.
pub(super) struct Room(MaybeUninit<sys::dContactGeom>);

impl Room {
    pub(super) const fn new() -> Self {
        Self(MaybeUninit::uninit())
    }

    /// Calls `dCollide` and leaves the contact where ODE put it, so that a benchmark times only the call.
    ///
    /// # Safety
    /// Both geoms live; the first is a sphere, the second a sphere or a plane.
    #[inline(always)]
    pub(super) unsafe fn ask(&mut self, first: sys::dGeomID, second: sys::dGeomID) -> bool {
        // SAFETY: the caller keeps both geoms alive, and there is room for the one contact that is requested.
        unsafe { sys::dCollide(first, second, 1, self.0.as_mut_ptr(), size_of::<sys::dContactGeom>() as c_int) > 0 }
    }

    /// The contact.
    ///
    /// # Safety
    /// The last [`Room::ask`] said there is one.
    pub(super) unsafe fn contact(&self) -> Contact {
        // SAFETY: if ODE counts a contact, it has written it.
        Contact::read(unsafe { self.0.assume_init_ref() })
    }
}

/// The contact of two bodies, if they touch.
///
/// # Safety
/// Both geoms live; the first is a sphere, the second a sphere or a plane.
#[inline]
pub(super) unsafe fn dcollide(first: sys::dGeomID, second: sys::dGeomID) -> Option<Contact> {
    let mut room = Room::new();
    // SAFETY: as the caller promises. The contact is read only if there is one.
    unsafe { room.ask(first, second).then(|| room.contact()) }
}
