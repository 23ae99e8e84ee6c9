//! Names beside points, where there is room for them.

use super::layout::width;

/// Height that a name takes.
const HIGH: f64 = 13.0;
/// From a point's centre to its name.
const GAP: f64 = 7.0;

/// A name's place: left end and base line.
pub(super) type Place = (f64, f64);

/// A place for each name beside its point, or none where it would lie over a point, another name or the border. Points
/// are x, y and name, in pixels and in the order in which they get a place; `within` is left, top, right, bottom.
pub(super) fn place(points: &[(f64, f64, &str)], within: [f64; 4]) -> Vec<Option<Place>> {
    let mut taken: Vec<[f64; 4]> = points.iter().map(|&(x, y, _)| [x - 4.0, y - 4.0, x + 4.0, y + 4.0]).collect();
    let [left, top, right, bottom] = within;
    let mut places = Vec::new();
    for &(x, y, name) in points {
        let wide = width(name);
        // Right, left, above, below, and then the corners.
        let middle = y + HIGH / 2.0 - 2.5;
        let candidates = [
            (x + GAP, middle),
            (x - GAP - wide, middle),
            (x - wide / 2.0, y - GAP),
            (x - wide / 2.0, y + GAP + HIGH - 3.0),
            (x + GAP, y - GAP),
            (x + GAP, y + GAP + HIGH - 5.0),
            (x - GAP - wide, y - GAP),
            (x - GAP - wide, y + GAP + HIGH - 5.0),
        ];
        let frame = |(x, y): Place| [x, y - HIGH + 3.0, x + wide, y + 3.0];
        let free = |&place: &Place| {
            let [l, t, r, b] = frame(place);
            l >= left
                && t >= top
                && r <= right
                && b <= bottom
                && taken.iter().all(|&[tl, tt, tr, tb]| r <= tl || l >= tr || b <= tt || t >= tb)
        };
        let found = candidates.into_iter().find(free);
        taken.extend(found.map(frame));
        places.push(found);
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cover_neither_points_nor_one_another() {
        let points: Vec<(f64, f64, &str)> =
            (0..40).map(|i| (50.0 + f64::from(i % 8) * 60.0, 30.0 + f64::from(i / 8) * 9.0, "a name")).collect();
        let places = place(&points, [0.0, 0.0, 600.0, 300.0]);
        let boxes: Vec<[f64; 4]> =
            places.iter().flatten().map(|&(x, y)| [x, y - HIGH + 3.0, x + width("a name"), y + 3.0]).collect();
        assert!(boxes.len() >= 8, "{}", boxes.len());
        let apart = |a: &[f64; 4], b: &[f64; 4]| a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
        for (i, a) in boxes.iter().enumerate() {
            assert!(boxes[..i].iter().all(|b| apart(a, b)), "{a:?}");
            assert!(points.iter().all(|&(x, y, _)| apart(a, &[x - 3.9, y - 3.9, x + 3.9, y + 3.9])), "{a:?}");
        }
        assert_eq!(place(&[(1.0, 1.0, "no room at all")], [0.0, 0.0, 20.0, 20.0]), [None]);
    }
}
