//! Names beside points, where there is room for them.

use super::layout::width;

/// Height that a name takes.
const HIGH: f64 = 13.0;
/// From a point's centre to its name.
const GAP: f64 = 7.0;

/// A name's place: left end and base line.
pub(super) type Place = (f64, f64);

/// A line from one point to another.
pub(super) type Stroke = [(f64, f64); 2];

/// A place for each name beside its point, or `None` if it would lie over a point, another name or the border. A place
/// that no line crosses is taken before one that a line does. Points are x, y and name, in pixels, and get their places
/// in this order; `within` is left, top, right, bottom.
pub(super) fn place(points: &[(f64, f64, &str)], lines: &[Stroke], within: [f64; 4]) -> Vec<Option<Place>> {
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
        let is_crossed = |&place: &Place| lines.iter().any(|line| crosses(line, frame(place)));
        let open = || candidates.iter().copied().filter(free);
        let found = open().find(|place| !is_crossed(place)).or_else(|| open().next());
        taken.extend(found.map(frame));
        places.push(found);
    }
    places
}

/// Whether a line crosses a frame: the part of it that lies between each pair of opposite sides is not empty.
fn crosses(&[(ax, ay), (bx, by)]: &Stroke, [left, top, right, bottom]: [f64; 4]) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (start, end, least, most) in [(ax, bx, left, right), (ay, by, top, bottom)] {
        let way = end - start;
        if way == 0.0 {
            if start < least || start > most {
                return false;
            }
            continue;
        }
        let (first, second) = ((least - start) / way, (most - start) / way);
        from = from.max(first.min(second));
        to = to.min(first.max(second));
    }
    from <= to
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cover_neither_points_nor_one_another() {
        let points: Vec<(f64, f64, &str)> =
            (0..40).map(|i| (50.0 + f64::from(i % 8) * 60.0, 30.0 + f64::from(i / 8) * 9.0, "a name")).collect();
        let places = place(&points, &[], [0.0, 0.0, 600.0, 300.0]);
        let boxes: Vec<[f64; 4]> =
            places.iter().flatten().map(|&(x, y)| [x, y - HIGH + 3.0, x + width("a name"), y + 3.0]).collect();
        assert!(boxes.len() >= 8, "{}", boxes.len());
        let apart = |a: &[f64; 4], b: &[f64; 4]| a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
        for (i, a) in boxes.iter().enumerate() {
            assert!(boxes[..i].iter().all(|b| apart(a, b)), "{a:?}");
            assert!(points.iter().all(|&(x, y, _)| apart(a, &[x - 3.9, y - 3.9, x + 3.9, y + 3.9])), "{a:?}");
        }
        // To the right, unless a line is there; and there all the same if lines are everywhere.
        let alone =
            |lines: &[Stroke]| place(&[(100.0, 100.0, "a name")], lines, [0.0, 0.0, 300.0, 200.0])[0].expect("room");
        let right = alone(&[]);
        assert!(right.0 > 100.0);
        assert!(alone(&[[(100.0, 100.0), (300.0, 101.0)]]).0 < 100.0);
        assert_eq!(alone(&[[(250.0, 0.0), (250.0, 200.0)], [(0.0, 20.0), (300.0, 20.0)]]), right);
        let rows: Vec<Stroke> = (0..40).map(|i| [(0.0, f64::from(i) * 5.0), (300.0, f64::from(i) * 5.0)]).collect();
        assert_eq!(alone(&rows), right);
        assert_eq!(place(&[(1.0, 1.0, "no room at all")], &[], [0.0, 0.0, 20.0, 20.0]), [None]);
    }
}
