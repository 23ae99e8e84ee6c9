//! Where things go, so that no text lies over another: widths are estimated, generously.

use super::Plot;
use super::axis::Fitted;

/// Width of the whole picture.
pub(super) const WIDTH: f64 = 760.0;
/// The same on a narrow screen.
pub(super) const NARROW: f64 = 380.0;
/// Height between the axes.
const INNER: f64 = 320.0;
/// Width of a character of the small text.
const CHARACTER: f64 = 6.9;
/// Height of a line of text.
pub(super) const ROW: f64 = 18.0;
/// Length of a line in the legend.
pub(super) const SAMPLE: f64 = 34.0;

/// An upper estimate of the width of a text.
pub(super) fn width(text: &str) -> f64 {
    text.chars().count() as f64 * CHARACTER
}

/// The places of the parts of a picture.
pub(super) struct Layout {
    pub(super) x: Fitted,
    pub(super) y: Fitted,
    /// Left, top, width and height of the area between the axes.
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) wide: f64,
    pub(super) high: f64,
    /// Height of the whole picture.
    pub(super) height: f64,
    /// Left and base line of every name in the legend.
    pub(super) legend: Vec<(f64, f64)>,
    /// Centre and base line of every mark's words.
    pub(super) marks: Vec<(f64, f64)>,
}

impl Layout {
    pub(super) fn new(plot: &Plot) -> Self {
        let points = || plot.series.iter().flat_map(|series| &series.points);
        let mut x = plot.x.fit(points().map(|p| p.0).chain(plot.marks.iter().map(|mark| mark.at)));
        let y = plot.y.fit(points().map(|p| p.1));
        let widest = y.ticks.iter().map(|(_, text)| width(text)).fold(0.0, f64::max);
        let (left, right) = (34.0 + widest, 32.0);
        let width_of_all = plot.width;
        let wide = width_of_all - left - right;
        x.thin(|[a, b]| (b.0 - a.0) * wide >= (width(a.1) + width(b.1)) / 2.0 + 4.0);

        // Words of marks: in the first row where they do not touch their neighbour.
        let mut order: Vec<usize> = (0..plot.marks.len()).collect();
        order.sort_by(|&a, &b| plot.marks[a].at.total_cmp(&plot.marks[b].at));
        let mut ends: Vec<f64> = Vec::new();
        let mut places = vec![(0.0, 0); plot.marks.len()];
        for i in order {
            let half = width(&plot.marks[i].label) / 2.0;
            let wanted = left + x.place(plot.marks[i].at).clamp(0.0, 1.0) * wide;
            let centre = wanted.clamp(half + 2.0, (width_of_all - half - 2.0).max(half + 2.0));
            let row = ends.iter().position(|&end| end + 12.0 <= centre - half).unwrap_or(ends.len());
            if row == ends.len() {
                ends.push(0.0);
            }
            ends[row] = centre + half;
            places[i] = (centre, row);
        }
        let rows = ends.len();
        // Above the words of the topmost tick, which stand half a line above their own.
        let top = 34.0 + rows as f64 * ROW + if rows > 0 { 4.0 } else { 0.0 };
        let marks = places.into_iter().map(|(centre, row)| (centre, top - 10.0 - row as f64 * ROW)).collect();

        let high = INNER;
        let mut legend = Vec::new();
        let (mut across, mut down) = (left, top + high + 64.0);
        for series in &plot.series {
            let needed = SAMPLE + 8.0 + width(&series.name) + 20.0;
            if across > left && across + needed > width_of_all {
                (across, down) = (left, down + ROW + 2.0);
            }
            legend.push((across, down));
            across += needed;
        }
        Self { x, y, left, top, wide, high, height: down + 14.0, legend, marks }
    }

    /// Where a point lies in the picture.
    pub(super) fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (self.left + self.x.place(x) * self.wide, self.top + (1.0 - self.y.place(y)) * self.high)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Axis, Mark, Scale, Series};
    use super::*;

    #[test]
    fn names_in_the_legend_and_words_of_marks_do_not_overlap() {
        let axis = || Axis::new("", Scale::Linear).with_range(0.0, 100.0);
        let mut plot = Plot::new("", axis(), axis());
        for i in 0..7 {
            plot = plot.with(Series::new(&"a name of some length".repeat(1 + i % 2), i, []));
            plot = plot.marked(Mark::new(40.0 + i as f64, "some words"));
        }
        let layout = Layout::new(&plot);
        let apart = |boxes: Vec<(f64, f64, f64)>| {
            for (i, a) in boxes.iter().enumerate() {
                assert!(a.0 >= 0.0 && a.1 <= WIDTH, "{a:?} leaves the picture");
                for b in &boxes[..i] {
                    assert!((a.2 - b.2).abs() >= ROW || a.0 >= b.1 || b.0 >= a.1, "{a:?} {b:?}");
                }
            }
        };
        let names = layout.legend.iter().zip(&plot.series);
        apart(names.map(|(&(x, y), s)| (x, x + SAMPLE + 8.0 + width(&s.name), y)).collect());
        let words = layout.marks.iter().zip(&plot.marks);
        apart(words.map(|(&(x, y), m)| (x - width(&m.label) / 2.0, x + width(&m.label) / 2.0, y)).collect());
        assert!(layout.legend.iter().all(|&(_, y)| y > layout.top + layout.high && y < layout.height));
        assert!(layout.marks.iter().all(|&(_, y)| y < layout.top && y > 20.0));
    }
}
