//! The best of points: those that no other beats in error and time at once.

use super::{Point, Results};
use crate::report::table::grouped;

/// A time that points are compared by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Time {
    /// A lone pair, line in to line out.
    Lone,
    /// A pair through a device full of SCPUs.
    Device,
    /// A pair over the link.
    Link,
}

impl Time {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Lone, Self::Device, Self::Link];

    /// A point's, ns.
    pub fn of(self, point: &Point, results: &Results) -> Option<f64> {
        match self {
            Self::Lone => Some(point.lone_ns()),
            Self::Device => point.device_ns(results.target),
            Self::Link => Some(point.link_ns()),
        }
    }

    /// What it is a time of, in a sentence.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Lone => "latency",
            Self::Device => "time a pair of a full device",
            Self::Link => "time a pair over the link",
        }
    }
}

/// The front: indices of the points of `among` that have a finite error and time of which no other has both at most as
/// large and one smaller, from the fastest to the most accurate.
pub fn front(results: &Results, time: Time, among: impl Fn(&Point) -> bool) -> Vec<usize> {
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
pub fn step(results: &Results, time: Time, from: &Point, to: &Point) -> String {
    let ratio = time.of(to, results).zip(time.of(from, results)).map(|(to, from)| to / from);
    let ratio = ratio.map_or_else(String::new, |ratio| format!(", for {ratio:.2} × the {}", time.words()));
    let luts = to.area().zip(from.area()).map(|(to, from)| to.luts as f64 / from.luts.max(1) as f64);
    let luts = luts.map_or_else(String::new, |luts| format!(" and {luts:.2} × the LUTs"));
    let error = format!("a largest error of {:.1e} instead of {:.1e}", results.worst(to), results.worst(from));
    format!(
        "From {} to {}: {error}, {} wrong decisions instead of {} and {} gross failures instead of {} in {} pairs{ratio}{luts}.",
        from.name,
        to.name,
        grouped(to.wrong()),
        grouped(from.wrong()),
        grouped(to.tally().bad),
        grouped(from.tally().bad),
        grouped(results.pairs()),
    )
}

#[cfg(test)]
mod tests {
    use super::best;

    #[test]
    fn a_front_has_what_nothing_beats() {
        let points =
            [(0, 5.0, 1.0), (1, 1.0, 9.0), (2, 2.0, 9.0), (3, 3.0, 4.0), (4, 4.0, 4.0), (5, 3.0, 5.0), (6, 6.0, 0.5)];
        assert_eq!(best(&points), [1, 3, 0, 6]);
        assert_eq!(best(&[]), [0; 0]);
        assert_eq!(best(&[(7, 1.0, 1.0), (8, 1.0, 1.0)]), [7], "equal points: the first");
    }
}
