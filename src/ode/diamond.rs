//! The paper's simulation: spheres in the shape of an octahedron (the diamond), each pulled to its centre.

use super::contact::{Surface, Touch};
use super::numbers::{LARGEST, positive, within};
use super::{Error, Ode, Sphere, World};
use crate::pairs::octahedron;

/// The most layers. With more, the table of tested pairs in ODE's hash space exceeds a gigabyte.
const MOST_LAYERS: u32 = 40;

/// Spheres on the points of an octahedron's lattice, and the forces that make them collide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diamond {
    /// The paper's hMax: layers of spheres from the centre to a tip, including the centre. From 1 to 40.
    pub layers: u32,
    /// The paper's dSph: the gap between neighbours along an axis, a length. At 0 they touch exactly. At minus a
    /// sphere's diameter, the minimum, all centres coincide.
    pub gap: f64,
    /// Radius of every sphere, a length.
    pub radius: f64,
    /// Mass per volume of every sphere.
    pub density: f64,
    /// The force on every sphere in every step. It points in the direction from the sphere to the diamond's centre at
    /// the start. The sphere in the centre has no force.
    pub force: f64,
    /// The number of steps, from the first, in which the force acts.
    pub force_steps: usize,
    /// The time of a step.
    pub time_step: f64,
    /// Iterations of ODE's QuickStep.
    pub iterations: u32,
    /// The surface of the spheres, which decides the effect of a contact.
    pub surface: Surface,
}

impl Diamond {
    /// The paper's diamond, with layers and gap from its text. The text does not give the rest, which is chosen here:
    /// radius ½, so that at first every number is exact in binary32; density and force 1; steps of 1/100; 20
    /// iterations, ODE's default; no friction.
    pub const fn new(layers: u32, gap: f64) -> Self {
        let surface = Surface::SMOOTH;
        Self {
            layers,
            gap,
            radius: 0.5,
            density: 1.0,
            force: 1.0,
            force_steps: usize::MAX,
            time_step: 0.01,
            iterations: 20,
            surface,
        }
    }

    /// The spheres, at rest.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range.
    pub fn build(&self, ode: &Ode) -> Result<Simulation, Error> {
        within("the number of layers", self.layers.into(), 1.0..=MOST_LAYERS.into())?;
        positive("a radius", self.radius)?;
        within("the gap between spheres", self.gap, -2.0 * self.radius..=LARGEST)?;
        within("a force", self.force, 0.0..=LARGEST)?;
        positive("a step's time", self.time_step)?;
        let mut world = World::new(ode)?;
        world.set_iterations(self.iterations)?;
        let pitch = 2.0 * self.radius + self.gap;
        let mut forces = Vec::new();
        for point in octahedron(self.layers as i32 - 1) {
            let [x, y, z] = point.map(f64::from);
            world.add_sphere([x, y, z].map(|v| v * pitch), self.radius, self.density)?;
            let distance = ((x * x + y * y) + z * z).sqrt();
            forces.push(if distance > 0.0 { [x, y, z].map(|v| -v / distance * self.force) } else { [0.0; 3] });
        }
        Ok(Simulation { world, forces, diamond: *self, steps: 0 })
    }
}

/// A diamond that is being simulated.
#[derive(Debug)]
pub struct Simulation {
    world: World,
    forces: Vec<[f64; 3]>,
    diamond: Diamond,
    steps: usize,
}

impl Simulation {
    /// The world of its spheres, with their contacts before each step.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The number of steps done.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// The positions of all spheres.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + '_ {
        self.world.spheres().map(|sphere| self.world.position(sphere))
    }

    /// Runs one step, in which the spheres of `touches` separate.
    ///
    /// # Errors
    /// Returns an error if a contact is invalid, ODE has no memory, or a sphere is lost.
    pub fn advance(&mut self, touches: &[Touch]) -> Result<(), Error> {
        let spheres: Vec<Sphere> = self.world.spheres().collect();
        if self.steps < self.diamond.force_steps {
            for (sphere, force) in spheres.into_iter().zip(&self.forces) {
                self.world.add_force(sphere, *force)?;
            }
        }
        for touch in touches {
            self.world.join(touch, &self.diamond.surface)?;
        }
        self.world.step(self.diamond.time_step)?;
        self.steps += 1;
        Ok(())
    }
}
