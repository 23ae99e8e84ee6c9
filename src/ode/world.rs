//! A world of spheres: bodies that ODE moves, and the space in which it finds pairs that are close.

use super::contact::{Surface, Touch};
use super::dcollide::dcollide;
use super::effects::Plane;
use super::numbers::{LARGEST, positive, signed, within};
use super::{Collider, Contact, Error, Ode, sys};
use std::any::Any;
use std::ffi::{c_int, c_ulong, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// A sphere of a world, identified by the order in which it was added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Sphere(pub(super) usize);

impl Sphere {
    /// The number of the sphere in its world, from 0.
    pub const fn index(self) -> usize {
        self.0
    }
}

#[derive(Debug)]
pub(super) struct Parts {
    pub(super) body: sys::dBodyID,
    pub(super) geom: sys::dGeomID,
    radius: f64,
}

/// How ODE finds pairs that are close.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BroadPhase {
    /// ODE's hash space: cells of several sizes.
    #[default]
    Hash,
    /// ODE's sweep-and-prune space: boxes sorted along x.
    SweepAndPrune,
}

impl BroadPhase {
    /// A space without geoms, or null if ODE has no memory.
    ///
    /// # Safety
    /// ODE is started.
    unsafe fn space(self) -> sys::dSpaceID {
        // No space is the parent of this one. The axes of the other space are ODE's dSAP_AXES_XYZ.
        const AXES_XYZ: c_int = 1 << 2 | 2 << 4;
        let parent = std::ptr::null_mut();
        // SAFETY: as the caller promises.
        unsafe {
            match self {
                Self::Hash => sys::dHashSpaceCreate(parent),
                Self::SweepAndPrune => sys::dSweepAndPruneSpaceCreate(parent, AXES_XYZ),
            }
        }
    }
}

/// Spheres. Gravity and the effects after [`World::set_gravity`] are off until they are set.
///
/// Two worlds that are built and stepped in the same way give the same bits, however many others exist. Each keeps its
/// own position in the random numbers of ODE's solver.
///
/// # Panics
/// Its functions panic if the sphere belongs to a world with more spheres.
#[derive(Debug)]
pub struct World {
    id: sys::dWorldID,
    space: sys::dSpaceID,
    joints: sys::dJointGroupID,
    pub(super) spheres: Vec<Parts>,
    /// Planes that spheres cannot pass.
    pub(super) walls: Vec<Plane>,
    /// True if spheres fall asleep.
    pub(super) spheres_sleep: bool,
    /// The state of ODE's random numbers.
    seed: c_ulong,
    /// Must be dropped last.
    pub(super) ode: Ode,
}

impl World {
    /// A world without spheres. Its broad phase is ODE's hash space.
    ///
    /// # Errors
    /// Returns an error if ODE has no memory.
    pub fn new(ode: &Ode) -> Result<Self, Error> {
        Self::with_broad_phase(ode, BroadPhase::Hash)
    }

    /// A world without spheres, with this broad phase. The choice changes the time and the order of pairs.
    ///
    /// # Errors
    /// Returns an error if ODE has no memory.
    pub fn with_broad_phase(ode: &Ode, broad_phase: BroadPhase) -> Result<Self, Error> {
        // SAFETY: ODE is started.
        let (id, space, joints) = unsafe { (sys::dWorldCreate(), broad_phase.space(), sys::dJointGroupCreate(0)) };
        if id.is_null() || space.is_null() || joints.is_null() {
            return Err(Error::Memory);
        }
        Ok(Self {
            id,
            space,
            joints,
            spheres: Vec::new(),
            walls: Vec::new(),
            spheres_sleep: false,
            seed: 0,
            ode: ode.clone(),
        })
    }

    pub(super) fn id(&self) -> sys::dWorldID {
        self.id
    }

    /// Sets the number of iterations of ODE's QuickStep; the default is 20.
    ///
    /// # Errors
    /// Returns an error if the number is zero or more than a million.
    pub fn set_iterations(&mut self, iterations: u32) -> Result<(), Error> {
        within("the number of iterations", iterations.into(), 1.0..=1e6)?;
        // SAFETY: the world lives.
        unsafe { sys::dWorldSetQuickStepNumIterations(self.id, iterations as c_int) };
        Ok(())
    }

    /// Adds a sphere at rest. Its mass follows from its volume and this density.
    ///
    /// # Errors
    /// Returns an error if a number is out of range, or ODE has no memory.
    pub fn add_sphere(&mut self, centre: [f64; 3], radius: f64, density: f64) -> Result<Sphere, Error> {
        let [x, y, z] = signed("a coordinate", centre)?;
        positive("a radius", radius)?;
        positive("a density", density)?;
        let sphere = Sphere(self.spheres.len());
        // SAFETY: world and space live; `dMassSetSphere` writes the whole mass, whose numbers are in range.
        unsafe {
            let body = sys::dBodyCreate(self.id);
            let geom = sys::dCreateSphere(self.space, radius);
            if body.is_null() || geom.is_null() {
                return Err(Error::Memory);
            }
            let mut mass = std::mem::zeroed();
            sys::dMassSetSphere(&mut mass, density, radius);
            sys::dBodySetMass(body, &mass);
            sys::dBodySetPosition(body, x, y, z);
            sys::dGeomSetBody(geom, body);
            // This is a number, not an address. The near callback reads it back.
            sys::dGeomSetData(geom, std::ptr::without_provenance_mut(sphere.0));
            self.spheres.push(Parts { body, geom, radius });
        }
        Ok(sphere)
    }

    /// Every sphere, in the order they were added.
    pub fn spheres(&self) -> impl ExactSizeIterator<Item = Sphere> + use<> {
        (0..self.spheres.len()).map(Sphere)
    }

    /// The centre of a sphere.
    pub fn position(&self, sphere: Sphere) -> [f64; 3] {
        // SAFETY: the body lives as long as the world, and a position has three numbers and one of padding.
        unsafe { *sys::dBodyGetPosition(self.spheres[sphere.0].body).cast() }
    }

    /// The radius of a sphere.
    pub fn radius(&self, sphere: Sphere) -> f64 {
        self.spheres[sphere.0].radius
    }

    /// Adds to the force on a sphere's centre during the next step. A sleeping sphere gets no force, because ODE would
    /// keep it, and apply the forces of all steps when the sphere wakes.
    ///
    /// # Errors
    /// Returns an error if a number is out of range.
    pub fn add_force(&mut self, sphere: Sphere, force: [f64; 3]) -> Result<(), Error> {
        let [x, y, z] = signed("a force", force)?;
        if self.is_asleep(sphere) {
            return Ok(());
        }
        // SAFETY: the body lives as long as the world.
        unsafe { sys::dBodyAddForce(self.spheres[sphere.0].body, x, y, z) };
        Ok(())
    }

    /// Calls `visit` for every two spheres whose bounding boxes touch, in ODE's order: ODE's near callback.
    ///
    /// Within it [`World::collide`] and [`World::join`] may be called, as in any program of ODE's.
    ///
    /// # Errors
    /// Returns an error if a sphere is lost: see [`World::step`].
    pub fn near(&self, mut visit: impl FnMut(Sphere, Sphere)) -> Result<(), Error> {
        self.all_in_reach()?;
        let mut near = Near { visit: &mut visit, panic: None };
        // SAFETY: the space lives. The callback gets the pointer that is given here, while `near` lives.
        unsafe { sys::dSpaceCollide(self.space, (&raw mut near).cast(), Some(near_callback)) };
        if let Some(panic) = near.panic {
            resume_unwind(panic);
        }
        Ok(())
    }

    /// The pairs that [`World::near`] visits, without those of two spheres that sleep.
    ///
    /// # Errors
    /// Returns an error if a sphere is lost: see [`World::step`].
    pub fn candidates(&self) -> Result<Vec<[Sphere; 2]>, Error> {
        let mut pairs = Vec::new();
        self.near(|first, second| {
            if !(self.spheres_sleep && self.is_asleep(first) && self.is_asleep(second)) {
                pairs.push([first, second]);
            }
        })?;
        Ok(pairs)
    }

    /// The contact of two spheres by ODE's own collider.
    ///
    /// # Errors
    /// Returns an error if ODE runs without it.
    #[inline]
    pub fn collide(&self, first: Sphere, second: Sphere) -> Result<Option<Contact>, Error> {
        self.ode.needs(Collider::Own)?;
        Ok(self.dcollide(first, second))
    }

    /// ODE's geoms of two spheres, which live as long as the world.
    pub(super) fn geoms(&self, first: Sphere, second: Sphere) -> [sys::dGeomID; 2] {
        [first, second].map(|sphere| self.spheres[sphere.0].geom)
    }

    #[inline]
    fn dcollide(&self, first: Sphere, second: Sphere) -> Option<Contact> {
        let [first, second] = self.geoms(first, second);
        // SAFETY: both geoms live as long as the world.
        unsafe { dcollide(first, second) }
    }

    /// Every present contact, by ODE's own collider.
    ///
    /// # Errors
    /// Returns an error if ODE runs without it, or a sphere is lost: see [`World::step`].
    pub fn contacts(&self) -> Result<Vec<Touch>, Error> {
        self.ode.needs(Collider::Own)?;
        let mut touches = Vec::new();
        self.near(|first, second| {
            if let Some(contact) = self.dcollide(first, second) {
                touches.push(Touch { first, second, contact });
            }
        })?;
        Ok(touches)
    }

    /// Makes the next step separate two touching spheres, by ODE's contact joint.
    ///
    /// # Errors
    /// Returns an error if the contact has an impossible number or is of a sphere with itself, or if a number of the
    /// surface is out of range.
    pub fn join(&self, touch: &Touch, surface: &Surface) -> Result<(), Error> {
        let Touch { first, second, contact } = touch;
        let [one, other] = [first, second].map(|sphere| &self.spheres[sphere.0]);
        if first == second {
            return Err(Error::Itself(first.0));
        }
        if !contact.is_plausible() {
            return Err(Error::Contact { first: first.0, second: second.0 });
        }
        // SAFETY: both bodies live, and differ.
        unsafe { self.attach(contact, surface, [one.geom, other.geom], [one.body, other.body]) }
    }

    /// A contact joint.
    ///
    /// # Safety
    /// The bodies live and differ, or the second is null; the geoms live.
    pub(super) unsafe fn attach(
        &self,
        contact: &Contact,
        surface: &Surface,
        [g1, g2]: [sys::dGeomID; 2],
        [one, other]: [sys::dBodyID; 2],
    ) -> Result<(), Error> {
        within("a friction", surface.friction, 0.0..=LARGEST)?;
        within("a bounce", surface.bounce, 0.0..=1.0)?;
        within("a bounce's speed", surface.bounce_speed, 0.0..=LARGEST)?;
        let contact = sys::dContact { surface: surface.raw(), geom: contact.raw(g1, g2), fdir1: [0.0; 4] };
        // SAFETY: world and joints live, and the caller promises the rest. ODE copies the contact.
        unsafe {
            let joint = sys::dJointCreateContact(self.id, self.joints, &contact);
            if joint.is_null() {
                return Err(Error::Memory);
            }
            sys::dJointAttach(joint, one, other);
        }
        Ok(())
    }

    /// Moves every sphere through a time step by ODE's QuickStep. Afterwards there are no forces and no joints.
    ///
    /// # Errors
    /// Returns an error if ODE has no memory, or if a sphere is then beyond ODE's space. Such a world cannot be used
    /// any more.
    pub fn step(&mut self, time: f64) -> Result<(), Error> {
        positive("a step's time", time)?;
        self.all_in_reach()?;
        // SAFETY: world and joints live; ODE is this thread's, and so are its random numbers.
        let done = unsafe {
            sys::dRandSetSeed(self.seed);
            let done = sys::dWorldQuickStep(self.id, time);
            self.seed = sys::dRandGetSeed();
            sys::dJointGroupEmpty(self.joints);
            done != 0
        };
        if !done {
            return Err(Error::Memory);
        }
        self.all_in_reach()
    }

    /// A NaN or a far sphere would end the process in ODE's broad phase.
    pub(super) fn all_in_reach(&self) -> Result<(), Error> {
        let in_reach = |position: &[f64; 3]| position.iter().all(|v| v.abs() <= LARGEST);
        match self.spheres().find(|&sphere| !in_reach(&self.position(sphere))) {
            None => Ok(()),
            Some(sphere) => Err(Error::Lost { sphere: sphere.0, position: self.position(sphere) }),
        }
    }
}

impl Drop for World {
    fn drop(&mut self) {
        // SAFETY: each was created in `new` and is destroyed once: first the joints, which refer to bodies, then the
        // space with its geoms, which also do, and then the world with its bodies. ODE runs until `ode` is dropped,
        // after this.
        unsafe {
            sys::dJointGroupDestroy(self.joints);
            self.destroy_walls();
            sys::dSpaceDestroy(self.space);
            sys::dWorldDestroy(self.id);
        }
    }
}

struct Near<'a> {
    visit: &'a mut dyn FnMut(Sphere, Sphere),
    panic: Option<Box<dyn Any + Send>>,
}

/// # Safety
/// `data` is a `Near` that nothing else uses meanwhile, and both geoms are of a world.
unsafe extern "C" fn near_callback(data: *mut c_void, o1: sys::dGeomID, o2: sys::dGeomID) {
    // SAFETY: as the caller promises.
    let (near, first, second) =
        unsafe { (&mut *data.cast::<Near>(), sys::dGeomGetData(o1).addr(), sys::dGeomGetData(o2).addr()) };
    // A panic must not unwind through ODE. It is kept here until ODE returns.
    if near.panic.is_none() {
        let visited = catch_unwind(AssertUnwindSafe(|| (near.visit)(Sphere(first), Sphere(second))));
        near.panic = visited.err();
    }
}
