//! An engine that replaces ODE's collider of two spheres.
//!
//! ODE asks for one pair at a time, and an engine takes a batch. So the pairs of a step are gathered first and computed
//! at once. Then each still goes through ODE's `dCollide`, for which the answer is ready here.

use super::dcollide::dcollide;
use super::{Contact, sys};
use std::cell::Cell;
use std::ffi::c_int;

/// The answer that `dCollide` gives for a pair.
#[derive(Clone, Copy)]
struct Answer {
    first: sys::dGeomID,
    second: sys::dGeomID,
    contact: Option<Contact>,
}

thread_local! {
    static ANSWER: Cell<Option<Answer>> = const { Cell::new(None) };
}

/// Replaces ODE's collider by the stored answers, until ODE stops.
pub(super) fn install() {
    set(collide);
}

/// ODE must have been started by this thread: only [`super::Ode`] and tests that hold one call this.
fn set(collide: unsafe extern "C" fn(sys::dGeomID, sys::dGeomID, c_int, *mut sys::dContactGeom, c_int) -> c_int) {
    let sphere = sys::dSphereClass as c_int;
    // SAFETY: ODE is started, and the function has the expected type.
    unsafe { sys::dSetColliderOverride(sphere, sphere, Some(collide)) }
}

/// Sends a pair through ODE, with `contact` as the answer of the collider. Returns the contact as ODE returns it.
///
/// # Safety
/// `first` and `second` are two spheres that live.
pub(super) unsafe fn answer(first: sys::dGeomID, second: sys::dGeomID, contact: Option<Contact>) -> Option<Contact> {
    ANSWER.set(Some(Answer { first, second, contact }));
    // SAFETY: as the caller promises.
    let found = unsafe { dcollide(first, second) };
    ANSWER.set(None);
    found
}

/// The collider. ODE calls it from `dCollide`, which [`answer`] called.
///
/// For two equal classes, `dSetColliderOverride` marks the function as one that takes them in reverse. ODE then swaps
/// the geoms, calls, negates the normal and swaps the geoms of the contact. This function undoes all of it beforehand,
/// bit for bit, since negation is exact, also of zeros. It looks at which geom comes first and does not assume it.
unsafe extern "C" fn collide(
    o1: sys::dGeomID,
    o2: sys::dGeomID,
    _flags: c_int,
    contact: *mut sys::dContactGeom,
    _skip: c_int,
) -> c_int {
    let Some(Answer { first, second, contact: Some(mut found) }) = ANSWER.get() else { return 0 };
    if (o1, o2) == (second, first) {
        found.normal = found.normal.map(|component| -component);
    } else if (o1, o2) != (first, second) {
        return 0;
    }
    // SAFETY: `dcollide` gave ODE room for one contact, and ODE gives it here.
    unsafe { contact.write(found.raw(o1, o2)) };
    1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ode::{Collider, Ode, World};

    const COINCIDENT: Contact = Contact { position: [0.0; 3], normal: [1.0, 0.0, 0.0], depth: 1.0 };

    /// A collider as one would write it without knowing this.
    unsafe extern "C" fn naive(
        o1: sys::dGeomID,
        o2: sys::dGeomID,
        _: c_int,
        contact: *mut sys::dContactGeom,
        _: c_int,
    ) -> c_int {
        let Some(Answer { contact: Some(found), .. }) = ANSWER.get() else { return 0 };
        // SAFETY: as in `collide`.
        unsafe { contact.write(found.raw(o1, o2)) };
        1
    }

    fn bits(contact: Option<Contact>) -> Option<[u64; 3]> {
        contact.map(|contact| contact.normal.map(f64::to_bits))
    }

    #[test]
    fn ode_turns_an_override_round_and_it_is_turned_back() {
        let ode = Ode::start(Collider::Engine).unwrap();
        let mut world = World::new(&ode).unwrap();
        let [a, b] = [(); 2].map(|()| world.add_sphere([0.0; 3], 0.5, 1.0).unwrap());
        for (a, b) in [(a, b), (b, a)] {
            let [a, b] = world.geoms(a, b);
            let ask = |contact| unsafe { answer(a, b, contact) };
            set(naive);
            assert_eq!(bits(ask(Some(COINCIDENT))), Some([-1.0_f64, -0.0, -0.0].map(f64::to_bits)));
            set(collide);
            assert_eq!(bits(ask(Some(COINCIDENT))), bits(Some(COINCIDENT)));
            assert_eq!(ask(None), None);
        }
    }

    /// The geoms of the contact that ODE returns are in the order of the call.
    #[test]
    fn the_geoms_of_a_contact_are_in_order() {
        let ode = Ode::start(Collider::Engine).unwrap();
        let mut world = World::new(&ode).unwrap();
        let [a, b] = [(); 2].map(|()| world.add_sphere([0.0; 3], 0.5, 1.0).unwrap());
        let [a, b] = world.geoms(a, b);
        for (a, b) in [(a, b), (b, a)] {
            ANSWER.set(Some(Answer { first: a, second: b, contact: Some(COINCIDENT) }));
            let mut found = COINCIDENT.raw(std::ptr::null_mut(), std::ptr::null_mut());
            let count = unsafe { sys::dCollide(a, b, 1, &mut found, size_of::<sys::dContactGeom>() as c_int) };
            ANSWER.set(None);
            assert_eq!((count, found.g1, found.g2), (1, a, b));
        }
    }
}
