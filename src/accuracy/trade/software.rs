//! The same arithmetic in software, timed on this machine.

use crate::config::Config;
use crate::kernel::batch::{Batch, Level};
use crate::kernel::double::Doubles;
use crate::query::{Fields, PairRecord};
use std::hint::black_box;
use std::time::Instant;

/// Number of passes; the shortest counts.
const PASSES: usize = 5;
/// Number of pairs for software in any format, and for the fastest kernels; both stay in a cache.
const PAIRS: usize = 2_000;
const KERNEL_PAIRS: usize = 4_096;

/// Nanoseconds per pair of a configuration's reference kernel, on one thread.
pub(super) fn of_config(config: &Config, pairs: &[PairRecord]) -> Option<f64> {
    let pairs = &pairs[..pairs.len().min(PAIRS)];
    let reference = config.reference();
    shortest(pairs.len(), PASSES, || {
        black_box(reference.run_all(black_box(pairs)));
    })
}

/// Nanoseconds per pair of the fastest kernels of this machine, on one thread, in their own layout.
pub(super) fn kernels(pairs: &[PairRecord]) -> Vec<(String, f64)> {
    let pairs = &pairs[..pairs.len().min(KERNEL_PAIRS)];
    let (batch, mut contacts) = (Batch::from_pairs(pairs), Batch::zeros(pairs.len()));
    let level = Level::best();
    let ns = shortest(pairs.len(), 40 * PASSES, || {
        level.run(black_box(&batch), &mut contacts, Fields::ALL);
        black_box(&mut contacts);
    });
    let mut doubles = Doubles::from_pairs(pairs);
    let wide = doubles.run();
    let wide_ns = shortest(pairs.len(), 40 * PASSES, || {
        black_box(&mut doubles).run();
    });
    let named = |name: &str, level: &str, ns: Option<f64>| ns.map(|ns| (format!("{name}, {level}"), ns));
    named("f32", level.name(), ns).into_iter().chain(named("f64", wide, wide_ns)).collect()
}

fn shortest(pairs: usize, passes: usize, mut run: impl FnMut()) -> Option<f64> {
    let pass = || {
        let begun = Instant::now();
        run();
        begun.elapsed().as_secs_f64()
    };
    let least = std::iter::repeat_with(pass).take(passes).reduce(f64::min)?;
    (pairs > 0).then(|| 1e9 * least / pairs as f64)
}
