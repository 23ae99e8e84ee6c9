//! Compares an answer with the truth.

use super::Answer;
use crate::kernel::{Truth, ulp};
use crate::query::{ContactRecord, Flow, PairRecord, Query};

/// Half a unit in the last place of binary32, relative.
const HALF_ULP: f64 = 1.0 / (1 << 24) as f64;
/// The smallest binary32 number, which is added to every tolerance.
const SMALLEST: f64 = f32::from_bits(1) as f64;

/// The truth about a pair as `f64`, which is 2^29 times finer than the judged numbers.
#[derive(Clone, Copy, Debug)]
pub struct Standard {
    truth: Truth,
    rounded: ContactRecord,
    exact: Answer,
}

impl Standard {
    /// The standard for a pair, which must be valid.
    pub fn of(query: Query, pair: &PairRecord) -> Self {
        let truth = Truth::of_query(query, pair);
        let rounded = truth.record();
        let mut exact = Answer { hit: truth.is_contact(), ..Answer::default() };
        if let (Some(position), Some(normal), Some(depth)) = (truth.position(), truth.normal(), truth.depth()) {
            exact.position = position.map(|number| number.to_f64());
            exact.normal = normal.map(|number| number.to_f64());
            exact.depth = depth.to_f64();
        }
        Self { truth, rounded, exact }
    }

    /// True if the bodies really touch.
    pub fn is_contact(&self) -> bool {
        self.exact.hit
    }
}

/// The verdict on an answer: the limits of gross failure that it breaks, and its errors.
///
/// The limits: a wrong decision is gross if its [`margin`](Truth::margin) is more than 2^−20 (below that it is wrong,
/// but not gross); an infinity or a NaN; a normal whose length differs from 1 by more than 10^−6, or whose direction by
/// more than 10^−5; a depth wrong by more than 16·2^−24 of its [`scale`](Truth::scale), a position wrong by more than
/// 16·2^−24 of its own. Each tolerance has 2^−149 added. A true value beyond the largest binary32 number that is given
/// as infinity is right. If the centres coincide, any direction parts the spheres, and the position depends on it: of
/// an engine that takes another direction than ODE's, neither is judged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judgement {
    /// A contact that was not found.
    pub missed: bool,
    /// A false positive.
    pub false_hit: bool,
    /// An infinity or a NaN where the truth is finite.
    pub non_finite: bool,
    /// The normal is not a unit vector.
    pub normal: bool,
    /// The normal has a wrong direction.
    pub direction: bool,
    /// The depth is wrong.
    pub depth: bool,
    /// The position is wrong.
    pub position: bool,
    /// The answer is a gross failure.
    pub bad: bool,
    /// The engine's own arithmetic did not decide the pair.
    pub unsettled: bool,
    /// Errors of depth, normal (the largest of its components) and position, in units in the last place of binary32.
    /// The unit is that of the depth, of 1, and of the largest of the component and the numbers that it is computed
    /// from. Zero if there is nothing to compare, infinite for an infinity or a NaN.
    pub ulps: [f64; 3],
    /// The same errors, relative: of the depth and the position to their [`scale`](Truth::scale), of the normal to 1.
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

    let scale = standard.truth.scale();
    let length = length(answer.normal);
    found.non_finite = differences.iter().any(|difference| !difference.is_finite());
    found.normal = (length - 1.0).abs() > 1e-6 + SMALLEST;
    let other_way = standard.truth.flow() == Flow::Coincident && answer.normal != exact.normal;
    found.direction = !other_way && apart(answer.normal.map(|v| v / length), exact.normal) > 1e-5 + SMALLEST;
    found.depth = depth > 16.0 * HALF_ULP * scale.depth + SMALLEST;
    found.position = !other_way && position > 16.0 * HALF_ULP * scale.position + SMALLEST;
    found.bad = found.non_finite || found.normal || found.direction || found.depth || found.position;

    let in_units = |axis: usize| differences[axis] / ulp((exact.position[axis].abs() as f32).max(scale.axes[axis]));
    let positions = (0..3).map(in_units).fold(0.0, f64::max);
    found.ulps = [depth / ulp(exact.depth.abs() as f32), normal / ulp(1.0), positions];
    found.relative = [share(depth, scale.depth), normal, share(position, scale.position)];
    found
}

/// An error relative to `of`; 0 without an error.
fn share(error: f64, of: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / of }
}

/// Position, normal, depth.
fn numbers(answer: &Answer) -> impl Iterator<Item = f64> {
    answer.position.into_iter().chain(answer.normal).chain([answer.depth])
}

/// The difference between a number and the true one; 0 if both are beyond binary32. If the truth is the largest number,
/// an infinity counts as the number that would follow.
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
