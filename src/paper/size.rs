//! The numbers of collisions that are tried.

/// The numbers of collisions of the two figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// The paper's numbers: 10 to 1000 in steps of 10, and 1000 to 90 000 in steps of 1000.
    Full,
    /// Eleven numbers of the first figure and four of the second, for a run under a minute.
    Quick,
}

impl Size {
    /// The numbers of Figure 6, up to `most`.
    pub fn figure6(self, most: usize) -> Vec<usize> {
        let step = if self == Self::Full { 10 } else { 100 };
        let points = [10].into_iter().chain((step..=1000).step_by(step).filter(|&n| n > 10));
        points.filter(|&n| n <= most).collect()
    }

    /// The numbers of Figure 7, up to `most`.
    pub fn figure7(self, most: usize) -> Vec<usize> {
        let points = match self {
            Self::Full => (1000..=90_000).step_by(1000).collect(),
            Self::Quick => vec![1000, 10_000, 30_000, 90_000],
        };
        points.into_iter().filter(|&n| n <= most).collect()
    }

    /// The numbers of both figures, in increasing order.
    pub fn all(self, most: usize) -> Vec<usize> {
        let mut points = [self.figure6(most), self.figure7(most)].concat();
        points.sort_unstable();
        points.dedup();
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_full_size_is_the_papers() {
        let (six, seven) = (Size::Full.figure6(90_000), Size::Full.figure7(90_000));
        assert_eq!((six.len(), six[0], six[1], six[99]), (100, 10, 20, 1000));
        assert_eq!((seven.len(), seven[0], seven[89]), (90, 1000, 90_000));
        assert_eq!(Size::Full.all(90_000).len(), 189);
        assert_eq!(
            Size::Quick.all(90_000),
            [10, 100, 200, 300, 400, 500, 600, 700, 800, 900, 1000, 10_000, 30_000, 90_000]
        );
        assert_eq!(Size::Full.all(25), [10, 20]);
    }
}
