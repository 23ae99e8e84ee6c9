//! Times a piece of work many times.

use std::time::{Duration, Instant};

/// Work shorter than this is repeated between two readings of the clock.
const LONG_ENOUGH: Duration = Duration::from_micros(50);

/// The time of a piece of work, in nanoseconds. On a shared machine the minimum is the most meaningful.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// The minimum.
    pub least_ns: f64,
    /// The median.
    pub median_ns: f64,
}

impl Timing {
    /// Times `work` in `passes` passes, at least one, after a warm-up pass.
    pub(super) fn of(passes: usize, mut work: impl FnMut()) -> Self {
        let mut time = |repeats: u32| {
            let begin = Instant::now();
            (0..repeats).for_each(|_| work());
            begin.elapsed()
        };
        time(1);
        let mut repeats = 1;
        while repeats < 1 << 20 && time(repeats) < LONG_ENOUGH {
            repeats *= 2;
        }
        let pass = |_| time(repeats).as_nanos() as f64 / f64::from(repeats);
        Self::from_passes((0..passes.max(1)).map(pass).collect())
    }

    fn from_passes(mut passes: Vec<f64>) -> Self {
        passes.sort_by(f64::total_cmp);
        Self { least_ns: passes[0], median_ns: passes[passes.len() / 2] }
    }
}

/// The time between two consecutive readings of the clock: the median of many.
pub(super) fn clock_ns() -> f64 {
    let looks: Vec<f64> = (0..1001).map(|_| Instant::now().elapsed().as_nanos() as f64).collect();
    Timing::from_passes(looks).median_ns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_and_least_are_those_of_the_passes() {
        assert_eq!(Timing::from_passes(vec![3.0, 1.0, 2.0]), Timing { least_ns: 1.0, median_ns: 2.0 });
    }

    #[test]
    fn work_is_done_once_at_least_for_every_pass() {
        let mut times = 0_u32;
        let timing = Timing::of(3, || {
            times += 1;
            std::thread::sleep(LONG_ENOUGH);
        });
        assert_eq!(times, 5, "to warm up, to see that once is long enough, three passes");
        assert!(timing.least_ns >= LONG_ENOUGH.as_nanos() as f64 && timing.median_ns >= timing.least_ns);
    }
}
