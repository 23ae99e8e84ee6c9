//! The cheapest configuration that meets bounds, from a study's results.

use super::{Point, Study, Time};
use crate::config::{Config, SCPUS};

/// The bounds that a configuration must meet. `None` means no bound.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// The largest allowed relative error on the scenes.
    pub error: Option<f64>,
    /// The largest allowed number of nanoseconds.
    pub ns: Option<f64>,
    /// The largest allowed number of LUTs per SCPU.
    pub luts: Option<f64>,
    /// The largest allowed number of gross failures on all pairs of the study.
    pub bad: Option<f64>,
}

/// A quantity that can be bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// The largest error.
    Error,
    /// The time.
    Ns,
    /// The LUTs.
    Luts,
    /// The gross failures.
    Bad,
}

impl Bound {
    const ALL: [Self; 4] = [Self::Error, Self::Ns, Self::Luts, Self::Bad];

    fn of(self, bounds: &Bounds) -> Option<f64> {
        match self {
            Self::Error => bounds.error,
            Self::Ns => bounds.ns,
            Self::Luts => bounds.luts,
            Self::Bad => bounds.bad,
        }
    }

    fn figure(self, results: &Study, point: &Point, time: Time) -> Option<f64> {
        match self {
            Self::Error => Some(results.worst(point)),
            Self::Ns => time.of(point, results),
            Self::Luts => point.area().map(|area| area.luts as f64),
            Self::Bad => Some(point.tally().bad as f64),
        }
    }

    /// A value of the quantity, in words.
    pub fn words(self, value: f64) -> String {
        match self {
            Self::Error => format!("an error of {value:.1e}"),
            Self::Ns => format!("{value:.1} ns"),
            Self::Luts => format!("{value:.0} LUTs"),
            Self::Bad => format!("{value:.0} gross failures"),
        }
    }
}

/// An alternative: a bound that could be relaxed, the smallest value that would be enough, and the point that has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instead<'a> {
    /// The bound.
    pub bound: Bound,
    /// The value that would be enough if the other bounds are kept.
    pub value: f64,
    /// The point with this value.
    pub point: &'a Point,
}

/// The point with the fewest LUTs among the [comparable](Study::comparable) ones that meet `bounds`; of several, the
/// one with the least time. If none meets them, returns for each bound the value that would be enough if only this
/// bound were relaxed. This list is empty if even then nothing meets the others.
pub fn choose<'a>(results: &'a Study, bounds: &Bounds, time: Time) -> Result<&'a Point, Vec<Instead<'a>>> {
    let figure = |bound: Bound, point: &Point| bound.figure(results, point, time);
    let meets = |bound: Bound, point: &Point| {
        bound.of(bounds).is_none_or(|most| figure(bound, point).is_some_and(|value| value <= most))
    };
    let all = |point: &&Point, but: Option<Bound>| Bound::ALL.into_iter().all(|b| Some(b) == but || meets(b, point));
    let cost = |point: &Point| {
        let of = |bound| figure(bound, point).unwrap_or(f64::INFINITY);
        (of(Bound::Luts), of(Bound::Ns))
    };
    let cheapest = results.comparable().filter(|point| all(point, None)).min_by(|a, b| {
        let (a, b) = (cost(a), cost(b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    cheapest.ok_or_else(|| {
        let instead = |bound: Bound| {
            bound.of(bounds)?;
            let others = results.comparable().filter(|point| all(point, Some(bound)));
            let valued = others.filter_map(|point| Some((figure(bound, point)?, point)));
            let (value, point) = valued.min_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(Instead { bound, value, point })
        };
        Bound::ALL.into_iter().filter_map(instead).collect()
    })
}

/// The configuration to build for a point: its arithmetic, with the default shell. It has one SCPU or, if the time is
/// that of a full device, as many as the device holds. Its stages are cut like the point's. Its clock is the one of the
/// point's times: the router's, rounded down, or the delay model's if nothing was routed.
pub fn to_build(results: &Study, point: &Point, time: Time) -> Config {
    let default = Config::default();
    let full = point.on_device(results.target).unwrap_or(1).clamp((*SCPUS.start()).into(), (*SCPUS.end()).into());
    let scpus = if time == Time::Device { full as u32 } else { point.config.scpus };
    let clock_mhz = (100.0 * point.clock_mhz()).floor() / 100.0;
    let cut = point.config.cut_mhz();
    let cut_mhz = Some(cut).filter(|cut| *cut != clock_mhz);
    Config { scpus, shell: default.shell, clock_mhz, cut_mhz, ..point.config.clone() }
}
