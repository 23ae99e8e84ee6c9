//! Spheres in, contacts out: the search of [`crate::spheres`] in hardware.
//!
//! Data flows one way: collector → loader (spheres, their boxes) → rows (the boxes of a row, of 16 rows) → groups →
//! rows of groups → near (each sphere of the row against another row's box) → candidates (box against box) → deciders
//! (the kernel) → hits. Between two stages there is a queue. A row ends with a token in order through all of them.

mod bits;
mod bounds;
mod candidates;
mod decider;
mod hits;
mod level;
mod loader;
mod near;
mod queue;
mod rows;
mod store;
#[cfg(test)]
mod tests;
mod top;
mod walk;

pub(super) use bounds::SPHERE_BITS;
pub(super) use top::spheres_top;

use crate::config::Config;
use crate::spheres::{BoundsRule, ROW as ROW_LENGTH, RefusedArithmetic};

/// Spheres of a row, rows of a group, boxes of a word.
const ROW: u32 = ROW_LENGTH as u32;
/// Bits of a sphere's place in its row.
const ROW_BITS: u32 = ROW.ilog2();
/// Bits of a sphere's number in a hit.
const NUMBER_BITS: u32 = 16;
/// Bits of the number of a row.
const ROW_NUMBER_BITS: u32 = NUMBER_BITS - ROW_BITS;
/// Rows that are searched or wait for it, at most: their spheres are kept beside the deciders.
const KEPT_ROWS: u32 = 8;
/// Words of a queue between two stages of the search.
const QUEUE: u32 = 16;
/// Of these, as many as can come after a stage was told to stop.
const SLACK: u32 = 8;
/// Steps of the last stage whose decisions are not joined yet, at most.
const UNDECIDED: u32 = 32;

/// Widths and numbers of the parts.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    rule: BoundsRule,
    /// Bits of a row's number in the table.
    row_bits: u32,
    /// Bits of a group's number.
    group_bits: u32,
    /// Bits of the number of a word of 16 groups.
    top_bits: u32,
    /// Spheres whose boxes are compared with those of a row in a cycle.
    compared: u32,
    deciders: u32,
}

impl Sizes {
    fn of(config: &Config) -> Result<Self, RefusedArithmetic> {
        let rule = BoundsRule::new(config.profile.arithmetic(), config.search.box_bits)?;
        let above = |bits: u32| bits.saturating_sub(ROW_BITS).max(1);
        // There are at least two groups.
        let group_bits = above(config.search.table.ilog2() - ROW_BITS);
        Ok(Self {
            rule,
            row_bits: group_bits + ROW_BITS,
            group_bits,
            top_bits: above(group_bits),
            compared: config.search.lanes / ROW,
            deciders: config.search.deciders,
        })
    }

    /// Bits of a box.
    fn box_bits(&self) -> u32 {
        6 * self.rule.bits()
    }

    /// Bits of the number of a part of a row that is compared in a cycle; 0 if it is the whole row.
    fn chunk_bits(&self) -> u32 {
        (ROW / self.compared).ilog2()
    }

    /// Bits of a sphere's place in the memory of its decider.
    fn decider_bits(&self) -> u32 {
        self.row_bits + self.column_bits()
    }

    /// Bits of the number of a decider's column; 0 if it has one.
    fn column_bits(&self) -> u32 {
        (ROW / self.deciders).ilog2()
    }

    /// Candidates of a step that one decider gets, at most.
    fn share(&self) -> u32 {
        self.compared * ROW / self.deciders
    }
}
