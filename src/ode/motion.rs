//! Energy, momentum and angular momentum of a world, which a simulation must conserve.

use super::{World, sys};

/// Energy and momentum of all spheres of a world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Kinetic energy, of travel and of spin: mass · length² / time².
    pub energy: f64,
    /// The sum of mass times velocity: mass · length / time.
    pub momentum: [f64; 3],
    /// The angular momentum about the origin, of travel and of spin: mass · length² / time.
    pub angular: [f64; 3],
}

impl World {
    /// Energy and momentum of all spheres now, summed in `f64` in the order they were added.
    pub fn motion(&self) -> Motion {
        let mut sum = Motion::default();
        for sphere in self.spheres() {
            let body = self.spheres[sphere.index()].body;
            let mut mass = NONE;
            // SAFETY: the body lives as long as the world; velocities have three numbers and one of padding, and
            // `dBodyGetMass` writes the whole mass.
            let [velocity, spin]: [[f64; 3]; 2] = unsafe {
                sys::dBodyGetMass(body, &mut mass);
                [*sys::dBodyGetLinearVel(body).cast(), *sys::dBodyGetAngularVel(body).cast()]
            };
            // A sphere's inertia is the same about every axis.
            let inertia = mass.I[0];
            sum.energy += 0.5 * (mass.mass * dot(velocity, velocity) + inertia * dot(spin, spin));
            let travel = cross(self.position(sphere), velocity);
            for axis in 0..3 {
                sum.momentum[axis] += mass.mass * velocity[axis];
                sum.angular[axis] += mass.mass * travel[axis] + inertia * spin[axis];
            }
        }
        sum
    }
}

/// A mass before ODE writes it.
const NONE: sys::dMass = sys::dMass { mass: 0.0, c: [0.0; 4], I: [0.0; 12] };

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> [f64; 3] {
    [b * f - c * e, c * d - a * f, a * e - b * d]
}
