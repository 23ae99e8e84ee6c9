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

    /// Calls `dCollide` and leaves the contact where ODE put it: what a benchmark times is the call and nothing else.
    ///
    /// # Safety
    /// Both geoms live; the first is a sphere, the second a sphere or a plane.
    #[inline(always)]
    pub(super) unsafe fn ask(&mut self, first: sys::dGeomID, second: sys::dGeomID) -> bool {
        // SAFETY: both geoms live (the caller's), and there is room for the one contact that is asked for.
        unsafe { sys::dCollide(first, second, 1, self.0.as_mut_ptr(), size_of::<sys::dContactGeom>() as c_int) > 0 }
    }

    /// The contact.
    ///
    /// # Safety
    /// The last [`Room::ask`] said there is one.
    pub(super) unsafe fn contact(&self) -> Contact {
        // SAFETY: where ODE counts a contact it wrote it.
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
    // SAFETY: the caller's; and the contact is read only where there is one.
    unsafe { room.ask(first, second).then(|| room.contact()) }
}
