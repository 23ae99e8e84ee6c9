//! Moving scenes: ODE's steps, with an engine that replaces its collider of two spheres, and with only the plan's
//! effects.

use std::cell::Cell;
use std::collections::HashMap;
use std::rc::Rc;
use std::time::{Duration, Instant};

use super::bodies::{Ball, balls};
use super::demand::Part;
use super::plan::Plan;
use super::results::{Energy, Meeting, SceneRun, Touching};
use super::{Balance, Detector, Scene, SceneError, check_start};
use crate::kernel::{Engine, EngineError};
use crate::ode::{Collider, Error, Ode, SearchSpace, Sleep, Sphere, Surface, Touch, World};
use crate::query::{ContactRecord, Fields, PairRecord};
use crate::spheres::{Finder, Hit, Spheres};

/// Two bodies meet if they touch and did not touch in this number of steps before. Bodies that lie on each other touch
/// on and off.
const APART: u64 = 20;

/// Steps after which the spheres are put in the order of a Hilbert curve again, if spheres are sent.
const SORT_EVERY: u32 = 10;

/// Runs a scene. Each step's pairs or spheres go to `detector`, which computes the plan's fields. After each step,
/// `progress` is called with the number of steps done.
///
/// # Errors
/// Returns an error if bodies cannot be read or overlap at the start ([`check_start`]), if ODE refuses or loses a body,
/// or if the engine fails.
pub fn run(
    scene: &Scene,
    plan: &Plan,
    detector: Detector<'_>,
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
    let (spent, sent) = (Rc::new(Cell::new(Duration::ZERO)), Rc::new(Cell::new(0)));
    let mut source = Source::new(detector, plan.config.contact, spent.clone(), sent.clone());
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
        spent.set(Duration::ZERO);
        if let Some(forces) = pull {
            for (&sphere, &force) in spheres.iter().zip(&forces.each) {
                world.add_force(sphere, force)?;
            }
        }
        // Contacts are computed only if something asks for them.
        let touches = if plan.has(Part::Hit) { source.contacts(&world)? } else { Vec::new() };
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
        step_times.push(begun.elapsed().saturating_sub(spent.get()));
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
    summary.sent(&results.config, &results.cost, &results.everything, sent.get());
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

/// Where contacts come from.
enum Source<'a> {
    Pairs(Timed<'a, dyn Engine + 'a>),
    Spheres(SearchSpace<'a>),
}

impl<'a> Source<'a> {
    fn new(detector: Detector<'a>, fields: Fields, spent: Rc<Cell<Duration>>, sent: Rc<Cell<u64>>) -> Self {
        match detector {
            Detector::Pairs(inner) => Self::Pairs(Timed { inner, fields, spent, sent }),
            Detector::Spheres(inner) => {
                let timed: Timed<'a, dyn Finder + 'a> = Timed { inner, fields, spent, sent };
                Self::Spheres(SearchSpace::of(timed, SORT_EVERY))
            }
        }
    }

    fn contacts(&mut self, world: &World) -> Result<Vec<Touch>, Error> {
        match self {
            Self::Pairs(engine) => world.contacts_by(engine),
            Self::Spheres(space) => world.contacts_in(space),
        }
    }
}

/// A detector, with its time measured apart from the host's, what it was sent counted, and fields that it does not
/// compute filled in.
struct Timed<'a, T: ?Sized> {
    inner: &'a mut T,
    fields: Fields,
    spent: Rc<Cell<Duration>>,
    sent: Rc<Cell<u64>>,
}

impl<T: ?Sized> Timed<'_, T> {
    /// Does `work` with the detector, which is sent so many pairs or spheres.
    fn measured<R>(&mut self, sent: usize, work: impl FnOnce(&mut T) -> R) -> R {
        let begun = Instant::now();
        let done = work(self.inner);
        self.spent.set(self.spent.get() + begun.elapsed());
        self.sent.set(self.sent.get() + sent as u64);
        done
    }

    /// A force along the normal goes through both centres, so it has no lever arm there, and the position has no
    /// effect.
    fn placed(&self, contact: ContactRecord, pair: impl FnOnce() -> PairRecord) -> ContactRecord {
        let stays = self.fields.position || !contact.is_contact();
        if stays { contact } else { contact.at_first_centre(&pair()) }
    }
}

impl Engine for Timed<'_, dyn Engine + '_> {
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        let contacts = self.measured(pairs.len(), |engine| engine.contacts(pairs))?;
        Ok(contacts.into_iter().zip(pairs).map(|(contact, pair)| self.placed(contact, || *pair)).collect())
    }
}

impl Finder for Timed<'_, dyn Finder + '_> {
    fn find(&mut self, sets: &Spheres) -> Result<Vec<Hit>, EngineError> {
        let mut hits = self.measured(sets.first.len(), |finder| finder.find(sets))?;
        for hit in &mut hits {
            let [first, second] = hit.spheres.map(|number| sets.first.get(number as usize));
            if let (Some(first), Some(second)) = (first, second) {
                hit.contact = self.placed(hit.contact, || first.with(*second));
            }
        }
        Ok(hits)
    }
}
