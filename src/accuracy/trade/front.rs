//! The fronts: points that no other point beats in both error and time.

use super::axes::name;
use super::table::BASE;
use super::{Point, Study};
use crate::config::Config;
use crate::report::table::{counted, grouped};
use std::collections::BTreeSet;

/// A time that points are compared by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Time {
    /// The latency of a single pair, line in to line out.
    Lone,
    /// The time per pair of a device full of SCPUs.
    Device,
    /// The time per pair over the link.
    Link,
}

impl Time {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Lone, Self::Device, Self::Link];

    /// The time of a point, ns.
    pub fn of(self, point: &Point, results: &Study) -> Option<f64> {
        match self {
            Self::Lone => Some(point.lone_ns()),
            Self::Device => point.device_ns(results.target),
            Self::Link => Some(point.link_ns()),
        }
    }

    /// The kind of time, in words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Lone => "latency",
            Self::Device => "time per pair of a full device",
            Self::Link => "time per pair over the link",
        }
    }
}

/// The front: indices of the points of `among` with finite error and time for which no other point is at least as good
/// in both and better in one. They are ordered from the fastest to the most accurate.
pub fn front(results: &Study, time: Time, among: impl Fn(&Point) -> bool) -> Vec<usize> {
    let placed: Vec<(usize, f64, f64)> = results
        .points
        .iter()
        .enumerate()
        .filter(|(_, point)| among(point))
        .filter_map(|(index, point)| Some((index, time.of(point, results)?, results.worst(point))))
        .filter(|(_, time, error)| time.is_finite() && error.is_finite() && *error > 0.0)
        .collect();
    best(&placed)
}

/// The points on a front of any time.
pub(super) fn on_fronts(results: &Study) -> Vec<usize> {
    let all: BTreeSet<usize> = Time::ALL.into_iter().flat_map(|time| front(results, time, |_| true)).collect();
    all.into_iter().collect()
}

/// A time that is shorter by no more than this does not justify place and route, because its clocks vary more.
const SCATTER: f64 = 0.01;

/// The points that would be on a front of any time if they were routed. For this, the model's clock is multiplied by
/// the median ratio of routed to modelled clocks. (Over a link, the link's own time counts, which no clock changes.)
/// Points that are no faster than an equally accurate routed point are left out. The point that times are compared with
/// and the one that a user gets without asking are included.
pub(super) fn worth_routing(results: &Study) -> Vec<usize> {
    let mut left: Vec<f64> =
        results.points.iter().filter_map(|point| Some(point.routed_mhz()? / point.modelled_mhz)).collect();
    left.sort_by(f64::total_cmp);
    let left = left.get(left.len() / 2).copied().unwrap_or(1.0);
    let mut expected = results.clone();
    expected.points.iter_mut().for_each(|point| point.modelled_mhz *= left);
    let by = |time: Time| if time == Time::Link { results } else { &expected };
    let placed = |time: Time, point: &Point| Some((time.of(point, by(time))?, by(time).worst(point)));
    let is_better = |time: Time, index: usize| {
        let Some((own, error)) = placed(time, &by(time).points[index]) else { return false };
        let is_as_good = |(its, worst): (f64, f64)| worst <= error && its * (1.0 - SCATTER) <= own;
        let mut routed = results.points.iter().filter(|point| point.routed_mhz().is_some());
        !routed.any(|point| placed(time, point).is_some_and(is_as_good))
    };
    let better = |time| front(by(time), time, |_| true).into_iter().filter(move |&index| is_better(time, index));
    let always = [BASE.to_owned(), name(&Config::default())];
    let is_due = |point: &Point| always.contains(&point.name) && point.routed_mhz().is_none();
    let always = (0..results.points.len()).filter(|&index| is_due(&results.points[index]));
    let all: BTreeSet<usize> = Time::ALL.into_iter().flat_map(better).chain(always).collect();
    all.into_iter().collect()
}

fn best(points: &[(usize, f64, f64)]) -> Vec<usize> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut least = f64::INFINITY;
    let mut front = Vec::new();
    for (index, _, error) in sorted {
        if error < least {
            least = error;
            front.push(index);
        }
    }
    front
}

/// A sentence for a step from one point to the next along a front.
pub fn step(results: &Study, time: Time, from: &Point, to: &Point) -> String {
    let ratio = time.of(to, results).zip(time.of(from, results)).map(|(to, from)| to / from);
    let ratio = ratio.map_or_else(String::new, |ratio| format!(", for {ratio:.2} × the {}", time.words()));
    let luts = to.area().zip(from.area()).map(|(to, from)| to.luts as f64 / from.luts.max(1) as f64);
    let luts = luts.map_or_else(String::new, |luts| format!(" and {luts:.2} × the LUTs"));
    let error = format!("a largest error of {:.1e} instead of {:.1e}", results.worst(to), results.worst(from));
    let [bad, bad_before] = [to, from].map(|point| point.tally().bad);
    let bad = match (bad, bad_before) {
        (0, 0) => String::new(),
        _ => format!(" and {} instead of {}", counted(bad, "gross failure"), grouped(bad_before)),
    };
    format!(
        "From {} to {}: {error}, {} instead of {}{bad} in {}{ratio}{luts}.",
        from.name,
        to.name,
        counted(to.wrong(), "wrong decision"),
        grouped(from.wrong()),
        counted(results.pairs(), "pair"),
    )
}

#[cfg(test)]
mod tests {
    use super::{BASE, best, on_fronts, worth_routing};
    use crate::accuracy::trade::committed;
    use crate::accuracy::trade::cost::Hardware;

    #[test]
    fn a_front_has_what_nothing_beats() {
        let points =
            [(0, 5.0, 1.0), (1, 1.0, 9.0), (2, 2.0, 9.0), (3, 3.0, 4.0), (4, 4.0, 4.0), (5, 3.0, 5.0), (6, 6.0, 0.5)];
        assert_eq!(best(&points), [1, 3, 0, 6]);
        assert_eq!(best(&[]), [0; 0]);
        assert_eq!(best(&[(7, 1.0, 1.0), (8, 1.0, 1.0)]), [7], "equal points: the first");
    }

    /// If place and route slows all points equally, the first choice is the last. If another point may still be better,
    /// it is not.
    #[test]
    fn what_is_routed_is_what_a_front_may_need() {
        let mut results = committed().expect("results");
        assert!(worth_routing(&results).is_empty(), "the committed study came to its end");
        results.points.iter_mut().for_each(|point| *point = point.unrouted());
        let first = worth_routing(&results);
        let fronts = on_fronts(&results);
        assert!(fronts.len() > 5 && fronts.iter().all(|index| first.contains(index)), "{fronts:?}, {first:?}");
        for always in [BASE, "wide"] {
            assert!(first.iter().any(|&index| results.points[index].name == always), "{always}: {first:?}");
        }
        for &index in &first {
            let point = &mut results.points[index];
            let routed_mhz = Some(0.8 * point.modelled_mhz);
            point.hardware = point.hardware.take().map(|hardware| Hardware { routed_mhz, ..hardware });
            // Fewer cycles of a slower clock, because the link's own time does not change.
            point.cycles.link *= 0.8;
        }
        assert!(worth_routing(&results).is_empty(), "{:?}", worth_routing(&results));
        assert_ne!(on_fronts(&results), fronts, "by the clocks as they are, hollow points look better");

        let mut faster = results.points[fronts[0]].unrouted();
        faster.cycles.lone -= faster.cycles.lone / 10;
        results.points.push(faster);
        assert_eq!(worth_routing(&results), [results.points.len() - 1]);
    }
}
