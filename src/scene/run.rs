//! Moving scenes: ODE's steps, with an engine that replaces its collider of two spheres, and with only the plan's
//! effects.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use super::bodies::{Ball, balls};
use super::demand::Part;
use super::plan::Plan;
use super::results::{Energy, Meeting, SceneRun, Touching};
use super::{Balance, Scene, SceneError, check_start};
use crate::kernel::{Engine, EngineError};
use crate::ode::{Collider, Ode, Sleep, Sphere, Surface, World};
use crate::query::{ContactRecord, Fields, PairRecord};

/// Two bodies meet if they touch and did not touch in this number of steps before. Bodies that lie on each other touch
/// on and off.
const APART: u64 = 20;

/// Runs a scene. Each step's pairs go through `engine`, which computes the plan's fields. After each step, `progress`
/// is called with the number of steps done.
///
/// # Errors
/// Returns an error if bodies cannot be read or overlap at the start ([`check_start`]), if ODE refuses or loses a body,
/// or if the engine fails.
pub fn run(
    scene: &Scene,
    plan: &Plan,
    engine: &mut dyn Engine,
    name: &str,
    mut progress: impl FnMut(u64),
) -> Result<SceneRun, SceneError> {
    check_start(scene, plan)?;
    let bodies = balls(scene, &scene.bodies)?;
    let ode = Ode::start(Collider::Engine)?;
    let mut world = World::new(&ode)?;
    let spheres = set_up(&mut world, scene, plan, &bodies)?;
    let forces = forces(scene, &bodies);
    let surface = surface(scene);
    let mut results = SceneRun::begin(scene, plan, name.to_owned())?;
    let mut engine = Timed { inner: engine, fields: plan.config.contact, spent: Duration::ZERO, pairs: 0 };
    let mut step_times = Vec::new();
    let count = bodies.len() as u64;
    results.describe(&bodies, bodies.len());
    let mut last_touch: HashMap<[usize; 2], u64> = HashMap::new();
    record(&mut results, plan, scene, &world, &bodies, true);
    let mut balance = Balance::begin(scene, &world, &bodies);
    for step in 0..scene.steps.value {
        let pull = forces.as_ref().filter(|forces| step < forces.steps);
        let power_before = pull.map_or(0.0, |forces| forces.power(&world, &spheres));
        let begun = Instant::now();
        engine.spent = Duration::ZERO;
        if let Some(forces) = pull {
            for (&sphere, &force) in spheres.iter().zip(&forces.each) {
                world.add_force(sphere, force)?;
            }
        }
        // Contacts are computed only if something asks for them.
        let touches = if plan.has(Part::Hit) { world.contacts_by(&mut engine)? } else { Vec::new() };
        if plan.has(Part::Response) {
            for touch in &touches {
                world.join(touch, &surface)?;
            }
        }
        if plan.has(Part::Floor) || plan.has(Part::Walls) {
            let walls = world.wall_contacts();
            for touch in &walls {
                world.join_wall(touch, &surface)?;
            }
            results.summary.wall_contacts += walls.len() as u64;
        }
        world.step(scene.time_step.value)?;
        step_times.push(begun.elapsed().saturating_sub(engine.spent));
        let power_after = pull.map_or(0.0, |forces| forces.power(&world, &spheres));
        balance.work += scene.time_step.value * (power_before + power_after) / 2.0;
        let summary = &mut results.summary;
        summary.steps += 1;
        summary.contacts += touches.len() as u64;
        if plan.has(Part::Sleeping) {
            let asleep = spheres.iter().filter(|&&sphere| world.is_asleep(sphere)).count() as u64;
            summary.asleep += asleep * asleep.saturating_sub(1) / 2;
        }
        if plan.has(Part::Contacts) {
            results.contacts.extend(touches.iter().map(|touch| {
                let c = &touch.contact;
                let [[x, y, z], [nx, ny, nz]] = [c.position, c.normal];
                let words = [x, y, z, nx, ny, nz, c.depth].map(|v| v as f32);
                Touching { step, bodies: [touch.first.index(), touch.second.index()], words }
            }));
        }
        if plan.has(Part::Trajectories) {
            for touch in &touches {
                let bodies = [touch.first.index(), touch.second.index()];
                if last_touch.insert(bodies, step).is_none_or(|last| last + APART < step) {
                    results.meetings.push(Meeting { step, bodies });
                }
            }
        }
        record(&mut results, plan, scene, &world, &bodies, false);
        progress(step + 1);
    }
    balance.finish(scene, &world, &bodies);
    let summary = &mut results.summary;
    summary.balance = Some(balance);
    summary.bodies = bodies.len();
    summary.all_pairs = count * count.saturating_sub(1) / 2;
    summary.pairs = engine.pairs;
    summary.bytes = results.cost.bytes(summary.pairs, summary.contacts);
    summary.bytes_with_everything = results.everything.bytes(summary.pairs, summary.pairs);
    step_times.sort_unstable();
    summary.step_ns = step_times.get(step_times.len() / 2).map_or(0.0, |time| time.as_nanos() as f64);
    Ok(results)
}

/// The bodies, and the effects of the plan.
fn set_up(world: &mut World, scene: &Scene, plan: &Plan, bodies: &[Ball]) -> Result<Vec<Sphere>, SceneError> {
    let effects = &scene.effects;
    if let Some(gravity) = effects.gravity.as_ref().filter(|_| plan.has(Part::Gravity)) {
        world.set_gravity(gravity.value)?;
    }
    if let Some(damping) = &effects.damping {
        world.set_damping(damping.value)?;
    }
    if let Some(speed) = &effects.sleeping {
        world.set_sleep(&Sleep { speed: speed.value, turning: speed.value, ..Sleep::USUAL })?;
    }
    if let Some(height) = &effects.floor {
        world.add_wall([0.0, 0.0, 1.0], height.value)?;
    }
    if let Some(corners) = &effects.walls {
        let [low, high] = corners.value;
        for axis in 0..3 {
            let unit = |sign: f64| std::array::from_fn(|i| if i == axis { sign } else { 0.0 });
            world.add_wall(unit(1.0), low[axis])?;
            world.add_wall(unit(-1.0), -high[axis])?;
        }
    }
    // A bounce of 1 conserves energy only if overlaps are not pushed apart in addition.
    if effects.bounce.as_ref().is_some_and(|bounce| bounce.value == 1.0) {
        world.set_stiffness(0.0, 0.0)?;
    }
    let mut spheres = Vec::with_capacity(bodies.len());
    for ball in bodies {
        let volume = 4.0 / 3.0 * std::f64::consts::PI * ball.radius.powi(3);
        let sphere = world.add_sphere(ball.centre, ball.radius, ball.mass / volume)?;
        if ball.velocity != [0.0; 3] || ball.turning != [0.0; 3] {
            world.set_velocity(sphere, ball.velocity, ball.turning)?;
        }
        spheres.push(sphere);
    }
    if !plan.has(Part::Spin) {
        world.forbid_turning();
    }
    Ok(spheres)
}

/// The pull on every body, from its place at the start towards the centre, as in the paper's diamond.
struct Forces {
    each: Vec<[f64; 3]>,
    steps: u64,
}

impl Forces {
    /// The power of the forces. The work of a step is the mean of the powers before and after it, times the step's
    /// time. For Newton's second law in ODE's discretisation, this is exact.
    fn power(&self, world: &World, spheres: &[Sphere]) -> f64 {
        let power = |(&sphere, force): (&Sphere, &[f64; 3])| {
            let velocity = world.velocity(sphere);
            (0..3).map(|axis| force[axis] * velocity[axis]).sum::<f64>()
        };
        spheres.iter().zip(&self.each).map(power).sum()
    }
}

fn forces(scene: &Scene, bodies: &[Ball]) -> Option<Forces> {
    let pull = scene.effects.pull.as_ref()?.value;
    let force = |ball: &Ball| {
        let to: [f64; 3] = std::array::from_fn(|axis| pull.centre[axis] - ball.centre[axis]);
        let distance = to.iter().map(|v| v * v).sum::<f64>().sqrt();
        if distance > 0.0 { to.map(|v| v / distance * pull.strength) } else { [0.0; 3] }
    };
    Some(Forces { each: bodies.iter().map(force).collect(), steps: pull.steps })
}

fn surface(scene: &Scene) -> Surface {
    let value = |given: &Option<super::Given<f64>>| given.as_ref().map_or(0.0, |given| given.value);
    Surface { friction: value(&scene.effects.friction), bounce: value(&scene.effects.bounce), bounce_speed: 0.0 }
}

fn record(results: &mut SceneRun, plan: &Plan, scene: &Scene, world: &World, bodies: &[Ball], is_first: bool) {
    if is_first || plan.has(Part::Trajectories) {
        results.places.push(world.spheres().map(|sphere| world.position(sphere)).collect());
    }
    if plan.has(Part::Trajectories) && plan.has(Part::Spin) {
        results.turns.push(world.spheres().map(|sphere| turn(world.orientation(sphere))).collect());
    }
    if plan.has(Part::Energy) {
        let motion = world.motion();
        let gravity = scene.effects.gravity.as_ref().map_or([0.0; 3], |gravity| gravity.value);
        let potential = world.spheres().zip(bodies).map(|(sphere, ball)| {
            let place = world.position(sphere);
            -ball.mass * (0..3).map(|axis| gravity[axis] * place[axis]).sum::<f64>()
        });
        let potential = potential.sum();
        results.energy.push(Energy { kinetic: motion.energy, potential, momentum: motion.momentum });
    }
}

/// The vector part of a unit quaternion. A quaternion and its opposite are the same orientation, so the scalar part can
/// be kept from being negative.
fn turn([scalar, x, y, z]: [f64; 4]) -> [f32; 3] {
    let sign = if scalar < 0.0 { -1.0 } else { 1.0 };
    [x, y, z].map(|part| (part * sign) as f32)
}

/// The engine, with its time measured apart from the host's, its pairs counted, and fields that it does not compute
/// filled in.
struct Timed<'a> {
    inner: &'a mut dyn Engine,
    fields: Fields,
    spent: Duration,
    pairs: u64,
}

impl Engine for Timed<'_> {
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        let begun = Instant::now();
        let mut contacts = self.inner.contacts(pairs)?;
        self.spent += begun.elapsed();
        self.pairs += pairs.len() as u64;
        if !self.fields.position {
            // A force along the normal goes through both centres, so it has no lever arm there, and the position has no
            // effect.
            for (contact, pair) in contacts.iter_mut().zip(pairs).filter(|(contact, _)| contact.is_contact()) {
                *contact = contact.at_first_centre(pair);
            }
        }
        Ok(contacts)
    }
}
