//! A job as the AFU is told of it, whatever its lines hold.

use crate::config::Input;
use crate::patience::{SearchWork, Work};
use crate::record::Layout;

/// A job, with the lines that it may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Task {
    /// What comes in.
    pub(super) input: Input,
    /// Pairs, or spheres of the first set.
    pub(super) count: u32,
    /// Spheres of the second set.
    pub(super) others: u32,
    pub(super) mode: u32,
    pub(super) source_lines: u64,
    /// Lines that there is room for at the destination.
    pub(super) destination_lines: u64,
    /// What a search takes at most.
    pub(super) search: SearchWork,
}

impl Task {
    /// The job of this number of pairs.
    pub(super) fn of_pairs(layout: &Layout, pairs: u32) -> Self {
        let (source_lines, destination_lines) =
            (layout.source_lines(pairs.into()), layout.destination_lines(pairs.into()));
        Self { count: pairs, source_lines, destination_lines, ..Self::default() }
    }

    /// The parts of the job that take time.
    pub(super) fn work(&self, watchdog: u32) -> Work {
        let (reads, writes) = (self.source_lines, self.destination_lines);
        Work { pairs: self.count.into(), reads, writes, watchdog, search: self.search }
    }
}
