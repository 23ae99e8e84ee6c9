//! The energy of a world's bodies, kinetic and in the field of gravity.

use super::{Balance, Ball, Scene};
use crate::ode::World;

/// The share of kinetic energy that the arithmetic of contacts may add.
const ARITHMETIC: f64 = 0.01;
/// The part of a radius by which bodies at rest may be lifted.
const LIFT: f64 = 0.01;

impl Balance {
    pub(super) fn begin(scene: &Scene, world: &World, bodies: &[Ball]) -> Self {
        let start = Sum::of(scene, world, bodies);
        let allowance = ARITHMETIC * start.kinetic;
        Self { start: start.kinetic + start.potential, end: 0.0, work: 0.0, allowance }
    }

    pub(super) fn finish(&mut self, scene: &Scene, world: &World, bodies: &[Ball]) {
        let end = Sum::of(scene, world, bodies);
        self.end = end.kinetic + end.potential;
        self.allowance += ARITHMETIC * end.kinetic + end.field;
    }
}

/// The energy of all bodies.
struct Sum {
    kinetic: f64,
    potential: f64,
    /// The energy of the field that may be in excess.
    field: f64,
}

impl Sum {
    fn of(scene: &Scene, world: &World, bodies: &[Ball]) -> Self {
        let gravity = scene.effects.gravity.as_ref().map_or([0.0; 3], |gravity| gravity.value);
        let length = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let mut sum = Self { kinetic: world.motion().energy, potential: 0.0, field: 0.0 };
        for (sphere, ball) in world.spheres().zip(bodies) {
            let place = world.position(sphere);
            sum.potential -= ball.mass * (0..3).map(|axis| gravity[axis] * place[axis]).sum::<f64>();
            let way = length(world.velocity(sphere)) * scene.time_step.value + LIFT * ball.radius;
            sum.field += ball.mass * length(gravity) * way;
        }
        sum
    }
}
