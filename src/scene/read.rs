//! Reads a scene's file: TOML, version 1.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use super::SceneError;
use super::file::{Effects, Given, Group, LARGEST, Pull, Scene, Shape, Start, Want};

/// The version that this program reads: the key `scene`.
const VERSION: i64 = 1;
/// The most bodies of a moving scene, and the most spheres of a query.
const MOST_MOVING: u64 = 20_000;
const MOST: u64 = 1_000_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    scene: Spanned<i64>,
    name: Option<Spanned<String>>,
    #[serde(default)]
    want: Vec<Spanned<Want>>,
    steps: Option<Spanned<u64>>,
    time_step: Option<Spanned<f64>>,
    accuracy: Option<Spanned<String>>,
    max_error: Option<Spanned<f64>>,
    scpus: Option<Spanned<u32>>,
    start: Option<Spanned<Start>>,
    #[serde(default)]
    effects: RawEffects,
    #[serde(default)]
    bodies: Vec<Spanned<RawGroup>>,
    #[serde(default)]
    queries: Vec<Spanned<RawGroup>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct RawEffects {
    gravity: Option<Spanned<[f64; 3]>>,
    pull: Option<Spanned<Pull>>,
    bounce: Option<Spanned<f64>>,
    friction: Option<Spanned<f64>>,
    spin: Option<Spanned<bool>>,
    damping: Option<Spanned<f64>>,
    floor: Option<Spanned<f64>>,
    walls: Option<Spanned<[[f64; 3]; 2]>>,
    sleeping: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawGroup {
    shape: Spanned<String>,
    layers: Option<Spanned<u64>>,
    count: Option<Spanned<Count>>,
    corners: Option<Spanned<[[f64; 3]; 2]>>,
    seed: Option<Spanned<u64>>,
    centres: Option<Spanned<Vec<[f64; 3]>>>,
    file: Option<Spanned<PathBuf>>,
    gap: Option<Spanned<f64>>,
    at: Option<Spanned<[f64; 3]>>,
    radius: Option<Spanned<f64>>,
    mass: Option<Spanned<f64>>,
    velocity: Option<Spanned<[f64; 3]>>,
    turning: Option<Spanned<[f64; 3]>>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(untagged)]
enum Count {
    All(u64),
    Axes([u64; 3]),
}

/// A scene's text with its file, for errors at its lines.
struct Source<'a> {
    file: &'a str,
    text: &'a str,
}

impl Source<'_> {
    fn line(&self, offset: usize) -> usize {
        1 + self.text.bytes().take(offset).filter(|byte| *byte == b'\n').count()
    }

    fn given<T>(&self, value: Spanned<T>) -> Given<T> {
        let line = self.line(value.span().start);
        Given { value: value.into_inner(), line: Some(line) }
    }

    fn wrong(&self, line: Option<usize>, key: &str, why: impl Into<String>) -> SceneError {
        SceneError::Value { file: self.file.to_owned(), line: line.unwrap_or(1), key: key.to_owned(), why: why.into() }
    }

    /// A number, or three, within the limits of ODE and of records.
    fn number(&self, key: &str, value: Option<Spanned<f64>>, least: f64) -> Result<Option<Given<f64>>, SceneError> {
        let Some(given) = value.map(|value| self.given(value)) else { return Ok(None) };
        if (least..=LARGEST).contains(&given.value) {
            return Ok(Some(given));
        }
        Err(self.wrong(given.line, key, format!("{} is not from {least} to {LARGEST:e}", given.value)))
    }

    fn share(&self, key: &str, value: Option<Spanned<f64>>) -> Result<Option<Given<f64>>, SceneError> {
        let Some(given) = value.map(|value| self.given(value)) else { return Ok(None) };
        if (0.0..=1.0).contains(&given.value) {
            return Ok(Some(given));
        }
        Err(self.wrong(given.line, key, format!("{} is not from 0 to 1", given.value)))
    }

    fn vector(&self, key: &str, value: Option<Spanned<[f64; 3]>>) -> Result<Option<Given<[f64; 3]>>, SceneError> {
        let Some(given) = value.map(|value| self.given(value)) else { return Ok(None) };
        self.plain(key, given.line, &given.value)?;
        Ok(Some(given))
    }

    fn plain(&self, key: &str, line: Option<usize>, values: &[f64]) -> Result<(), SceneError> {
        match values.iter().find(|value| !(-LARGEST..=LARGEST).contains(*value)) {
            None => Ok(()),
            Some(bad) => Err(self.wrong(line, key, format!("{bad} is not from -{LARGEST:e} to {LARGEST:e}"))),
        }
    }

    fn corners(&self, key: &str, given: &Given<[[f64; 3]; 2]>) -> Result<(), SceneError> {
        let [low, high] = given.value;
        self.plain(key, given.line, &[low, high].concat())?;
        if (0..3).all(|axis| low[axis] < high[axis]) {
            return Ok(());
        }
        Err(self.wrong(given.line, key, "the first corner must lie below the second on every axis"))
    }
}

impl Scene {
    /// Reads a scene.
    ///
    /// # Errors
    /// Returns an error that names file, line and key.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let file = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|error| SceneError::Read { file: file.clone(), error })?;
        let mut scene = Self::parse(&file, &text)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        for group in scene.bodies.iter_mut().chain(&mut scene.queries) {
            if let Shape::File { path } = &mut group.shape {
                *path = folder.join(&path);
            }
        }
        Ok(scene)
    }

    /// Reads a scene from a text. Errors name the file as `file`.
    ///
    /// # Errors
    /// Returns the errors of [`Scene::read`].
    pub fn parse(file: &str, text: &str) -> Result<Self, SceneError> {
        let source = Source { file, text };
        let raw: Raw = toml::from_str(text).map_err(|error| {
            let line = source.line(error.span().map_or(0, |span| span.start));
            SceneError::Form { file: file.to_owned(), line, why: error.message().trim().replace('\n', " ") }
        })?;
        let version = source.given(raw.scene);
        if version.value != VERSION {
            let why = format!("version {} is not known: this program reads version {VERSION}", version.value);
            return Err(source.wrong(version.line, "scene", why));
        }
        let or = |given: Option<Given<f64>>, value: f64| given.unwrap_or(Given::default_of(value));
        let steps = raw.steps.map_or(Given::default_of(100), |steps| source.given(steps));
        if !(1..=10_000_000).contains(&steps.value) {
            return Err(source.wrong(steps.line, "steps", "give 1 to 10 million"));
        }
        let time_step = or(source.number("time_step", raw.time_step, 1e-7)?, 0.01);
        let scpus = raw.scpus.map_or(Given::default_of(10), |scpus| source.given(scpus));
        if !crate::config::SCPUS.contains(&scpus.value) {
            return Err(source.wrong(scpus.line, "scpus", "expected 1 to 64"));
        }
        let accuracy = match raw.accuracy.map(|name| source.given(name)) {
            None => None,
            Some(Given { value, line }) => {
                let value = value.parse().map_err(|error| source.wrong(line, "accuracy", format!("{error}")))?;
                Some(Given { value, line })
            }
        };
        let max_error = source.number("max_error", raw.max_error, 0.0)?;
        if let (Some(_), Some(bound)) = (&accuracy, &max_error) {
            return Err(source.wrong(
                bound.line,
                "max_error",
                "accuracy names a profile already: leave one of them out",
            ));
        }
        let effects = effects(&source, raw.effects)?;
        let groups = |key: &str, raw: Vec<Spanned<RawGroup>>| {
            raw.into_iter().map(|raw| group(&source, key, raw)).collect::<Result<Vec<_>, _>>()
        };
        let want = raw.want.iter().map(|want| (*want.get_ref(), source.line(want.span().start))).collect();
        let scene = Self {
            file: file.to_owned(),
            text: text.lines().map(str::to_owned).collect(),
            name: raw.name.map_or(Given::default_of("a scene".to_owned()), |name| source.given(name)),
            want,
            steps,
            time_step,
            accuracy,
            max_error,
            scpus,
            start: raw.start.map_or(Given::default_of(Start::Apart), |start| source.given(start)),
            effects,
            bodies: groups("bodies", raw.bodies)?,
            queries: groups("queries", raw.queries)?,
        };
        scene.check(&source)?;
        Ok(scene)
    }

    /// Fails if the values contradict each other.
    fn check(&self, source: &Source) -> Result<(), SceneError> {
        if self.bodies.is_empty() {
            return Err(source.wrong(None, "bodies", "there are none: give at least one [[bodies]]"));
        }
        if self.want.is_empty() {
            return Err(source.wrong(
                None,
                "want",
                "nothing is wanted: list some of touching, depth, normals, contact-points, trajectories, energy",
            ));
        }
        let moves = super::Plan::moves(self);
        let of_motion = self.want.iter().find(|(want, _)| matches!(want, Want::Trajectories | Want::Energy));
        if let (false, Some((want, line))) = (moves, of_motion) {
            let why = format!(
                "{} of bodies that nothing moves: give a velocity, gravity or a pull, or leave it out",
                want.name()
            );
            return Err(source.wrong(Some(*line), "want", why));
        }
        if moves && !self.queries.is_empty() {
            let line = self.queries[0].lines.first().copied();
            return Err(source.wrong(
                line,
                "queries",
                "bodies that move meet each other: leave queries or the motion out",
            ));
        }
        let most = if moves { MOST_MOVING } else { MOST };
        let mut all = 0_u64;
        for (key, group) in
            self.bodies.iter().map(|group| ("bodies", group)).chain(self.queries.iter().map(|group| ("queries", group)))
        {
            all = all.saturating_add(group.shape.count());
            if all > most {
                let why = format!(
                    "expected at most {most} {}in total, found {all}",
                    if moves { "moving spheres " } else { "spheres " }
                );
                return Err(source.wrong(group.lines.first().copied(), key, why));
            }
            if group.turning.is_some() && self.effects.spin.as_ref().is_none_or(|spin| !spin.value) {
                let line = group.turning.as_ref().and_then(|turning| turning.line);
                return Err(source.wrong(line, "turning", "bodies do not turn without the effect spin = true"));
            }
        }
        Ok(())
    }
}

fn effects(source: &Source, raw: RawEffects) -> Result<Effects, SceneError> {
    let pull = raw.pull.map(|pull| source.given(pull));
    if let Some(Given { value, line }) = &pull {
        source.plain("pull", *line, &[value.strength, value.centre[0], value.centre[1], value.centre[2]])?;
    }
    let walls = raw.walls.map(|walls| source.given(walls));
    if let Some(walls) = &walls {
        source.corners("walls", walls)?;
    }
    let spin = raw.spin.map(|spin| source.given(spin)).filter(|spin| spin.value);
    let friction = source.number("friction", raw.friction, 0.0)?;
    Ok(Effects {
        gravity: source.vector("gravity", raw.gravity)?,
        pull,
        bounce: source.share("bounce", raw.bounce)?,
        friction,
        spin,
        damping: source.share("damping", raw.damping)?,
        floor: source.number("floor", raw.floor, -LARGEST)?,
        walls,
        sleeping: source.number("sleeping", raw.sleeping, 0.0)?,
    })
}

fn group(source: &Source, key: &str, raw: Spanned<RawGroup>) -> Result<Group, SceneError> {
    let header = source.line(raw.span().start);
    let raw = raw.into_inner();
    let kind = source.given(raw.shape);
    let mut lines = vec![header];
    lines.extend(kind.line);
    let mut used = Vec::new();
    macro_rules! need {
        ($field:ident) => {{
            let why = concat!("a ", "shape of this kind needs `", stringify!($field), "`");
            let given =
                raw.$field.map(|value| source.given(value)).ok_or_else(|| source.wrong(kind.line, "shape", why))?;
            lines.extend(given.line);
            used.push(stringify!($field));
            given
        }};
    }
    let layers = raw.layers.as_ref().map(|value| ("layers", source.line(value.span().start)));
    let count = raw.count.as_ref().map(|value| ("count", source.line(value.span().start)));
    let corners = raw.corners.as_ref().map(|value| ("corners", source.line(value.span().start)));
    let seed = raw.seed.as_ref().map(|value| ("seed", source.line(value.span().start)));
    let centres = raw.centres.as_ref().map(|value| ("centres", source.line(value.span().start)));
    let file = raw.file.as_ref().map(|value| ("file", source.line(value.span().start)));
    let number = |given: &Given<Count>| match given.value {
        Count::All(count) => Ok(count),
        Count::Axes(_) => Err(source.wrong(given.line, "count", "give one number for this shape")),
    };
    let shape = match kind.value.as_str() {
        "diamond" => {
            let layers = need!(layers);
            if !(1..=40).contains(&layers.value) {
                return Err(source.wrong(layers.line, "layers", "give 1 to 40"));
            }
            Shape::Diamond { layers: layers.value }
        }
        "lattice" => {
            let count = need!(count);
            match count.value {
                Count::Axes(count) => Shape::Lattice { count },
                Count::All(_) => return Err(source.wrong(count.line, "count", "a lattice has three: [4, 4, 4]")),
            }
        }
        "random" => {
            let (count, corners) = (need!(count), need!(corners));
            source.corners("corners", &corners)?;
            let count = number(&count)?;
            let seed = raw.seed.map(|seed| source.given(seed));
            lines.extend(seed.as_ref().and_then(|seed| seed.line));
            used.push("seed");
            Shape::Random { count, corners: corners.value, seed: seed.map_or(1, |seed| seed.value) }
        }
        "stack" => Shape::Stack { count: number(&need!(count))? },
        "list" => {
            let centres = need!(centres);
            source.plain("centres", centres.line, &centres.value.concat())?;
            Shape::List { centres: centres.value }
        }
        "file" => Shape::File { path: need!(file).value },
        other => {
            let why = format!("there is no `{other}`: use diamond, lattice, random, stack, list or file");
            return Err(source.wrong(kind.line, "shape", why));
        }
    };
    let given = [layers, count, corners, seed, centres, file];
    if let Some((name, line)) = given.into_iter().flatten().find(|(name, _)| !used.contains(name)) {
        return Err(source.wrong(Some(line), name, format!("a {} has none", kind.value)));
    }
    let gap = source.number("gap", raw.gap, -LARGEST)?;
    let at = source.vector("at", raw.at)?;
    let radius = source.number("radius", raw.radius, 1e-6)?;
    let mass = source.number("mass", raw.mass, 1e-6)?;
    let velocity = source.vector("velocity", raw.velocity)?;
    let turning = source.vector("turning", raw.turning)?;
    let of_numbers = [&gap, &radius, &mass].map(|given| given.as_ref().and_then(|given| given.line));
    let of_vectors = [&at, &velocity, &turning].map(|given| given.as_ref().and_then(|given| given.line));
    lines.extend(of_numbers.into_iter().chain(of_vectors).flatten());
    lines.sort_unstable();
    lines.dedup();
    if shape.count() == 0 && !matches!(shape, Shape::File { .. }) {
        return Err(source.wrong(kind.line, key, "there is no body in it"));
    }
    let value = |given: Option<Given<f64>>, usual: f64| given.map_or(usual, |given| given.value);
    Ok(Group {
        shape,
        gap: value(gap, 0.0),
        at: at.map_or([0.0; 3], |at| at.value),
        radius: radius.unwrap_or(Given::default_of(1.0)),
        mass: value(mass, 1.0),
        velocity,
        turning,
        lines,
    })
}
