//! The only table of what each line of a scene calls for.

use super::file::{Given, Scene, Want};

/// A statement in a scene's text that calls for something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Demand {
    /// An entry of `want`.
    Wanted(Want),
    /// `effects.gravity`.
    Gravity,
    /// `effects.pull`.
    Pull,
    /// `effects.bounce`.
    Bounce,
    /// `effects.friction`.
    Friction,
    /// `effects.spin`.
    Spin,
    /// `effects.damping`.
    Damping,
    /// `effects.floor`.
    Floor,
    /// `effects.walls`.
    Walls,
    /// `effects.sleeping`.
    Sleeping,
    /// A group's `velocity`.
    Velocity,
    /// A group's `turning`.
    Turning,
    /// A group's `radius`.
    Radius,
    /// `accuracy` or `max_error`.
    Accuracy,
    /// `steps`.
    Steps,
    /// `time_step`.
    TimeStep,
    /// `scpus`.
    Scpus,
}

/// What can be on or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// Dynamics: steps of ODE. Without it the scene is one query.
    Motion,
    /// ODE's `dWorldSetGravity`.
    Gravity,
    /// A force on every body in every step.
    Pull,
    /// Contact joints: bodies that touch separate.
    Response,
    /// The bounce mode of contact joints.
    Bounce,
    /// The friction of contact joints.
    Friction,
    /// Bodies turn.
    Spin,
    /// ODE's damping.
    Damping,
    /// A plane below, and its collider.
    Floor,
    /// Six planes, and their collider.
    Walls,
    /// ODE's auto-disable. Two sleeping bodies are not sent.
    Sleeping,
    /// The field `hit`.
    Hit,
    /// The field `depth`.
    Depth,
    /// The field `normal`.
    Normal,
    /// The field `position`.
    Position,
    /// The square root.
    Root,
    /// The division.
    Division,
    /// Radii in records, and the sum of two radii.
    Radii,
    /// The numbers that the AFU computes in.
    Arithmetic,
    /// Records of pairs that do not touch.
    Misses,
    /// The number of SCPUs.
    Scpus,
    /// The file with every body's trajectory.
    Trajectories,
    /// The file of every contact.
    Contacts,
    /// The file of energy and momentum.
    Energy,
}

/// The rules, all in one place: each part with its name in tables and the demands that call for it. A part is on if
/// something here calls for it. [`Part::Radii`], [`Part::Arithmetic`], [`Part::Misses`] and [`Part::Scpus`] have values
/// instead, which depend on the lines that call for them (see [`super::Plan`]).
pub(super) const RULES: &[(Part, &str, &[Demand])] = &[
    // Something must move the bodies. The effects of contacts alone do not.
    (Part::Motion, "motion", MOVING),
    (Part::Gravity, "gravity", &[Demand::Gravity]),
    (Part::Pull, "pull", &[Demand::Pull]),
    // Either one makes touching bodies separate.
    (Part::Response, "contact joints", &[Demand::Bounce, Demand::Friction]),
    (Part::Bounce, "bounce", &[Demand::Bounce]),
    (Part::Friction, "friction", &[Demand::Friction]),
    (Part::Spin, "spin", &[Demand::Spin]),
    (Part::Damping, "damping", &[Demand::Damping]),
    (Part::Floor, "floor", &[Demand::Floor]),
    (Part::Walls, "walls", &[Demand::Walls]),
    (Part::Sleeping, "sleeping", &[Demand::Sleeping]),
    (Part::Hit, "hit", &[TOUCHING, DEPTH, NORMALS, POINTS, Demand::Bounce, Demand::Friction, Demand::Spin]),
    // A contact acts along the normal, by the depth.
    (Part::Depth, "depth", &[DEPTH, Demand::Bounce, Demand::Friction]),
    (Part::Normal, "normal", &[NORMALS, Demand::Bounce, Demand::Friction]),
    // A force along the normal of two spheres goes through both centres, so without friction and spin it has no lever
    // arm.
    (Part::Position, "position", LEVER),
    // The decision alone needs no root: RN(√q) > s exactly when q > (s + ½ulp(s))².
    (Part::Root, "square root", &[DEPTH, NORMALS, POINTS, Demand::Bounce, Demand::Friction, Demand::Spin]),
    // The normal is divided by the distance, and the position lies along the normal.
    (Part::Division, "division", &[NORMALS, POINTS, Demand::Bounce, Demand::Friction, Demand::Spin]),
    (Part::Radii, "radii in records", &[Demand::Radius]),
    (Part::Arithmetic, "arithmetic", &[Demand::Accuracy]),
    (Part::Misses, "records of misses", &[Demand::Accuracy]),
    (Part::Scpus, "SCPUs", &[Demand::Scpus]),
    (Part::Trajectories, "trajectories", &[Demand::Wanted(Want::Trajectories)]),
    (Part::Contacts, "contacts", &[TOUCHING, DEPTH, NORMALS, POINTS]),
    (Part::Energy, "energy", &[Demand::Wanted(Want::Energy)]),
];

/// Demands that set bodies in motion.
pub(super) const MOVING: &[Demand] = &[Demand::Gravity, Demand::Pull, Demand::Velocity, Demand::Turning];
const LEVER: &[Demand] = &[POINTS, Demand::Friction, Demand::Spin];
const TOUCHING: Demand = Demand::Wanted(Want::Touching);
const DEPTH: Demand = Demand::Wanted(Want::Depth);
const NORMALS: Demand = Demand::Wanted(Want::Normals);
const POINTS: Demand = Demand::Wanted(Want::ContactPoints);

impl Part {
    fn rule(self) -> Option<&'static (Part, &'static str, &'static [Demand])> {
        RULES.iter().find(|(part, ..)| *part == self)
    }

    /// The name in tables.
    pub fn name(self) -> &'static str {
        self.rule().map_or("", |(_, name, _)| name)
    }

    /// The demands that call for it.
    pub(crate) fn demands(self) -> &'static [Demand] {
        self.rule().map_or(&[], |(.., demands)| demands)
    }
}

impl Demand {
    /// The lines of a scene with this demand.
    pub fn lines(self, scene: &Scene) -> Vec<usize> {
        fn line<T>(given: &Option<Given<T>>) -> Vec<usize> {
            given.as_ref().and_then(|given| given.line).into_iter().collect()
        }
        let effects = &scene.effects;
        let groups = || scene.bodies.iter().chain(&scene.queries);
        let moving = |given: &Option<Given<[f64; 3]>>| match given {
            Some(given) if given.value != [0.0; 3] => given.line,
            _ => None,
        };
        match self {
            Self::Wanted(wanted) => {
                scene.want.iter().filter(|(want, _)| *want == wanted).map(|(_, line)| *line).collect()
            }
            Self::Gravity => moving(&effects.gravity).into_iter().collect(),
            Self::Pull => line(&effects.pull),
            Self::Bounce => line(&effects.bounce),
            Self::Friction => line(&effects.friction),
            Self::Spin => line(&effects.spin),
            Self::Damping => line(&effects.damping),
            Self::Floor => line(&effects.floor),
            Self::Walls => line(&effects.walls),
            Self::Sleeping => line(&effects.sleeping),
            Self::Velocity => groups().filter_map(|group| moving(&group.velocity)).collect(),
            Self::Turning => groups().filter_map(|group| moving(&group.turning)).collect(),
            Self::Radius => groups().filter_map(|group| group.radius.line).collect(),
            Self::Accuracy => [line(&scene.accuracy), line(&scene.max_error)].concat(),
            Self::Steps => scene.steps.line.into_iter().collect(),
            Self::TimeStep => scene.time_step.line.into_iter().collect(),
            Self::Scpus => scene.scpus.line.into_iter().collect(),
        }
    }
}
