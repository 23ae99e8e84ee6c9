//! Optional effects of a world: gravity, damping, sleep, walls. Without an effect, ODE's functions for it are never
//! called.

use super::dcollide::dcollide;
use super::numbers::{LARGEST, signed, within};
use super::{Contact, Error, Sphere, Surface, World, sys};
use std::ffi::c_int;

/// When a sphere falls asleep: ODE's auto-disable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sleep {
    /// Speed below which it counts as idle, length / time.
    pub speed: f64,
    /// Angular speed below which it counts as idle, 1 / time.
    pub turning: f64,
    /// The number of steps for which it must be idle.
    pub steps: u32,
}

impl Sleep {
    /// ODE's defaults.
    pub const USUAL: Self = Self { speed: 0.01, turning: 0.01, steps: 10 };
}

/// A wall: a plane that spheres cannot pass.
#[derive(Debug)]
pub(super) struct Plane {
    geom: sys::dGeomID,
    normal: [f64; 3],
    offset: f64,
}

/// A sphere that touches a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallTouch {
    /// The sphere; the normal points into it.
    pub sphere: Sphere,
    /// The contact.
    pub contact: Contact,
}

impl World {
    /// The acceleration of every sphere in every step, length / time²: `dWorldSetGravity`.
    ///
    /// # Errors
    /// Returns an error if a number is out of range.
    pub fn set_gravity(&mut self, gravity: [f64; 3]) -> Result<(), Error> {
        let [x, y, z] = signed("gravity", gravity)?;
        // SAFETY: the world lives.
        unsafe { sys::dWorldSetGravity(self.id(), x, y, z) };
        Ok(())
    }

    /// The share of its speed and of its angular speed that every sphere loses in a step: `dWorldSetDamping`.
    ///
    /// # Errors
    /// Returns an error if the share is out of range.
    pub fn set_damping(&mut self, part: f64) -> Result<(), Error> {
        within("damping", part, 0.0..=1.0)?;
        // SAFETY: the world lives. Without thresholds, all speeds are damped.
        unsafe {
            sys::dWorldSetDamping(self.id(), part, part);
            sys::dWorldSetLinearDampingThreshold(self.id(), 0.0);
            sys::dWorldSetAngularDampingThreshold(self.id(), 0.0);
        }
        Ok(())
    }

    /// Sets the share of an overlap that a step corrects, 0 to 1, and the softness of contacts: ODE's ERP and CFM.
    ///
    /// # Errors
    /// Returns an error if a number is out of range.
    pub fn set_stiffness(&mut self, error_reduction: f64, force_mixing: f64) -> Result<(), Error> {
        within("error reduction", error_reduction, 0.0..=1.0)?;
        within("force mixing", force_mixing, 0.0..=1.0)?;
        // SAFETY: the world lives.
        unsafe {
            sys::dWorldSetERP(self.id(), error_reduction);
            sys::dWorldSetCFM(self.id(), force_mixing);
        }
        Ok(())
    }

    /// Lets spheres that are added afterwards fall asleep. Two sleeping spheres are not candidates.
    ///
    /// # Errors
    /// Returns an error if a number is out of range.
    pub fn set_sleep(&mut self, sleep: &Sleep) -> Result<(), Error> {
        within("the speed of sleep", sleep.speed, 0.0..=LARGEST)?;
        within("the turning of sleep", sleep.turning, 0.0..=LARGEST)?;
        within("the steps to sleep", sleep.steps.into(), 1.0..=1e6)?;
        // SAFETY: the world lives.
        unsafe {
            sys::dWorldSetAutoDisableFlag(self.id(), 1);
            sys::dWorldSetAutoDisableLinearThreshold(self.id(), sleep.speed);
            sys::dWorldSetAutoDisableAngularThreshold(self.id(), sleep.turning);
            sys::dWorldSetAutoDisableSteps(self.id(), sleep.steps as c_int);
            sys::dWorldSetAutoDisableTime(self.id(), 0.0);
        }
        self.spheres_sleep = true;
        Ok(())
    }

    /// True if a sphere sleeps.
    pub fn is_asleep(&self, sphere: Sphere) -> bool {
        // SAFETY: the body lives as long as the world.
        self.spheres_sleep && unsafe { sys::dBodyIsEnabled(self.spheres[sphere.index()].body) == 0 }
    }

    /// Sets a sphere's velocity, length / time, and its angular velocity, radians / time.
    ///
    /// # Errors
    /// Returns an error if a number is out of range.
    pub fn set_velocity(&mut self, sphere: Sphere, velocity: [f64; 3], turning: [f64; 3]) -> Result<(), Error> {
        let [x, y, z] = signed("a velocity", velocity)?;
        let [a, b, c] = signed("an angular velocity", turning)?;
        let body = self.spheres[sphere.index()].body;
        // SAFETY: the body lives as long as the world.
        unsafe {
            sys::dBodySetLinearVel(body, x, y, z);
            sys::dBodySetAngularVel(body, a, b, c);
        }
        Ok(())
    }

    /// Prevents all present spheres from turning.
    pub fn forbid_turning(&mut self) {
        for parts in &self.spheres {
            // SAFETY: the body lives as long as the world.
            unsafe { sys::dBodySetMaxAngularSpeed(parts.body, 0.0) };
        }
    }

    /// A sphere's velocity, length / time.
    pub fn velocity(&self, sphere: Sphere) -> [f64; 3] {
        // SAFETY: the body lives as long as the world, and a velocity has three numbers and one of padding.
        unsafe { *sys::dBodyGetLinearVel(self.spheres[sphere.index()].body).cast() }
    }

    /// A sphere's orientation as a unit quaternion: scalar part, then the vector.
    pub fn orientation(&self, sphere: Sphere) -> [f64; 4] {
        // SAFETY: the body lives as long as the world, and a quaternion has four numbers.
        unsafe { *sys::dBodyGetQuaternion(self.spheres[sphere.index()].body).cast() }
    }

    /// Adds a wall: spheres stay where `normal` · position ≥ `offset`. The normal is an axis or its opposite, or any
    /// unit vector.
    ///
    /// # Errors
    /// Returns an error if a number is out of range, or ODE has no memory.
    pub fn add_wall(&mut self, normal: [f64; 3], offset: f64) -> Result<(), Error> {
        let [a, b, c] = signed("a wall's normal", normal)?;
        within("the length of a wall's normal", a * a + b * b + c * c, 0.999_999..=1.000_001)?;
        within("a wall's place", offset, -LARGEST..=LARGEST)?;
        // SAFETY: ODE is started. The plane is in no space, because it is tested against every sphere, and there are
        // few walls.
        let geom = unsafe { sys::dCreatePlane(std::ptr::null_mut(), a, b, c, offset) };
        if geom.is_null() {
            return Err(Error::Memory);
        }
        self.walls.push(Plane { geom, normal, offset });
        Ok(())
    }

    /// Every contact of a sphere with a wall, by ODE's own collider of sphere and plane, in the order of the spheres.
    /// Sleeping spheres have no contacts.
    pub fn wall_contacts(&self) -> Vec<WallTouch> {
        let mut touches = Vec::new();
        if self.walls.is_empty() {
            return touches;
        }
        for sphere in self.spheres() {
            let [x, y, z] = self.position(sphere);
            for wall in &self.walls {
                let [a, b, c] = wall.normal;
                if a * x + b * y + c * z - wall.offset > self.radius(sphere) || self.is_asleep(sphere) {
                    continue;
                }
                // SAFETY: both geoms live as long as the world.
                let contact = unsafe { dcollide(self.spheres[sphere.index()].geom, wall.geom) };
                touches.extend(contact.map(|contact| WallTouch { sphere, contact }));
            }
        }
        touches
    }

    /// Makes the next step separate a sphere and a wall.
    ///
    /// # Errors
    /// Returns the errors of [`World::join`].
    pub fn join_wall(&self, touch: &WallTouch, surface: &Surface) -> Result<(), Error> {
        let parts = &self.spheres[touch.sphere.index()];
        let wall = self.walls.first().map_or(std::ptr::null_mut(), |wall| wall.geom);
        // SAFETY: the bodies live; ODE takes a null second body for the world itself.
        unsafe { self.attach(&touch.contact, surface, [parts.geom, wall], [parts.body, std::ptr::null_mut()]) }
    }

    /// Destroys the geoms of the walls with the world.
    ///
    /// # Safety
    /// Once, and no wall is used afterwards.
    pub(super) unsafe fn destroy_walls(&mut self) {
        for wall in self.walls.drain(..) {
            // SAFETY: created in `add_wall`; the caller promises the rest.
            unsafe { sys::dGeomDestroy(wall.geom) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ode::{Collider, Ode};

    fn world() -> (Ode, World) {
        let ode = Ode::start(Collider::Own).unwrap();
        let world = World::new(&ode).unwrap();
        (ode, world)
    }

    #[test]
    fn a_sphere_falls_bounces_off_the_floor_and_comes_to_rest_asleep() {
        let (_ode, mut world) = world();
        world.set_gravity([0.0, 0.0, -10.0]).unwrap();
        world.set_sleep(&Sleep::USUAL).unwrap();
        world.add_wall([0.0, 0.0, 1.0], 0.0).unwrap();
        let sphere = world.add_sphere([0.0, 0.0, 1.0], 0.5, 1.0).unwrap();
        let surface = Surface { bounce: 0.5, bounce_speed: 0.1, ..Surface::SMOOTH };
        let (mut rose, mut before) = (false, 0.0);
        for _ in 0..1000 {
            for touch in world.wall_contacts() {
                assert_eq!(touch.contact.normal, [0.0, 0.0, 1.0]);
                world.join_wall(&touch, &surface).unwrap();
            }
            world.step(0.01).unwrap();
            rose |= before < -0.5 && world.velocity(sphere)[2] > 0.5;
            before = world.velocity(sphere)[2];
        }
        assert!(rose, "it bounced");
        assert!((world.position(sphere)[2] - 0.5).abs() < 0.01, "it rests on the floor: {:?}", world.position(sphere));
        assert!(world.is_asleep(sphere) && world.wall_contacts().is_empty());
    }

    /// This was once a fault: ODE kept the forces on a sleeping sphere, and applied all of them when it woke.
    #[test]
    fn forces_do_not_gather_while_a_sphere_sleeps() {
        let (_ode, mut world) = world();
        world.set_sleep(&Sleep::USUAL).unwrap();
        // ODE lets only spheres with a joint sleep, so both lie on a floor.
        world.set_gravity([0.0, 0.0, -10.0]).unwrap();
        world.add_wall([0.0, 0.0, 1.0], 0.0).unwrap();
        let still = world.add_sphere([0.0, 0.0, 0.5], 0.5, 1.0).unwrap();
        let comes = world.add_sphere([3.0, 0.0, 0.5], 0.5, 1.0).unwrap();
        world.set_velocity(comes, [-2.0, 0.0, 0.0], [0.0; 3]).unwrap();
        let mut slept = 0;
        for _ in 0..200 {
            if world.is_asleep(still) {
                world.add_force(still, [0.0, 1.0, 0.0]).unwrap();
                slept += 1;
            }
            for touch in world.contacts().unwrap() {
                world.join(&touch, &Surface::SMOOTH).unwrap();
            }
            for touch in world.wall_contacts() {
                world.join_wall(&touch, &Surface::SMOOTH).unwrap();
            }
            world.step(0.01).unwrap();
        }
        let [x, y, _] = world.velocity(still);
        assert!(slept > 50 && x < -0.5, "it slept {slept} steps, and was pushed to {x}");
        assert_eq!(y, 0.0);
    }

    #[test]
    fn damping_and_no_turning_do_what_they_say() {
        let (_ode, mut world) = world();
        world.set_damping(0.1).unwrap();
        let [turns, not] = [0.0, 5.0].map(|x| world.add_sphere([x, 0.0, 0.0], 0.5, 1.0).unwrap());
        world.forbid_turning();
        let late = world.add_sphere([10.0, 0.0, 0.0], 0.5, 1.0).unwrap();
        for sphere in [turns, not, late] {
            world.set_velocity(sphere, [1.0, 0.0, 0.0], [0.0, 0.0, 2.0]).unwrap();
        }
        world.step(0.01).unwrap();
        assert!((world.velocity(not)[0] - 0.9).abs() < 1e-12);
        // Kinetic energy of one sphere's turning is left, of the one that may turn.
        let mass = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
        let travel = 3.0 * 0.5 * mass * 0.81;
        let turning = 0.5 * (0.4 * mass * 0.25) * (2.0_f64 * 0.9).powi(2);
        assert!((world.motion().energy - travel - turning).abs() < 1e-9, "{}", world.motion().energy);
    }
}
