//! Spheres in rows of 16, with the boxes of spheres, of rows, and of 16 rows.

use super::{Bounds, BoundsRule, Sphere};

/// Spheres per row, and rows per group.
pub const ROW: usize = 16;

/// Up to 16 boxes, by axis and column. Columns behind them are empty.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Boxes {
    pub(super) low: [[i32; ROW]; 3],
    pub(super) high: [[i32; ROW]; 3],
    /// The box around them.
    pub(super) around: Bounds,
}

impl Boxes {
    fn new(each: impl Iterator<Item = Bounds>) -> Self {
        let Bounds { low, high } = Bounds::EMPTY;
        let (low, high) = (low.map(|low| [low; ROW]), high.map(|high| [high; ROW]));
        let mut boxes = Self { low, high, around: Bounds::EMPTY };
        for (column, bounds) in each.enumerate() {
            for axis in 0..3 {
                boxes.low[axis][column] = bounds.low[axis];
                boxes.high[axis][column] = bounds.high[axis];
            }
            boxes.around = boxes.around.around(bounds);
        }
        boxes
    }

    /// The box in a column.
    #[inline(always)]
    pub(super) fn column(&self, column: usize) -> Bounds {
        Bounds { low: self.low.map(|low| low[column]), high: self.high.map(|high| high[column]) }
    }
}

/// A row's spheres, by word and column, and their boxes.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Row {
    pub(super) boxes: Boxes,
    pub(super) values: [[f32; ROW]; 4],
}

impl Row {
    /// The row of up to 16 spheres.
    fn new(rule: BoundsRule, spheres: &[Sphere]) -> Self {
        let boxes = Boxes::new(spheres.iter().map(|sphere| rule.bounds(*sphere)));
        let mut values = [[0.0; ROW]; 4];
        for (column, sphere) in spheres.iter().enumerate() {
            for (values, value) in values.iter_mut().zip(sphere.values()) {
                values[column] = value;
            }
        }
        Self { boxes, values }
    }

    /// The sphere in a column.
    #[inline(always)]
    pub(super) fn sphere(&self, column: usize) -> Sphere {
        Sphere::new(self.values.map(|value| value[column]))
    }
}

/// The boxes of spheres, in rows.
#[derive(Clone, Debug)]
pub struct Rows {
    pub(super) rows: Vec<Row>,
    /// The boxes of the rows, 16 in each.
    pub(super) groups: Vec<Boxes>,
    /// The number of invalid spheres.
    pub(super) invalid: u64,
}

impl Rows {
    /// The boxes of these spheres, in their order.
    pub fn new(rule: BoundsRule, spheres: &[Sphere]) -> Self {
        let rows: Vec<Row> = spheres.chunks(ROW).map(|row| Row::new(rule, row)).collect();
        let groups = rows.chunks(ROW).map(|rows| Boxes::new(rows.iter().map(|row| row.boxes.around))).collect();
        let invalid = spheres.iter().filter(|sphere| !sphere.is_valid()).count() as u64;
        Self { rows, groups, invalid }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Arithmetic;
    use crate::number::Format;
    use crate::spheres::lanes::{Lanes, Portable};

    #[test]
    fn a_row_compares_as_its_boxes_do() {
        let rule = BoundsRule::new(Arithmetic::Rounded(Format::WIDE), 24).expect("a rule");
        let spheres: Vec<_> = (0..13).map(|i| Sphere::new([i as f32, -(i as f32), 0.5 * i as f32, 0.6])).collect();
        let mut spheres = spheres;
        spheres[4] = Sphere::new([4.0, -4.0, 2.0, -1.0]);
        let rows = Rows::new(rule, &spheres);
        assert_eq!((rows.rows.len(), rows.groups.len(), rows.invalid), (1, 1, 1));
        for (i, sphere) in spheres.iter().enumerate() {
            let bounds = rule.bounds(*sphere);
            assert_eq!(rows.rows[0].boxes.column(i), bounds);
            let expected =
                (0..spheres.len()).filter(|&j| bounds.meets(&rule.bounds(spheres[j]))).fold(0, |m, j| m | 1 << j);
            assert_eq!(Portable.meeting(&rows.rows[0].boxes, &bounds), expected, "sphere {i}");
            assert_eq!(expected == 0, i == 4, "an invalid sphere meets none, any other itself");
        }
    }

    /// An infinite box meets every box but the one of no sphere.
    #[test]
    fn empty_columns_meet_nothing() {
        let rule = BoundsRule::new(Arithmetic::Rounded(Format::WIDE), 32).expect("a rule");
        let everywhere = Sphere::new([f32::MAX, 0.0, -f32::MAX, f32::MAX]);
        let rows = Rows::new(rule, &[everywhere, Sphere::new([0.0, 0.0, 0.0, f32::NAN])]);
        assert_eq!(Portable.meeting(&rows.rows[0].boxes, &rule.bounds(everywhere)), 1);
        assert!(!Bounds::EMPTY.meets(&Bounds::EMPTY));
        assert!(rows.groups[0].around.meets(&rule.bounds(everywhere)));
    }
}
