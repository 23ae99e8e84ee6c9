//! The paper's benchmark: the time that ODE takes to collide two spheres, measured inside a simulation.
//!
//! [`Benchmark::run`] follows the paper's Figure 5. The diamond is simulated, and every candidate pair is collided ten
//! times. Pairs of the wanted kind are counted and recorded with their average time, until there are enough.
//!
//! Reading the clock takes longer than a collision. So [`Recording::figures`] also times the same pairs as a whole: a
//! loop of ODE's calls, and the f32 kernel in batch.

mod figures;
mod timing;

pub use figures::Figures;
pub use timing::Timing;

use super::dcollide::Room;
use super::{Collider, Diamond, Error, Ode, Simulation, Sphere, Touch};
use crate::query::{Flow, PairRecord};
use std::hint::black_box;
use std::time::Instant;

/// The settings of a benchmark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Benchmark {
    /// The simulation, with the paper's hMax and dSph.
    pub diamond: Diamond,
    /// The paper's tCol, the kind of collision that counts: fake, real or grazing.
    pub flow: Flow,
    /// The paper's nColMax: the number of these collisions. The simulation stops at the last.
    pub collisions: usize,
    /// The number of executions of each collision, which are averaged; 10 in the paper, at least 1.
    pub executions: u32,
    /// The number of steps, at least 1, after which the diamond is rebuilt and the recording continues. In the end, the
    /// forces that made it collide drive its spheres apart, with hMax 3 after some 1350 steps.
    pub steps_of_a_run: usize,
    /// The benchmark stops with an error if this number of steps in total did not give enough collisions.
    pub most_steps: usize,
}

/// A collision of the wanted kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// The two spheres in ODE's numbers and order, x y z and radius each.
    pub spheres: [[f64; 4]; 2],
    /// The average time of its executions in nanoseconds, including one reading of the clock for all of them.
    pub nanoseconds: f64,
}

/// The result of a run of the benchmark.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The collisions of the wanted kind, in the order in which they occurred.
    pub collisions: Vec<Collision>,
    /// The total number of steps before the last collision, in all runs together.
    pub steps: usize,
    /// The time of an empty measurement, in nanoseconds. Each collision's average includes this time, divided by the
    /// executions.
    pub clock_ns: f64,
}

impl Benchmark {
    /// The paper's settings for Figure 6: real collisions in the diamond of hMax 3 and dSph 0, each executed 10 times.
    pub const fn paper(collisions: usize) -> Self {
        let diamond = Diamond::new(3, 0.0);
        let (steps_of_a_run, most_steps) = (1000, 100_000);
        Self { diamond, flow: Flow::Real, collisions, executions: 10, steps_of_a_run, most_steps }
    }

    /// Simulates and measures.
    ///
    /// # Errors
    /// Returns an error if ODE runs without its own collider, a parameter is out of range, or there are too few
    /// collisions of the kind.
    pub fn run(&self, ode: &Ode) -> Result<Recording, Error> {
        ode.needs(Collider::Own)?;
        if self.flow == Flow::Invalid {
            return Err(Error::Flow(self.flow));
        }
        let mut simulation = self.diamond.build(ode)?;
        let mut collisions = Vec::new();
        let clock_ns = timing::clock_ns();
        let mut steps = 0;
        while collisions.len() < self.collisions {
            if steps == self.most_steps {
                let (found, wanted) = (collisions.len(), self.collisions);
                return Err(Error::TooFew { flow: self.flow, found, wanted, steps: self.most_steps });
            }
            let touches = self.measure(&simulation, &mut collisions)?;
            if collisions.len() < self.collisions {
                steps += 1;
                if simulation.steps() + 1 < self.steps_of_a_run {
                    simulation.advance(&touches)?;
                } else {
                    simulation = self.diamond.build(ode)?;
                }
            }
        }
        Ok(Recording { collisions, steps, clock_ns })
    }

    /// Collides the candidates of a step, and records those of the wanted kind until there are enough.
    fn measure(&self, simulation: &Simulation, collisions: &mut Vec<Collision>) -> Result<Vec<Touch>, Error> {
        let world = simulation.world();
        let executions = self.executions.max(1);
        let mut touches = Vec::new();
        let mut room = Room::new();
        world.near(|first, second| {
            if collisions.len() == self.collisions {
                return;
            }
            let [g1, g2] = world.geoms(first, second);
            let mut touch = false;
            let begin = Instant::now();
            for _ in 0..executions {
                // SAFETY: both live as long as the world.
                touch = unsafe { room.ask(black_box(g1), black_box(g2)) };
            }
            let nanoseconds = begin.elapsed().as_nanos() as f64 / f64::from(executions);
            let sphere = |sphere: Sphere| {
                let [x, y, z] = world.position(sphere);
                [x, y, z, world.radius(sphere)]
            };
            let spheres = [sphere(first), sphere(second)];
            if touch {
                // SAFETY: ODE has just reported a contact.
                let contact = unsafe { room.contact() };
                touches.push(Touch { first, second, contact });
            }
            if flow(touch, spheres) == self.flow {
                collisions.push(Collision { spheres, nanoseconds });
            }
        })?;
        Ok(touches)
    }
}

/// The flow of a pair through ODE's collider, which does not report it. ODE tests for coincident centres by their
/// rounded distance, which is 0 exactly if the rounded sum of squares is.
fn flow(touch: bool, [[x1, y1, z1, _], [x2, y2, z2, _]]: [[f64; 4]; 2]) -> Flow {
    let (x, y, z) = (x1 - x2, y1 - y2, z1 - z2);
    match touch {
        false => Flow::Fake,
        true if (x * x + y * y) + z * z <= 0.0 => Flow::Coincident,
        true => Flow::Real,
    }
}

impl Recording {
    /// The paper's figure for the first `count` collisions: the sum of their averages, in nanoseconds.
    pub(crate) fn total_ns(&self, count: usize) -> f64 {
        self.first(count).iter().map(|collision| collision.nanoseconds).sum()
    }

    /// The first `count` collisions as an engine gets them: each number is rounded to binary32 once.
    pub fn pairs(&self, count: usize) -> Vec<PairRecord> {
        let narrow = |sphere: [f64; 4]| sphere.map(|v| v as f32);
        let record = |c: &Collision| PairRecord::from_spheres(narrow(c.spheres[0]), narrow(c.spheres[1]));
        self.first(count).iter().map(record).collect()
    }

    /// The first `count` collisions, or all of them if there are fewer.
    fn first(&self, count: usize) -> &[Collision] {
        &self.collisions[..count.min(self.collisions.len())]
    }
}
