//! Derives from a scene's text what must be built and run, and which line calls for it.

use super::cost::Cost;
use super::demand::{Demand, MOVING, Part, RULES};
use super::file::{Given, Pull, Scene, Shape};
use super::{SceneError, bodies};
use crate::afu::Spec;
use crate::config::{Config, Input, Profile, Results, Search, Shell};
use crate::count::{counted, grouped};
use crate::query::Fields;
use crate::spheres::ROW;

/// Where deciders are asked for, the SCPU behind them takes a contact in so many pairs.
const PAIRS_PER_CONTACT: u32 = 8;

/// A line that calls for something.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Call {
    /// The number of the line, from 1.
    pub line: usize,
    /// The text of the line.
    pub text: String,
}

/// A row of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// A [`Part`]'s name, or a group of bodies.
    pub name: String,
    /// True if it is built and run.
    pub on: bool,
    /// Its value, if it has one.
    pub value: String,
    /// The lines that call for it. Empty if it is off, or on by default.
    pub calls: Vec<Call>,
}

/// What must be built and run for a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The rows.
    pub rows: Vec<Row>,
    /// The AFU.
    pub config: Config,
}

/// The effects that `--with` and `--without` can name, each with the value for scenes that give none.
const EFFECTS: [&str; 9] = ["gravity", "pull", "bounce", "friction", "spin", "damping", "floor", "walls", "sleeping"];

impl Plan {
    /// True if something sets the bodies of a scene in motion.
    pub fn moves(scene: &Scene) -> bool {
        MOVING.iter().any(|demand| !demand.lines(scene).is_empty())
    }

    /// The plan of a scene.
    ///
    /// # Errors
    /// Returns an error if a file of bodies cannot be read.
    pub fn of(scene: &Scene) -> Result<Self, SceneError> {
        let calls = |demands: &[Demand]| {
            let mut lines: Vec<usize> = demands.iter().flat_map(|demand| demand.lines(scene)).collect();
            lines.sort_unstable();
            lines.dedup();
            lines.into_iter().map(|line| call(scene, line)).collect::<Vec<_>>()
        };
        let on = |part: Part| !calls(part.demands()).is_empty();
        let radius = one_radius(scene)?;
        let profile = profile(scene);
        let fields = Fields { depth: on(Part::Depth), normal: on(Part::Normal), position: on(Part::Position) };
        // Records of one bit cannot mark a pair as unsettled, but the host must know these pairs.
        let exact = profile.is_exact();
        let fields = if exact && fields == Fields::HIT { Fields { depth: true, ..fields } } else { fields };
        let config = Config {
            scpus: scene.scpus.value,
            profile,
            contact: fields,
            results: if exact { Results::All } else { Results::Hits },
            radius,
            ..Config::default()
        };
        // The fewest operators that still take a full line of pairs per cycle.
        let interval = Spec::from(config.clone()).longest_interval(f64::INFINITY);
        let config = Config { interval, ..config };
        let mut rows: Vec<Row> = RULES
            .iter()
            .map(|&(part, name, demands)| {
                let calls = calls(demands);
                let (is_on, value) = match part {
                    Part::Radii => match radius {
                        Some(radius) => (false, format!("every radius is {radius}")),
                        None => (true, "radii differ".to_owned()),
                    },
                    Part::Arithmetic => (true, config.profile.to_string()),
                    Part::Misses => (exact, String::new()),
                    Part::Scpus => (true, scene.scpus.value.to_string()),
                    _ => (!calls.is_empty(), value(scene, part)),
                };
                Row { name: name.to_owned(), on: is_on, value, calls }
            })
            .collect();
        rows.push(run(scene, calls(&[MOVING, &[Demand::Steps, Demand::TimeStep]].concat())));
        let groups = [("bodies", &scene.bodies), ("queries", &scene.queries)];
        for (key, group) in groups.into_iter().flat_map(|(key, groups)| groups.iter().map(move |group| (key, group))) {
            rows.push(Row {
                name: format!("{key} of line {}", group.lines.first().copied().unwrap_or(0)),
                on: true,
                value: describe(group),
                calls: group.lines.iter().map(|&line| call(scene, line)).collect(),
            });
        }
        Ok(Self { rows, config })
    }

    /// The same plan for an AFU with this shell, whose AXI4 master has this many bits.
    #[must_use]
    pub fn below(mut self, shell: Shell, bus: u32) -> Self {
        (self.config.shell, self.config.bus) = (shell, bus);
        self
    }

    /// The same plan with so many SCPUs that only decide, in front of one that takes a contact in eight pairs.
    #[must_use]
    pub fn decided_by(mut self, deciders: u32) -> Self {
        let config = &mut self.config;
        (config.decide, config.scpus) = (deciders, 1);
        config.interval = (PAIRS_PER_CONTACT / deciders.max(1)).max(1);
        let value = format!(
            "{} in front of an SCPU that takes a contact every {}",
            counted(deciders.into(), "decider"),
            counted(config.interval.into(), "cycle")
        );
        if let Some(row) = self.rows.iter_mut().find(|row| row.name == Part::Scpus.name()) {
            row.value = value;
        }
        self
    }

    /// The same plan for an AFU that is sent spheres, with such a search, and finds what touches.
    #[must_use]
    pub fn of_spheres(mut self, search: Search) -> Self {
        let config = &mut self.config;
        (config.input, config.search, config.results) = (Input::Spheres, search, Results::Hits);
        (config.scpus, config.interval, config.radius) = (1, 1, None);
        let Search { table, lanes, deciders, box_bits } = search;
        let scpus = if config.contact == Fields::HIT { "none: the search decides" } else { "1" };
        for (part, is_on, value) in [
            (Part::Scpus, config.contact != Fields::HIT, scpus),
            (Part::Radii, true, "sent with every sphere"),
            (Part::Misses, false, ""),
        ] {
            if let Some(row) = self.rows.iter_mut().find(|row| row.name == part.name()) {
                (row.on, row.value) = (is_on, value.to_owned());
            }
        }
        let value = format!(
            "table of {} spheres in rows of {ROW}, {lanes} lanes, {}, boxes of {box_bits} bits",
            grouped(table.into()),
            counted(deciders.into(), "decider")
        );
        let place = self.rows.iter().position(|row| row.name == Part::Scpus.name()).map_or(0, |place| place + 1);
        let row = Row { name: "search for what touches".to_owned(), on: true, value, calls: Vec::new() };
        self.rows.insert(place, row);
        self
    }

    /// The row of a part.
    pub fn row(&self, part: Part) -> Option<&Row> {
        self.rows.iter().find(|row| row.name == part.name())
    }

    /// True if a part is on.
    pub fn has(&self, part: Part) -> bool {
        self.row(part).is_some_and(|row| row.on)
    }

    /// The AFU with every part, for comparison with the scene's own.
    pub fn everything(&self) -> Config {
        let results = if self.config.input == Input::Spheres { Results::Hits } else { Results::All };
        Config { contact: Fields::ALL, results, radius: None, ..self.config.clone() }
    }

    /// The cost of the AFU, without the tools that count LUTs.
    ///
    /// # Errors
    /// Returns an error if there is no such AFU.
    pub fn cost(&self) -> Result<Cost, SceneError> {
        Cost::of(&self.config)
    }
}

impl Scene {
    /// The scene with one effect added at a usual value, or with one of its effects removed.
    ///
    /// # Errors
    /// Returns an error if there is no such effect.
    pub fn switched(&self, effect: &str, on: bool) -> Result<Self, SceneError> {
        // The line of a demand that no line makes.
        const ASKED: Option<usize> = Some(0);
        fn set<T>(to: &mut Option<Given<T>>, on: bool, usual: T) {
            *to = if on { to.take().or(Some(Given { value: usual, line: ASKED })) } else { None };
        }
        let mut scene = self.clone();
        let effects = &mut scene.effects;
        match effect {
            "gravity" => set(&mut effects.gravity, on, [0.0, 0.0, -9.81]),
            "pull" => set(&mut effects.pull, on, Pull { strength: 1.0, centre: [0.0; 3], steps: u64::MAX }),
            "bounce" => set(&mut effects.bounce, on, 0.5),
            "friction" => set(&mut effects.friction, on, 0.5),
            "spin" => set(&mut effects.spin, on, true),
            "damping" => set(&mut effects.damping, on, 0.01),
            "floor" => set(&mut effects.floor, on, -100.0),
            "walls" => set(&mut effects.walls, on, [[-100.0; 3], [100.0; 3]]),
            "sleeping" => set(&mut effects.sleeping, on, 0.01),
            _ => return Err(SceneError::Effect(effect.to_owned(), EFFECTS.join(", "))),
        }
        if !on && effect == "spin" {
            scene.bodies.iter_mut().for_each(|group| group.turning = None);
        }
        Ok(scene)
    }

    /// The effects that `--with` and `--without` can name.
    pub(crate) const fn effect_names() -> &'static [&'static str] {
        &EFFECTS
    }
}

fn call(scene: &Scene, line: usize) -> Call {
    let text = match line.checked_sub(1) {
        None => "asked for on the command line".to_owned(),
        Some(index) => scene.text.get(index).map_or_else(String::new, |text| text.trim().to_owned()),
    };
    Call { line, text }
}

/// The radius, rounded to binary32 as in records, if all spheres have the same one.
fn one_radius(scene: &Scene) -> Result<Option<f32>, SceneError> {
    let groups = || scene.bodies.iter().chain(&scene.queries);
    let first = groups().next().map_or(1.0, |group| group.radius.value as f32);
    let from_files = groups().filter(|group| matches!(group.shape, Shape::File { .. }));
    for group in from_files {
        if bodies::balls(scene, std::slice::from_ref(group))?.iter().any(|ball| ball.radius as f32 != first) {
            return Ok(None);
        }
    }
    Ok(groups().all(|group| group.radius.value as f32 == first).then_some(first))
}

/// The arithmetic: the named one, or the narrowest that is known to keep the error bound.
fn profile(scene: &Scene) -> Profile {
    if let Some(named) = &scene.accuracy {
        return named.value.clone();
    }
    scene.max_error.as_ref().map_or(Profile::WIDE, |bound| super::cost::narrowest(bound.value))
}

fn run(scene: &Scene, calls: Vec<Call>) -> Row {
    let moves = Plan::moves(scene);
    let value = if moves {
        format!("{} steps of {}", scene.steps.value, scene.time_step.value)
    } else {
        "one query, no dynamics".to_owned()
    };
    Row { name: "run".to_owned(), on: true, value, calls }
}

/// The value that a scene gives to a part.
fn value(scene: &Scene, part: Part) -> String {
    fn text<T: std::fmt::Debug>(given: &Option<Given<T>>) -> String {
        given.as_ref().map_or_else(String::new, |given| format!("{:?}", given.value))
    }
    let effects = &scene.effects;
    match part {
        Part::Gravity => text(&effects.gravity),
        Part::Pull => effects.pull.as_ref().map_or_else(String::new, |pull| {
            let Pull { strength, centre, steps } = pull.value;
            let until = if steps == u64::MAX { String::new() } else { format!(", in the first {steps} steps") };
            format!("{strength} to {centre:?}{until}")
        }),
        Part::Bounce => text(&effects.bounce),
        Part::Friction => text(&effects.friction),
        Part::Damping => text(&effects.damping),
        Part::Floor => text(&effects.floor),
        Part::Walls => text(&effects.walls),
        Part::Sleeping => text(&effects.sleeping),
        _ => String::new(),
    }
}

fn describe(group: &super::Group) -> String {
    let shape = match &group.shape {
        Shape::Diamond { layers } => format!("diamond of {layers} layers"),
        Shape::Lattice { count: [x, y, z] } => format!("lattice {x} × {y} × {z}"),
        Shape::Random { count, corners: [low, high], seed } => {
            format!("{count} at random from {low:?} to {high:?}, seed {seed}")
        }
        Shape::Stack { count } => format!("stack of {count}"),
        Shape::List { centres } => {
            format!("centres: {}, the first {:?}", centres.len(), centres.first().unwrap_or(&[0.0; 3]))
        }
        Shape::File { path } => format!("those of {}", path.display()),
    };
    let more = |what: &str, given: &Option<Given<[f64; 3]>>| {
        given.as_ref().map_or_else(String::new, |given| format!(", {what} {:?}", given.value))
    };
    format!(
        "{shape}, gap {}, at {:?}, radius {}, mass {}{}{}",
        group.gap,
        group.at,
        group.radius.value,
        group.mass,
        more("velocity", &group.velocity),
        more("turning", &group.turning)
    )
}
