//! The one table of what calls for what.

use super::file::{Given, Scene, Want};

/// Something that a scene's text can say, and that calls for something.
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
    /// Contact joints: bodies that touch part.
    Response,
    /// Their bounce mode.
    Bounce,
    /// Their friction.
    Friction,
    /// Bodies turn.
    Spin,
    /// ODE's damping.
    Damping,
    /// A plane below, and its collider.
    Floor,
    /// Six planes, and their collider.
    Walls,
    /// ODE's auto-disable; two bodies that sleep are not sent.
    Sleeping,
    /// The decision.
    Hit,
    /// The field.
    Depth,
    /// The field.
    Normal,
    /// The field.
    Position,
    /// The square root.
    Root,
    /// The division.
    Division,
    /// Radii in records, and the sum of two.
    Radii,
    /// The numbers that the AFU computes in.
    Arithmetic,
    /// Records of pairs that do not touch.
    Misses,
    /// How many SCPUs.
    Scpus,
    /// The file of every body's way.
    Trajectories,
    /// The file of every contact.
    Contacts,
    /// The file of energy and momentum.
    Energy,
}

/// What calls for what: physics, in one place. A part is on when something here calls for it; [`Part::Radii`],
/// [`Part::Arithmetic`], [`Part::Misses`] and [`Part::Scpus`] have values rather, on which the lines that call for them
/// have their say (see [`super::Plan`]).
pub(super) const RULES: &[(Part, &[Demand])] = &[
    // Something must move them; what they do when they meet does not.
    (Part::Motion, MOVING),
    (Part::Gravity, &[Demand::Gravity]),
    (Part::Pull, &[Demand::Pull]),
    // Either makes bodies that touch part.
    (Part::Response, &[Demand::Bounce, Demand::Friction]),
    (Part::Bounce, &[Demand::Bounce]),
    (Part::Friction, &[Demand::Friction]),
    (Part::Spin, &[Demand::Spin]),
    (Part::Damping, &[Demand::Damping]),
    (Part::Floor, &[Demand::Floor]),
    (Part::Walls, &[Demand::Walls]),
    (Part::Sleeping, &[Demand::Sleeping]),
    (
        Part::Hit,
        &[
            Demand::Wanted(Want::Touching),
            Demand::Wanted(Want::Depth),
            Demand::Wanted(Want::Normals),
            Demand::Wanted(Want::ContactPoints),
            Demand::Bounce,
            Demand::Friction,
            Demand::Spin,
        ],
    ),
    // Along the normal, and by how much.
    (Part::Depth, &[Demand::Wanted(Want::Depth), Demand::Bounce, Demand::Friction]),
    (Part::Normal, &[Demand::Wanted(Want::Normals), Demand::Bounce, Demand::Friction]),
    // A force along the normal of two spheres goes through both centres: without friction and spin it has no lever arm.
    (Part::Position, LEVER),
    // The decision alone needs no root: RN(√q) > s exactly when q > (s + ½ulp(s))².
    (
        Part::Root,
        &[
            Demand::Wanted(Want::Depth),
            Demand::Wanted(Want::Normals),
            Demand::Wanted(Want::ContactPoints),
            Demand::Bounce,
            Demand::Friction,
            Demand::Spin,
        ],
    ),
    // The normal is divided by the distance, and the position lies along the normal.
    (
        Part::Division,
        &[
            Demand::Wanted(Want::Normals),
            Demand::Wanted(Want::ContactPoints),
            Demand::Bounce,
            Demand::Friction,
            Demand::Spin,
        ],
    ),
    (Part::Radii, &[Demand::Radius]),
    (Part::Arithmetic, &[Demand::Accuracy]),
    (Part::Misses, &[Demand::Accuracy]),
    (Part::Scpus, &[Demand::Scpus]),
    (Part::Trajectories, &[Demand::Wanted(Want::Trajectories)]),
    (
        Part::Contacts,
        &[
            Demand::Wanted(Want::Touching),
            Demand::Wanted(Want::Depth),
            Demand::Wanted(Want::Normals),
            Demand::Wanted(Want::ContactPoints),
        ],
    ),
    (Part::Energy, &[Demand::Wanted(Want::Energy)]),
];

/// What sets bodies going.
pub(super) const MOVING: &[Demand] = &[Demand::Gravity, Demand::Pull, Demand::Velocity, Demand::Turning];
const LEVER: &[Demand] = &[Demand::Wanted(Want::ContactPoints), Demand::Friction, Demand::Spin];

impl Part {
    /// As tables have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Motion => "motion",
            Self::Gravity => "gravity",
            Self::Pull => "pull",
            Self::Response => "contact joints",
            Self::Bounce => "bounce",
            Self::Friction => "friction",
            Self::Spin => "spin",
            Self::Damping => "damping",
            Self::Floor => "floor",
            Self::Walls => "walls",
            Self::Sleeping => "sleeping",
            Self::Hit => "hit",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Position => "position",
            Self::Root => "square root",
            Self::Division => "division",
            Self::Radii => "radii in records",
            Self::Arithmetic => "arithmetic",
            Self::Misses => "records of misses",
            Self::Scpus => "SCPUs",
            Self::Trajectories => "trajectories",
            Self::Contacts => "contacts",
            Self::Energy => "energy",
        }
    }

    /// What calls for it.
    pub(crate) fn demands(self) -> &'static [Demand] {
        RULES.iter().find(|(part, _)| *part == self).map_or(&[], |(_, demands)| demands)
    }
}

impl Demand {
    /// The lines of a scene that say it.
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
