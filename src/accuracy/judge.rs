//! What is wrong with an answer.

use super::Answer;
use crate::kernel::{ContactRecord, Flow, PairRecord, Truth, ulp};

/// Half a unit in the last place of binary32, relative.
const HALF_ULP: f64 = 1.0 / (1 << 24) as f64;
/// The smallest binary32 number, which every tolerance grants.
const SMALLEST: f64 = f32::from_bits(1) as f64;

/// The truth about a pair, in numbers that answers are compared with: `f64` is 2^29 times finer than what is judged.
#[derive(Clone, Copy, Debug)]
pub struct Standard {
    pair: PairRecord,
    truth: Truth,
    rounded: ContactRecord,
    exact: Answer,
}

impl Standard {
    /// The standard for a pair, which must be valid.
    pub fn of(pair: &PairRecord) -> Self {
        let truth = Truth::of(pair);
        let rounded = truth.record();
        let mut exact = Answer { hit: truth.is_contact(), ..Answer::default() };
        if let (Some(position), Some(normal), Some(depth)) = (truth.position(), truth.normal(), truth.depth()) {
            exact.position = position.map(|number| number.to_f64());
            exact.normal = normal.map(|number| number.to_f64());
            exact.depth = depth.to_f64();
        }
        Self { pair: *pair, truth, rounded, exact }
    }

    /// Whether the spheres truly touch.
    pub fn is_contact(&self) -> bool {
        self.exact.hit
    }
}

/// What is wrong with an answer: which limits of gross failure (BAD) it breaks, and its errors.
///
/// The limits: a wrong decision is gross where the distance is more than 2^−20 of its size from the sum of the radii
/// (and wrong, but not gross, nearer by); a number that is none; a normal whose length differs from 1 by more than
/// 10^−6, or whose direction by more than 10^−5; a depth wrong by more than 16·2^−24 of the sum of the radii; a
/// position wrong by more than 16·2^−24 of the largest coordinate or radius. Each tolerance has 2^−149 added. A true
/// value beyond the largest binary32 number that is given as infinity is right. Where the centres coincide any
/// direction parts the spheres, and the place depends on it: of an engine that takes another than ODE's, neither is
/// judged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judgement {
    /// A contact that was not found.
    pub missed: bool,
    /// A contact that is none.
    pub false_hit: bool,
    /// An infinity or a NaN where the truth is finite.
    pub non_finite: bool,
    /// The normal is not a unit vector.
    pub normal: bool,
    /// The normal points elsewhere.
    pub direction: bool,
    /// The depth is wrong.
    pub depth: bool,
    /// The position is wrong.
    pub position: bool,
    /// Gross failure.
    pub bad: bool,
    /// The engine's own arithmetic did not settle it.
    pub unsettled: bool,
    /// Errors of depth, normal (the largest of its components) and position, in units in the last place of binary32:
    /// of the depth; of 1; of the largest of the component, the first centre's and the radii. Zero where there is
    /// nothing to compare, infinite for a number that is none.
    pub ulps: [f64; 3],
    /// The same errors relative to what makes them: of the depth, to the sum of the radii; of the normal, to 1; of the
    /// position, to the largest coordinate or radius.
    pub relative: [f64; 3],
}

/// Judges an answer.
pub fn judge(standard: &Standard, answer: &Answer) -> Judgement {
    let mut found = Judgement { unsettled: answer.unsettled, ..Judgement::default() };
    let exact = &standard.exact;
    if answer.hit != exact.hit {
        (found.missed, found.false_hit) = (exact.hit, answer.hit);
        found.non_finite = answer.hit && !numbers(answer).all(f64::is_finite);
        found.bad = found.non_finite || standard.truth.margin() > 1.0 / (1 << 20) as f64;
        return found;
    }
    if !answer.hit {
        return found;
    }
    let rounded = Answer::from(standard.rounded);
    let differences: Vec<f64> = numbers(answer)
        .zip(numbers(exact))
        .zip(numbers(&rounded))
        .map(|((given, exact), rounded)| difference(given, exact, rounded))
        .collect();
    let largest = |from: usize| differences[from..from + 3].iter().copied().fold(0.0, f64::max);
    let (position, normal, depth) = (largest(0), largest(3), differences[6]);

    let values = standard.pair.values();
    let radii = f64::from(values[3]) + f64::from(values[7]);
    let size = values.into_iter().map(|v| f64::from(v).abs()).fold(0.0, f64::max);
    let length = length(answer.normal);
    found.non_finite = differences.iter().any(|difference| !difference.is_finite());
    found.normal = (length - 1.0).abs() > 1e-6 + SMALLEST;
    let other_way = standard.truth.flow() == Flow::Coincident && answer.normal != exact.normal;
    found.direction = !other_way && apart(answer.normal.map(|v| v / length), exact.normal) > 1e-5 + SMALLEST;
    found.depth = depth > 16.0 * HALF_ULP * radii + SMALLEST;
    found.position = !other_way && position > 16.0 * HALF_ULP * size + SMALLEST;
    found.bad = found.non_finite || found.normal || found.direction || found.depth || found.position;

    let in_units = |axis: usize| {
        let [p1, r1, r2] = [axis, 3, 7].map(|i| values[i].abs());
        differences[axis] / ulp((exact.position[axis].abs() as f32).max(p1).max(r1).max(r2))
    };
    let positions = (0..3).map(in_units).fold(0.0, f64::max);
    found.ulps = [depth / ulp(exact.depth.abs() as f32), normal / ulp(1.0), positions];
    found.relative = [share(depth, radii), normal, share(position, size)];
    found
}

/// An error's share of what makes it; none of nothing.
fn share(error: f64, of: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / of }
}

/// Position, normal, depth.
fn numbers(answer: &Answer) -> impl Iterator<Item = f64> {
    answer.position.into_iter().chain(answer.normal).chain([answer.depth])
}

/// How far a number is from the true one; nothing where both are beyond binary32. An infinity where the truth is the
/// largest number stands for the one that would follow.
fn difference(given: f64, exact: f64, rounded: f64) -> f64 {
    if given.is_finite() {
        return (given - exact).abs();
    }
    match given == rounded {
        true => 0.0,
        false if given == f64::INFINITY.copysign(rounded) && rounded.abs() == f64::from(f32::MAX) => {
            2.0_f64.powi(128) - exact.abs()
        }
        false => f64::INFINITY,
    }
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    length([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}
