//! What a scene says. Every value remembers its line.

use std::path::PathBuf;

use serde::Deserialize;

use crate::config::Profile;

/// The largest coordinate, radius, mass or speed: what ODE's broad phase can hold, as `ode` has it too.
pub(super) const LARGEST: f64 = 134_217_728.0;

/// A value, and the line that gives it; no line if it is the default.
#[derive(Clone, Debug, PartialEq)]
pub struct Given<T> {
    /// Itself.
    pub value: T,
    /// Its line in the file, from 1.
    pub line: Option<usize>,
}

impl<T> Given<T> {
    pub(super) fn default_of(value: T) -> Self {
        Self { value, line: None }
    }
}

/// What is wanted of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Want {
    /// Which pairs touch.
    Touching,
    /// How deep.
    Depth,
    /// The direction that parts them.
    Normals,
    /// Where they touch.
    ContactPoints,
    /// Where every body is after every step.
    Trajectories,
    /// Energy and momentum after every step.
    Energy,
}

impl Want {
    /// As files have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Touching => "touching",
            Self::Depth => "depth",
            Self::Normals => "normals",
            Self::ContactPoints => "contact-points",
            Self::Trajectories => "trajectories",
            Self::Energy => "energy",
        }
    }
}

/// How bodies may lie before the first step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Start {
    /// Apart, above the floor and between the walls.
    #[default]
    #[serde(rename = "apart")]
    Apart,
    /// As the scene has them.
    #[serde(rename = "as given")]
    AsGiven,
}

/// A force to a centre.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pull {
    /// Of the force, mass · length / time².
    pub strength: f64,
    /// Where to, as seen from where each body is at the start.
    #[serde(default)]
    pub centre: [f64; 3],
    /// The steps in which it acts, from the first.
    #[serde(default = "always")]
    pub steps: u64,
}

fn always() -> u64 {
    u64::MAX
}

/// What acts on the bodies; nothing unless named.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    /// An acceleration, length / time².
    pub gravity: Option<Given<[f64; 3]>>,
    /// A force to a centre.
    pub pull: Option<Given<Pull>>,
    /// Bodies that meet part again: with this share of the speed they met with, 0 to 1.
    pub bounce: Option<Given<f64>>,
    /// Coulomb's coefficient of contacts, from 0.
    pub friction: Option<Given<f64>>,
    /// Bodies turn.
    pub spin: Option<Given<bool>>,
    /// The share of its speed that a body loses in a step, 0 to 1.
    pub damping: Option<Given<f64>>,
    /// The height, z, of a floor.
    pub floor: Option<Given<f64>>,
    /// Two corners of a box whose six walls keep bodies inside.
    pub walls: Option<Given<[[f64; 3]; 2]>>,
    /// The speed below which bodies fall asleep, length / time.
    pub sleeping: Option<Given<f64>>,
}

/// How a group's bodies lie.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The paper's: the points of an octahedron.
    Diamond {
        /// Layers from the centre to a tip.
        layers: u64,
    },
    /// A box of rows.
    Lattice {
        /// Bodies along x, y and z.
        count: [u64; 3],
    },
    /// Random places in a box.
    Random {
        /// The number of bodies.
        count: u64,
        /// Two opposite corners of the box.
        corners: [[f64; 3]; 2],
        /// The seed of the places.
        seed: u64,
    },
    /// One upon the other, along z.
    Stack {
        /// The number of bodies.
        count: u64,
    },
    /// Centres.
    List {
        /// One per body.
        centres: Vec<[f64; 3]>,
    },
    /// Centres from a CSV (x,y,z or x,y,z,r) or PLY file.
    File {
        /// The file.
        path: PathBuf,
    },
}

/// Bodies that are alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// How they lie.
    pub shape: Shape,
    /// Distance between neighbours' surfaces, where the shape has neighbours.
    pub gap: f64,
    /// Where the shape's centre, or its first body, lies.
    pub at: [f64; 3],
    /// Their radius, a length.
    pub radius: Given<f64>,
    /// The mass of each.
    pub mass: f64,
    /// Velocity, length / time.
    pub velocity: Option<Given<[f64; 3]>>,
    /// Angular velocity, radians / time.
    pub turning: Option<Given<[f64; 3]>>,
    /// Every line that says something of the group.
    pub lines: Vec<usize>,
}

/// A scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The file, as errors and pages name it.
    pub file: String,
    /// Its text, line by line.
    pub text: Vec<String>,
    /// Its name.
    pub name: Given<String>,
    /// What is wanted, each with its line.
    pub want: Vec<(Want, usize)>,
    /// Steps.
    pub steps: Given<u64>,
    /// A step's time.
    pub time_step: Given<f64>,
    /// The arithmetic by name.
    pub accuracy: Option<Given<Profile>>,
    /// The arithmetic by the relative error it may make.
    pub max_error: Option<Given<f64>>,
    /// SCPUs.
    pub scpus: Given<u32>,
    /// How bodies may lie at first.
    pub start: Given<Start>,
    /// What acts.
    pub effects: Effects,
    /// The bodies.
    pub bodies: Vec<Group>,
    /// What they are tried against instead of each other.
    pub queries: Vec<Group>,
}

impl Shape {
    /// How many there are, as far as the scene's text says: those of a file are counted when it is read.
    pub fn count(&self) -> u64 {
        match self {
            // Octahedral numbers of the first and second kind: the points with |x| + |y| + |z| < layers.
            Self::Diamond { layers } => {
                let n = layers.saturating_sub(1);
                n.saturating_mul(2).saturating_add(1).saturating_mul(
                    n.saturating_mul(n).saturating_mul(2).saturating_add(n.saturating_mul(2)).saturating_add(3),
                ) / 3
            }
            Self::Lattice { count: [x, y, z] } => x.saturating_mul(*y).saturating_mul(*z),
            Self::Random { count, .. } | Self::Stack { count } => *count,
            Self::List { centres } => centres.len() as u64,
            Self::File { .. } => 0,
        }
    }
}
