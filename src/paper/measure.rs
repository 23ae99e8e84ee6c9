//! ODE's part: collisions recorded in the diamond, and timed on this machine.

use super::OdePoint;
use crate::ode::{Benchmark, Error, Ode, Recording};

/// The measured figures.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The collisions.
    pub recording: Recording,
    /// A point for each requested number of collisions.
    pub points: Vec<OdePoint>,
    /// Instruction set of the f32 kernel.
    pub level: &'static str,
}

/// Runs the benchmark. Then times its first collisions, as many as each of `counts` says, in `passes` passes. `done` is
/// called with the number of points measured so far.
///
/// # Errors
/// Returns the errors of [`Benchmark::run`] and [`Recording::figures`].
pub fn measure(
    ode: &Ode,
    benchmark: &Benchmark,
    counts: &[usize],
    passes: usize,
    mut done: impl FnMut(usize),
) -> Result<Measured, Error> {
    let recording = benchmark.run(ode)?;
    let mut points = Vec::new();
    let mut level = "";
    for &count in counts {
        let figures = recording.figures(ode, count, passes)?;
        level = figures.level;
        points.push(OdePoint {
            collisions: figures.collisions,
            rule_ns: figures.rule_ns,
            loop_ns: figures.calls.least_ns,
            loop_median_ns: figures.calls.median_ns,
            batch_ns: figures.kernel.least_ns,
            records_ns: figures.records.least_ns,
        });
        done(points.len());
    }
    Ok(Measured { recording, points, level })
}
