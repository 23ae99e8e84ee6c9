//! The candidate pairs of the paper's diamond, in its first step.

use crate::query::PairRecord;

/// The integer points with |x| + |y| + |z| ≤ `reach`, in lexicographic order: where the paper's diamond has its
/// spheres.
pub(crate) fn octahedron(reach: i32) -> impl Iterator<Item = [i32; 3]> {
    let side = |rest: i32| -rest..=rest;
    side(reach).flat_map(move |x| {
        let rest = reach - x.abs();
        side(rest).flat_map(move |y| side(rest - y.abs()).map(move |z| [x, y, z]))
    })
}

/// Spheres of radius ½ on the integer points of the octahedron |x| + |y| + |z| ≤ layers − 1: neighbours along an
/// axis touch exactly. A candidate is a pair whose bounding boxes touch, so whose centres differ by at most 1 along
/// each axis. Each pair comes once, the lexicographically smaller centre first, in lexicographic order.
pub fn pairs(layers: u32) -> Vec<PairRecord> {
    let reach = layers as i32 - 1;
    let inside = |[x, y, z]: [i32; 3]| x.abs() + y.abs() + z.abs() <= reach;
    let sphere = |centre: [i32; 3]| {
        let [x, y, z] = centre.map(|c| c as f32);
        [x, y, z, 0.5]
    };
    let mut pairs = Vec::new();
    for centre in octahedron(reach) {
        for step in NEXT {
            let other = std::array::from_fn(|axis| centre[axis] + step[axis]);
            if inside(other) {
                pairs.push(PairRecord::from_spheres(sphere(centre), sphere(other)));
            }
        }
    }
    pairs
}

/// The steps to neighbours whose boxes touch, in order. Of two opposite steps only the lexicographically larger is
/// here.
const NEXT: [[i32; 3]; 13] = [
    [0, 0, 1],
    [0, 1, -1],
    [0, 1, 0],
    [0, 1, 1],
    [1, -1, -1],
    [1, -1, 0],
    [1, -1, 1],
    [1, 0, -1],
    [1, 0, 0],
    [1, 0, 1],
    [1, 1, -1],
    [1, 1, 0],
    [1, 1, 1],
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Reference;
    use crate::number::Format;
    use crate::query::{Fields, Flow};

    /// The numbers of candidates and contacts that the Open Dynamics Engine finds.
    #[test]
    fn diamonds_have_the_known_numbers_of_pairs_and_contacts() {
        for (layers, candidates, contacts) in [(1, 0, 0), (3, 132, 36), (10, 12_354, 2_934), (30, 419_514, 97_614)] {
            let pairs = pairs(layers);
            assert_eq!(pairs.len(), candidates);
            let found = Reference::new(Format::WIDE, Fields::ALL).run_all(&pairs);
            let hits: Vec<_> = found.into_iter().filter(|contact| contact.is_contact()).collect();
            assert_eq!(hits.len(), contacts);
            // All of them touch in a point.
            assert!(hits.iter().all(|hit| hit.flow() == Some(Flow::Real) && hit.depth() == 0.0));
        }
    }

    #[test]
    fn no_pair_comes_twice() {
        let pairs = pairs(10);
        let distinct: std::collections::HashSet<_> = pairs.iter().collect();
        assert_eq!(distinct.len(), pairs.len());
    }
}
