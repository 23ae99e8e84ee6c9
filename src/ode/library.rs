//! Starts and stops ODE.
//!
//! ODE has state for the whole process: whether it is started, which function collides two spheres, and the random
//! numbers with which its solver reorders constraints. So only one thread has it at a time, and others wait.

use super::{Error, replace, sys};
use std::cell::RefCell;
use std::fmt;
use std::rc::{Rc, Weak};
use std::sync::{Condvar, Mutex, PoisonError};

/// The collider of two spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Collider {
    /// ODE's own function.
    Own,
    /// An [`Engine`](crate::kernel::Engine), through ODE's collider override.
    Engine,
}

impl fmt::Display for Collider {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Own => "its own collider",
            Self::Engine => "an engine in its collider's place",
        })
    }
}

/// The started library. It stops when the last clone and everything made from it is dropped.
///
/// ODE can restore its own collider only by a restart, so all that live at the same time have the same collider.
#[derive(Clone, Debug)]
pub struct Ode {
    guard: Rc<LibraryGuard>,
}

#[derive(Debug)]
struct LibraryGuard {
    collider: Collider,
}

/// True while a thread has ODE.
static TAKEN: Mutex<bool> = Mutex::new(false);
static RETURNED: Condvar = Condvar::new();

thread_local! {
    /// The guard of this thread, if it has one.
    static GUARD: RefCell<Weak<LibraryGuard>> = const { RefCell::new(Weak::new()) };
}

impl Ode {
    /// ODE with this collider: the running one, if this thread has it, or a new start.
    ///
    /// This call waits while another thread has ODE. So a thread that has ODE must not wait for one that wants it.
    ///
    /// # Errors
    /// Returns an error if this thread has ODE with another collider, or if the library cannot be started or has single
    /// precision.
    pub fn start(collider: Collider) -> Result<Self, Error> {
        if let Some(guard) = GUARD.with_borrow(Weak::upgrade) {
            let ode = Self { guard };
            return ode.needs(collider).map(|()| ode);
        }
        let mut taken = TAKEN.lock().unwrap_or_else(PoisonError::into_inner);
        while *taken {
            taken = RETURNED.wait(taken).unwrap_or_else(PoisonError::into_inner);
        }
        initialise()?;
        *taken = true;
        let guard = Rc::new(LibraryGuard { collider });
        GUARD.set(Rc::downgrade(&guard));
        if collider == Collider::Engine {
            replace::install();
        }
        Ok(Self { guard })
    }

    /// The collider of two spheres.
    pub fn collider(&self) -> Collider {
        self.guard.collider
    }

    /// Returns an error unless ODE runs with the wanted collider.
    pub(super) fn needs(&self, wanted: Collider) -> Result<(), Error> {
        let running = self.guard.collider;
        if running == wanted { Ok(()) } else { Err(Error::OtherCollider { running, wanted }) }
    }
}

fn initialise() -> Result<(), Error> {
    // SAFETY: the string ends with a zero. ODE is not started yet, and only this thread starts it, because it holds the
    // lock.
    unsafe {
        if sys::dCheckConfiguration(c"ODE_double_precision".as_ptr()) == 0 {
            return Err(Error::SinglePrecision);
        }
        if sys::dInitODE2(0) == 0 {
            return Err(Error::Start);
        }
        if sys::dAllocateODEDataForThread(sys::dAllocateMaskAll as u32) == 0 {
            sys::dCloseODE();
            return Err(Error::Start);
        }
    }
    Ok(())
}

impl Drop for LibraryGuard {
    fn drop(&mut self) {
        let mut taken = TAKEN.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: started in `start`, by this thread. Everything made from ODE holds an `Ode`, so nothing is left.
        unsafe { sys::dCloseODE() };
        *taken = false;
        RETURNED.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_has_one_collider_at_a_time() {
        let own = Ode::start(Collider::Own).unwrap();
        let again = Ode::start(Collider::Own).unwrap();
        let error = Ode::start(Collider::Engine).unwrap_err();
        assert!(matches!(error, Error::OtherCollider { running: Collider::Own, wanted: Collider::Engine }), "{error}");
        drop(own);
        assert!(Ode::start(Collider::Engine).is_err(), "a clone is left");
        drop(again);
        assert_eq!(Ode::start(Collider::Engine).unwrap().collider(), Collider::Engine);
    }

    #[test]
    fn threads_take_turns() {
        let mine = Ode::start(Collider::Own).unwrap();
        let other = std::thread::spawn(|| Ode::start(Collider::Engine).map(|ode| ode.collider()).unwrap());
        std::thread::sleep(std::time::Duration::from_millis(20));
        assert!(!other.is_finished());
        drop(mine);
        assert_eq!(other.join().unwrap(), Collider::Engine);
    }
}
