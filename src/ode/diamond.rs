//! The paper's simulation: spheres in the form of a diamond, each drawn to its centre.

use super::contact::{Surface, Touch};
use super::numbers::{LARGEST, positive, within};
use super::{Error, Ode, Sphere, World};
use crate::pairs::octahedron;

/// The most layers: beyond, the table of tested pairs in ODE's hash space outgrows a gigabyte.
const MOST_LAYERS: u32 = 40;

/// Spheres on the points of an octahedron's lattice, and the forces that make them collide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diamond {
    /// The paper's hMax: layers of spheres from the centre to a tip, that of the centre included. From 1 to 40.
    pub layers: u32,
    /// The paper's dSph: the gap between neighbours along an axis, a length. At 0 they touch exactly; at minus a
    /// sphere's diameter, the least, all centres coincide.
    pub gap: f64,
    /// Radius of every sphere, a length.
    pub radius: f64,
    /// Mass a volume of every sphere.
    pub density: f64,
    /// The force on every sphere in every step. It points to where the diamond's centre lies from the sphere at the
    /// start; the sphere in the centre has none.
    pub force: f64,
    /// The steps in which that force acts, from the first.
    pub force_steps: usize,
    /// A step's time.
    pub time_step: f64,
    /// Iterations of ODE's QuickStep.
    pub iterations: u32,
    /// The surface of the spheres: what a contact does.
    pub surface: Surface,
}

impl Diamond {
    /// The paper's: layers and gap from the text; what it does not say as follows. Radius ½, so that at first every
    /// number is exact in binary32; density and force 1; steps of 1/100; 20 iterations, ODE's default; no friction.
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

/// A diamond on its way.
#[derive(Debug)]
pub struct Simulation {
    world: World,
    forces: Vec<[f64; 3]>,
    diamond: Diamond,
    steps: usize,
}

impl Simulation {
    /// The world of its spheres, which has their contacts before each step.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Steps done.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// The positions of all spheres.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + '_ {
        self.world.spheres().map(|sphere| self.world.position(sphere))
    }

    /// Goes on by a step in which the spheres of `touches` part.
    ///
    /// # Errors
    /// Returns an error if a contact is not one, ODE has no memory, or a sphere is lost.
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
