//! Spheres in, contacts out: the search of [`crate::spheres`] in hardware.
//!
//! Data flows one way: collector → loader (spheres, their boxes) → rows (the boxes of a row, of 16 rows) → groups →
//! rows of groups → near (each sphere of the row against another row's box) → candidates (box against box) →
//! deciders (the kernel) → hits → resolver (contacts, if they are asked for). Between two stages there is a queue.
//! A row ends with a token in order through all of them.

mod between;
mod bits;
mod bounds;
mod candidates;
mod contacts;
mod decider;
mod hits;
mod level;
mod loader;
mod model;
mod near;
mod nth;
mod resolver;
mod rows;
mod store;
#[cfg(test)]
mod tests;
mod top;
mod waiting;
mod walk;

pub(super) use bounds::SPHERE_BITS;
pub(super) use hits::HIT_LANES;
pub use model::{PredictError, Predicted, SearchModel};
pub(super) use top::spheres_top;

use crate::config::Config;
use crate::hdl::Signal;
use crate::spheres::{BoundsRule, ROW as ROW_LENGTH, RefusedArithmetic};

/// Spheres of a row, rows of a group, boxes of a word.
const ROW: u32 = ROW_LENGTH as u32;
/// Bits of a sphere's place in its row.
const ROW_BITS: u32 = ROW.ilog2();
/// Bits of a sphere's number in a hit.
const NUMBER_BITS: u32 = 16;
/// Bits of the number of a row.
const ROW_NUMBER_BITS: u32 = NUMBER_BITS - ROW_BITS;
/// Words of a queue between two stages of the search.
const QUEUE: u32 = 16;
/// Words of a queue before a stage whose steps find little for some items and much for others.
const LONG_QUEUE: u32 = 32;
/// Of these, as many as can come after a stage was told to stop.
const SLACK: u32 = 8;

/// Widths and numbers of the parts.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    rule: BoundsRule,
    /// Bits of a row's number in the table.
    row_bits: u32,
    /// Bits of a group's number.
    group_bits: u32,
    /// Bits of the number of a word of 16 groups; 0 if there is one.
    top_bits: u32,
    /// Spheres whose boxes are compared with those of a row in a cycle.
    compared: u32,
    deciders: u32,
    /// Spheres that are loaded in a cycle, side by side: 1 or 2.
    loaded: u32,
    /// Bits of the number of a row among those that are searched or wait for it, whose spheres are kept beside the
    /// deciders: 16 rows or, where rows leave so fast that 16 would not fill all stages, 32.
    kept_bits: u32,
    /// Rows that each sphere of the row that is searched is compared with in a cycle, side by side: 1 or 2.
    near_rows: u32,
    /// Steps of the last comparison whose decisions are not joined yet, at most. So many even out how many candidates
    /// the deciders get.
    undecided: u32,
}

/// With so many lanes, two spheres are loaded in a cycle.
const LANES_FOR_TWO: u32 = 64;
/// With so many lanes, spheres are compared with the boxes of two rows in a cycle, and more rows are searched at the
/// same time. Fewer lanes are slower by themselves.
const LANES_FOR_TWO_ROWS: u32 = 128;
/// Least and most steps that are not decided. A decision takes some 35 cycles.
const UNDECIDED: std::ops::RangeInclusive<u32> = 64..=256;

impl Sizes {
    fn of(config: &Config) -> Result<Self, RefusedArithmetic> {
        let rule = BoundsRule::new(config.profile.arithmetic(), config.search.box_bits)?;
        let above = |bits: u32| bits.saturating_sub(ROW_BITS).max(1);
        let is_fast = config.search.lanes >= LANES_FOR_TWO_ROWS;
        // There are at least two groups.
        let group_bits = above(config.search.table.ilog2() - ROW_BITS);
        Ok(Self {
            rule,
            row_bits: group_bits + ROW_BITS,
            group_bits,
            top_bits: group_bits.saturating_sub(ROW_BITS),
            compared: config.search.lanes / ROW,
            deciders: config.search.deciders,
            // Few lanes are slower than one sphere per cycle, and one decider has the spheres of all columns.
            loaded: if config.search.lanes >= LANES_FOR_TWO && config.search.deciders > 1 { 2 } else { 1 },
            kept_bits: if is_fast { 5 } else { 4 },
            near_rows: if is_fast { 2 } else { 1 },
            undecided: (4 * config.search.lanes).clamp(*UNDECIDED.start(), *UNDECIDED.end()),
        })
    }

    /// Rows that are searched or wait for it, at most.
    fn kept_rows(&self) -> u32 {
        1 << self.kept_bits
    }

    /// Bits of a box.
    fn box_bits(&self) -> u32 {
        6 * self.rule.bits()
    }

    /// The names of what belongs to each sphere that is loaded in a cycle.
    fn of_loaded(&self, name: &str) -> Vec<String> {
        if self.loaded == 1 {
            vec![name.to_owned()]
        } else {
            (0..self.loaded).map(|side| format!("{name}_{side}")).collect()
        }
    }

    /// Bits of the number of the column, or the two columns side by side, that are loaded in a cycle.
    fn loaded_bits(&self) -> u32 {
        ROW_BITS - self.loaded.ilog2()
    }

    /// Whether `column` is among those of the number `loaded`, and which of them it is.
    fn is_loaded<'g>(&self, loaded: Signal<'g>, column: u32) -> (Signal<'g>, usize) {
        (loaded.is((column / self.loaded).into()), (column % self.loaded) as usize)
    }

    /// Bits of the places in their row of the spheres that are compared in a cycle; 0 if these are all.
    const fn places_bits(&self) -> u32 {
        if self.compared == ROW { 0 } else { self.compared * ROW_BITS }
    }

    /// Steps that compare the spheres of a row, at most.
    fn turns(&self) -> u32 {
        ROW / self.compared
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
