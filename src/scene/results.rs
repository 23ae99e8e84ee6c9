//! The results of a scene's run.

use serde::Serialize;

use super::plan::{Plan, Row};
use super::{Balance, Ball, Cost, Scene};
use crate::config::{Config, Input};

/// The schema of a scene's JSON.
pub const SCHEMA: &str = "contact-afu/scene/1";

/// Two touching bodies, in one step. Fields that nothing called for are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// The number of steps done before.
    pub step: u64,
    /// The bodies' numbers.
    pub bodies: [usize; 2],
    /// The contact's words as the engine gave them: position, normal, depth.
    pub words: [f32; 7],
}

/// Two bodies that touch in a step and did not in several steps before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meeting {
    /// The number of steps done before it.
    pub step: u64,
    /// The bodies' numbers.
    pub bodies: [usize; 2],
}

/// Energy and momentum after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Energy {
    /// Kinetic energy, of translation and rotation: mass · length² / time².
    pub kinetic: f64,
    /// Energy in the field of gravity, relative to the origin; 0 without gravity.
    pub potential: f64,
    /// Mass · length / time.
    pub momentum: [f64; 3],
}

/// The counts of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// The number of bodies, including queries.
    pub bodies: usize,
    /// The number of steps done.
    pub steps: u64,
    /// The number of all pairs of bodies.
    pub all_pairs: u64,
    /// Pairs sent to the engine in all steps: those that could touch and were not both asleep.
    pub pairs: u64,
    /// Spheres sent in all steps, if spheres are sent and not pairs.
    pub spheres: u64,
    /// Pairs of two sleeping bodies in all steps, whether or not they could touch. They are not sent.
    pub asleep: u64,
    /// Contacts among the pairs sent.
    pub contacts: u64,
    /// Contacts with walls, from ODE.
    pub wall_contacts: u64,
    /// Clock cycles of the simulated AFU over all jobs; `None` for the reference engine.
    pub cycles: Option<u64>,
    /// Bytes over the link, from the layout.
    pub bytes: f64,
    /// Bytes over the link if everything were on.
    pub bytes_with_everything: f64,
    /// The median time of a step on this host without the engine's part, in nanoseconds. For a query, the engine's
    /// time.
    pub step_ns: f64,
    /// The energy at the start and at the end, and the energy added; `None` for a query.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub balance: Option<Balance>,
}

/// A run of a scene.
#[derive(Clone, Debug)]
pub struct SceneRun {
    /// The scene's name.
    pub name: String,
    /// The plan's rows.
    pub rows: Vec<Row>,
    /// The AFU.
    pub config: Config,
    /// The cost of the AFU.
    pub cost: Cost,
    /// The cost of an AFU with everything.
    pub everything: Cost,
    /// The engine that computed the contacts.
    pub engine: String,
    /// The counts.
    pub summary: Summary,
    /// Time per step.
    pub time_step: f64,
    /// The height of the floor, if there is one.
    pub floor: Option<f64>,
    /// Two corners of the box of walls, if there is one.
    pub walls: Option<[[f64; 3]; 2]>,
    /// Radii of the bodies, those of queries last.
    pub radii: Vec<f64>,
    /// The group of each body: `bodies` in the order of the scene, then `queries`.
    pub groups: Vec<usize>,
    /// The number of bodies that are not queries.
    pub queries_from: usize,
    /// Position of every body, at the start and after each step. Only at the start if trajectories are not wanted.
    pub places: Vec<Vec<[f64; 3]>>,
    /// Orientation of every body, if spin is on and trajectories are wanted: the vector part of a unit quaternion whose
    /// scalar part is not negative.
    pub turns: Vec<Vec<[f32; 3]>>,
    /// The bodies that met, and when; empty if trajectories are not wanted.
    pub meetings: Vec<Meeting>,
    /// Contacts, if wanted.
    pub contacts: Vec<Touching>,
    /// Energy before the first step and after each, if wanted.
    pub energy: Vec<Energy>,
}

impl Summary {
    /// Notes what was sent, pairs or spheres, and the bytes that this and the contacts are.
    pub(super) fn sent(&mut self, config: &Config, cost: &Cost, everything: &Cost, sent: u64) {
        self.bytes = cost.bytes(sent, self.contacts);
        if config.input == Input::Spheres {
            self.spheres = sent;
            self.bytes_with_everything = everything.bytes(sent, self.contacts);
        } else {
            self.pairs = sent;
            self.bytes_with_everything = everything.bytes(sent, sent);
        }
    }
}

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    version: &'static str,
    name: &'a str,
    engine: &'a str,
    config: &'a Config,
    plan: Vec<PlanRow<'a>>,
    cost: &'a Cost,
    everything: &'a Cost,
    summary: &'a Summary,
}

#[derive(Serialize)]
struct PlanRow<'a> {
    name: &'a str,
    on: bool,
    value: &'a str,
    lines: Vec<usize>,
}

impl<'a> From<&'a Row> for PlanRow<'a> {
    fn from(row: &'a Row) -> Self {
        let lines = row.calls.iter().map(|call| call.line).collect();
        Self { name: &row.name, on: row.on, value: &row.value, lines }
    }
}

impl SceneRun {
    /// Copies the properties of the bodies that do not change in a run.
    pub(super) fn describe(&mut self, balls: &[Ball], queries_from: usize) {
        self.radii = balls.iter().map(|ball| ball.radius).collect();
        self.queries_from = queries_from;
        let past_bodies = balls[..queries_from].iter().map(|ball| ball.group + 1).max().unwrap_or(0);
        let group = |(number, ball): (usize, &Ball)| ball.group + if number < queries_from { 0 } else { past_bodies };
        self.groups = balls.iter().enumerate().map(group).collect();
    }

    pub(super) fn begin(scene: &Scene, plan: &Plan, engine: String) -> Result<Self, super::SceneError> {
        Ok(Self {
            name: scene.name.value.clone(),
            rows: plan.rows.clone(),
            config: plan.config.clone(),
            cost: plan.cost()?,
            everything: Cost::of(&plan.everything())?,
            engine,
            summary: Summary::default(),
            time_step: scene.time_step.value,
            floor: scene.effects.floor.as_ref().map(|floor| floor.value),
            walls: scene.effects.walls.as_ref().map(|walls| walls.value),
            radii: Vec::new(),
            groups: Vec::new(),
            queries_from: 0,
            places: Vec::new(),
            turns: Vec::new(),
            meetings: Vec::new(),
            contacts: Vec::new(),
            energy: Vec::new(),
        })
    }

    /// The run as JSON.
    pub fn json(&self) -> impl Serialize {
        Document {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            name: &self.name,
            engine: &self.engine,
            config: &self.config,
            plan: self.rows.iter().map(PlanRow::from).collect(),
            cost: &self.cost,
            everything: &self.everything,
            summary: &self.summary,
        }
    }
}
