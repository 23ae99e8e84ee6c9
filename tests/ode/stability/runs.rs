//! Simulations with contacts from different sources, and the deviations between them.

use contact_afu::kernel::{Engine, Reference};
use contact_afu::number::Format;
use contact_afu::ode::{Collider, Ode, SearchSpace, SpherePair, Touch, World};
use contact_afu::query::Fields;

use super::scenes::{Build, Point, Scene, dot};

/// The source of contacts.
pub enum Contacts<'a> {
    /// ODE's own collider in `f64`.
    Ode,
    /// ODE's own collider, with positions and radii rounded to binary32.
    Rounded,
    /// An engine instead of the collider, with the same rounded inputs.
    By(&'a mut dyn Engine),
    /// A search with an engine instead of ODE's space and collider, with the same rounded inputs.
    In(&'a mut SearchSpace<'static>),
}

/// A world after a step.
#[derive(PartialEq)]
pub struct State {
    /// Kinetic energy plus the potential energy of the forces.
    pub energy: f64,
    momentum: Point,
    angular: Point,
    positions: Vec<Point>,
    pub contacts: usize,
}

fn distance(a: Point, b: Point) -> f64 {
    let step = [0, 1, 2].map(|axis| a[axis] - b[axis]);
    dot(step, step).sqrt()
}

fn narrow(v: f64) -> f64 {
    f64::from(v as f32)
}

fn rounded(world: &World, pair: &mut SpherePair) -> Vec<Touch> {
    let mut touches = Vec::new();
    for [first, second] in world.candidates().unwrap() {
        let [one, other] = [first, second].map(|sphere| {
            let [x, y, z] = world.position(sphere);
            [x, y, z, world.radius(sphere)].map(narrow)
        });
        pair.set(one, other).unwrap();
        touches.extend(pair.collide().map(|contact| Touch { first, second, contact }));
    }
    touches
}

fn pairs(touches: &[Touch]) -> Vec<[usize; 2]> {
    touches.iter().map(|touch| [touch.first.index(), touch.second.index()]).collect()
}

/// The spheres that touch after rounding to binary32, in the profile `wide`, among all pairs.
fn brute_force(world: &World) -> Vec<[usize; 2]> {
    let reference = Reference::new(Format::WIDE, Fields::HIT);
    let touch = &|first, second| reference.run(&world.record([first, second])).is_contact();
    let touching = world.spheres().flat_map(|first| {
        let others = world.spheres().skip(first.index() + 1).filter(move |second| touch(first, *second));
        others.map(move |second| [first.index(), second.index()])
    });
    touching.collect()
}

/// The states after each of `steps` steps.
pub fn run(build: Build, steps: usize, mut contacts: Contacts<'_>) -> Vec<State> {
    let own = !matches!(contacts, Contacts::By(_));
    let ode = Ode::start(if own { Collider::Own } else { Collider::Engine }).unwrap();
    let mut pair = own.then(|| SpherePair::new(&ode).unwrap());
    let mut scene = build(&ode).unwrap();
    let mut states = Vec::with_capacity(steps);
    while states.len() < steps {
        let touches = match (&mut contacts, &mut pair) {
            (Contacts::By(engine), _) => scene.world.contacts_by(*engine).unwrap(),
            (Contacts::In(space), _) => {
                let touches = scene.world.contacts_in(space).unwrap();
                assert_eq!(pairs(&touches), brute_force(&scene.world), "step {}", states.len());
                touches
            }
            (Contacts::Rounded, Some(pair)) => rounded(&scene.world, pair),
            _ => scene.world.contacts().unwrap(),
        };
        scene.advance(&touches).unwrap();
        states.push(State::of(&scene, touches.len()));
    }
    states
}

impl State {
    fn of(scene: &Scene, contacts: usize) -> Self {
        let motion = scene.world.motion();
        let positions: Vec<Point> = scene.world.spheres().map(|sphere| scene.world.position(sphere)).collect();
        Self {
            energy: motion.energy + scene.potential(),
            momentum: motion.momentum,
            angular: motion.angular,
            positions,
            contacts,
        }
    }

    fn is_finite(&self) -> bool {
        let numbers = self.positions.iter().chain([&self.momentum, &self.angular]).flatten();
        numbers.chain([&self.energy]).all(|v| v.is_finite())
    }
}

/// The maximum differences between two simulations over all their steps.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    pub energy: f64,
    pub momentum: f64,
    pub angular: f64,
    /// Of the position of a sphere.
    pub place: f64,
}

pub fn deviation(found: &[State], exact: &[State]) -> Deviation {
    assert!(found.len() == exact.len() && found.iter().all(State::is_finite));
    let largest =
        |apart: &dyn Fn(&State, &State) -> f64| found.iter().zip(exact).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
    let places =
        |a: &State, b: &State| a.positions.iter().zip(&b.positions).map(|(&a, &b)| distance(a, b)).fold(0.0, f64::max);
    Deviation {
        energy: largest(&|a, b| (a.energy - b.energy).abs()),
        momentum: largest(&|a, b| distance(a.momentum, b.momentum)),
        angular: largest(&|a, b| distance(a.angular, b.angular)),
        place: largest(&places),
    }
}
