//! Checks the positions of a moving scene's bodies at the start. Overlapping bodies are pushed apart, and so gain
//! energy that nothing in the scene explains.

use super::bodies::{Ball, balls};
use super::demand::Part;
use super::file::Start;
use super::plan::Plan;
use super::{Scene, SceneError};

/// The overlap, as a share of a radius, that is accepted, because the places of touching bodies are rounded.
const SLACK: f64 = 1e-6;

/// A body of the scene, and the line of its group.
struct Placed {
    ball: Ball,
    line: usize,
}

/// The number of overlaps of a kind, and the first one.
#[derive(Default)]
struct Overlaps {
    count: u64,
    /// The numbers of the bodies, and the depth.
    first: Option<([usize; 2], f64)>,
}

impl Overlaps {
    fn add(&mut self, bodies: [usize; 2], depth: f64) {
        self.count += 1;
        if self.first.is_none_or(|(first, _)| bodies < first) {
            self.first = Some((bodies, depth));
        }
    }
}

/// Succeeds if a moving scene begins with its bodies apart, above its floor and between its walls, or need not.
/// Overlaps of bodies matter only if they push each other.
///
/// # Errors
/// Returns the number of overlaps, the first one and its depth. Returns an error if bodies cannot be read.
pub fn check_start(scene: &Scene, plan: &Plan) -> Result<(), SceneError> {
    if scene.start.value == Start::AsGiven || !Plan::moves(scene) {
        return Ok(());
    }
    let mut bodies = Vec::new();
    for group in &scene.bodies {
        let line = group.lines.first().copied().unwrap_or(1);
        let of_group = balls(scene, std::slice::from_ref(group))?;
        bodies.extend(of_group.into_iter().map(|ball| Placed { ball, line }));
    }
    let mut faults = Vec::new();
    let mut line = None;
    let name = |number: usize| format!("body {number} (line {})", bodies[number].line);
    if let Some(height) = &scene.effects.floor {
        let depth = |ball: &Ball| height.value - (ball.centre[2] - ball.radius);
        let below = beyond(&bodies, depth);
        if let Some(([first, _], depth)) = below.first {
            let (begin, depth) = (plural(below.count, "body begins", "bodies begin"), figure(depth));
            faults.push(format!("{begin} below the floor, the first {} by {depth}", name(first)));
            line = line.or(Some(bodies[first].line));
        }
    }
    if let Some(corners) = &scene.effects.walls {
        let [low, high] = corners.value;
        let depth = |ball: &Ball| {
            let over = |axis: usize| (low[axis] - ball.centre[axis]).max(ball.centre[axis] - high[axis]) + ball.radius;
            (0..3).map(over).fold(f64::MIN, f64::max)
        };
        let outside = beyond(&bodies, depth);
        if let Some(([first, _], depth)) = outside.first {
            let (begin, depth) = (plural(outside.count, "body begins", "bodies begin"), figure(depth));
            faults.push(format!("{begin} outside the walls, the first {} by {depth}", name(first)));
            line = line.or(Some(bodies[first].line));
        }
    }
    let inside = if plan.has(Part::Response) { overlapping(&bodies) } else { Overlaps::default() };
    if let Some(([first, second], depth)) = inside.first {
        let begin = plural(inside.count, "pair of bodies begins", "pairs of bodies begin");
        let (first_name, second_name, depth) = (name(first), name(second), figure(depth));
        faults.push(format!("{begin} inside one another, the first {first_name} and {second_name} by {depth}"));
        line = line.or(Some(bodies[first].line));
    }
    let Some(line) = line else { return Ok(()) };
    let why = format!(
        "{}; move them (`at` is the middle of a diamond or a lattice, not its corner), or allow it with start = \"as given\"",
        faults.join("; ")
    );
    Err(SceneError::Value { file: scene.file.clone(), line, key: "bodies".to_owned(), why })
}

/// The bodies that are too far out according to `depth`.
fn beyond(bodies: &[Placed], depth: impl Fn(&Ball) -> f64) -> Overlaps {
    let mut found = Overlaps::default();
    for (number, Placed { ball, .. }) in bodies.iter().enumerate() {
        let depth = depth(ball);
        if depth > slack(ball) {
            found.add([number, number], depth);
        }
    }
    found
}

/// The pairs that overlap, found along x.
fn overlapping(bodies: &[Placed]) -> Overlaps {
    let mut order: Vec<usize> = (0..bodies.len()).collect();
    let left = |number: usize| bodies[number].ball.centre[0] - bodies[number].ball.radius;
    order.sort_by(|&a, &b| left(a).total_cmp(&left(b)));
    let mut found = Overlaps::default();
    for (place, &first) in order.iter().enumerate() {
        let a = &bodies[first].ball;
        for &second in order[place + 1..].iter().take_while(|&&second| left(second) < a.centre[0] + a.radius) {
            let b = &bodies[second].ball;
            let distance = (0..3).map(|axis| (a.centre[axis] - b.centre[axis]).powi(2)).sum::<f64>().sqrt();
            let depth = a.radius + b.radius - distance;
            if depth > slack(a).max(slack(b)) {
                found.add([first.min(second), first.max(second)], depth);
            }
        }
    }
    found
}

fn slack(ball: &Ball) -> f64 {
    let far = ball.centre.iter().fold(ball.radius, |size, v| size.max(v.abs()));
    SLACK * ball.radius + 8.0 * f64::EPSILON * far
}

fn plural(count: u64, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A number with three digits.
fn figure(value: f64) -> String {
    let digits = (2.0 - value.log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{value:.digits$}")
}
