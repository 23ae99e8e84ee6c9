//! The content of a scene's file. Every value keeps its line.

use std::path::PathBuf;

use serde::Deserialize;

use crate::config::Profile;

/// The largest coordinate, radius, mass or speed. It is the same as in `ode`, the limit of ODE's broad phase.
pub(super) const LARGEST: f64 = 134_217_728.0;

/// A value, and the line that gives it; no line if it is the default.
#[derive(Clone, Debug, PartialEq)]
pub struct Given<T> {
    /// The value.
    pub value: T,
    /// Its line in the file, from 1.
    pub line: Option<usize>,
}

impl<T> Given<T> {
    pub(super) fn default_of(value: T) -> Self {
        Self { value, line: None }
    }
}

/// A result that a scene asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Want {
    /// The pairs that touch.
    Touching,
    /// The depth of contacts.
    Depth,
    /// The direction in which touching bodies separate.
    Normals,
    /// The positions of contacts.
    ContactPoints,
    /// The position of every body after every step.
    Trajectories,
    /// Energy and momentum after every step.
    Energy,
}

impl Want {
    /// The name in files.
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

/// The positions that bodies may have before the first step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Start {
    /// Apart, above the floor and between the walls.
    #[default]
    #[serde(rename = "apart")]
    Apart,
    /// As the scene gives them.
    #[serde(rename = "as given")]
    AsGiven,
}

/// A force towards a centre.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pull {
    /// The strength of the force, mass · length / time².
    pub strength: f64,
    /// The centre, seen from each body's place at the start.
    #[serde(default)]
    pub centre: [f64; 3],
    /// The number of steps, from the first, in which it acts.
    #[serde(default = "always")]
    pub steps: u64,
}

fn always() -> u64 {
    u64::MAX
}

/// The effects on the bodies. Each is off unless it is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    /// An acceleration, length / time².
    pub gravity: Option<Given<[f64; 3]>>,
    /// A force towards a centre.
    pub pull: Option<Given<Pull>>,
    /// Bodies that meet separate with this share of their approach speed, 0 to 1.
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

/// The arrangement of a group's bodies.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The paper's diamond: the points of an octahedron.
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
    /// One on top of the other, along z.
    Stack {
        /// The number of bodies.
        count: u64,
    },
    /// A list of centres.
    List {
        /// One centre per body.
        centres: Vec<[f64; 3]>,
    },
    /// Centres from a CSV (x,y,z or x,y,z,r) or PLY file.
    File {
        /// The file.
        path: PathBuf,
    },
}

/// Bodies with the same properties.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Their arrangement.
    pub shape: Shape,
    /// Distance between neighbours' surfaces, if the shape has neighbours.
    pub gap: f64,
    /// The place of the shape's centre, or of its first body.
    pub at: [f64; 3],
    /// Their radius, a length.
    pub radius: Given<f64>,
    /// The mass of each.
    pub mass: f64,
    /// Velocity, length / time.
    pub velocity: Option<Given<[f64; 3]>>,
    /// Angular velocity, radians / time.
    pub turning: Option<Given<[f64; 3]>>,
    /// Every line about the group.
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
    /// The results that it asks for, each with its line.
    pub want: Vec<(Want, usize)>,
    /// The number of steps.
    pub steps: Given<u64>,
    /// The time of a step.
    pub time_step: Given<f64>,
    /// The arithmetic, by name.
    pub accuracy: Option<Given<Profile>>,
    /// The arithmetic, by its largest relative error.
    pub max_error: Option<Given<f64>>,
    /// The number of SCPUs.
    pub scpus: Given<u32>,
    /// The positions that bodies may have at the start.
    pub start: Given<Start>,
    /// The effects.
    pub effects: Effects,
    /// The bodies.
    pub bodies: Vec<Group>,
    /// Bodies that they are tested against, instead of each other.
    pub queries: Vec<Group>,
}

impl Shape {
    /// The number of bodies, as far as the scene's text gives it. Bodies in a file are counted when it is read.
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
