//! Memories of the search, each a word two cycles after its place: in look-up tables if it is shallow, otherwise in
//! block memory.

use super::{ROW, ROW_NUMBER_BITS, Sizes};
use crate::afu::Spec;
use crate::afu::lines::{self, Access, line_memory};
use crate::hdl::{BuildErrors, Graph, Signal};

/// Cycles from a place to its word.
pub(super) const CYCLES_TO_WORD: u32 = lines::CYCLES_TO_WORD;
/// Registers with the same place.
const COPIES: u32 = 4;
/// A deeper memory is one of block memories.
const DEEPEST_IN_TABLES: u32 = 64;

/// The box of a row that is searched, as the input `write_NAME_box`, which is written where `write_NAME` is set for
/// the row `write_NAME_row`: that of `row` two cycles ago. It is kept as long as the row's spheres are.
pub(super) fn kept_boxes<'g>(
    graph: &'g Graph,
    spec: &Spec,
    sizes: &Sizes,
    name: &str,
    row: Signal<'g>,
) -> Result<Signal<'g>, BuildErrors> {
    let kept = sizes.kept_bits;
    let write = graph.input(&format!("write_{name}"), 1);
    let write_row = graph.input(&format!("write_{name}_row"), ROW_NUMBER_BITS).low(kept);
    let bounds = graph.input(&format!("write_{name}_box"), sizes.box_bits());
    Store::new(spec, kept).column(graph, &format!("{name}_boxes"), [write, write_row, bounds], row.low(kept))
}

/// The place at which the memories of a row's 16 columns read, in registers: one for every four columns.
pub(super) struct Places<'g>(Vec<Signal<'g>>);

impl<'g> Places<'g> {
    /// The place of a cycle ago.
    pub(super) fn new(place: Signal<'g>, name: &str) -> Self {
        Self(place.data_copies(name, COPIES))
    }

    /// The place for a column.
    pub(super) fn of(&self, column: u32) -> Signal<'g> {
        self.0[(column * COPIES / ROW) as usize]
    }
}

/// Memories of the same depth.
pub(super) struct Store<'a> {
    spec: &'a Spec,
    depth: u32,
}

impl<'a> Store<'a> {
    /// Memories with places of `bits` bits.
    pub(super) fn new(spec: &'a Spec, bits: u32) -> Self {
        Self { spec, depth: 1 << bits }
    }

    /// A memory of this name, with its writes (enable, place, word): the word at `place` two cycles ago.
    pub(super) fn column<'g>(
        &self,
        graph: &'g Graph,
        name: &str,
        [write, write_place, word]: [Signal<'g>; 3],
        place: Signal<'g>,
    ) -> Result<Signal<'g>, BuildErrors> {
        if self.depth <= DEEPEST_IN_TABLES {
            let memory = graph.memory(name, self.depth, word.width());
            memory.write(write, write_place, word);
            let read = memory.read(place).named(&format!("{name}_read"));
            return Ok(read.delay(1).named(&format!("{name}_word")));
        }
        let always = graph.constant(1, 1);
        let access = Access {
            write: &[write],
            write_index: write_place,
            line: word,
            read: &[always],
            read_index: place,
            advance: &[always],
        };
        line_memory(graph, self.spec, name, self.depth, &access)
    }

    /// A memory of the spheres of rows, which are written side by side where `writes` (enable, place) says: the word of
    /// the sphere at `place` (row, column) two cycles ago.
    pub(super) fn sides<'g>(
        &self,
        graph: &'g Graph,
        name: &str,
        (write, write_place): (Signal<'g>, Signal<'g>),
        words: &[Signal<'g>],
        (row, column): (Signal<'g>, Signal<'g>),
    ) -> Result<Signal<'g>, BuildErrors> {
        let [_, _] = words else {
            return self.column(graph, name, [write, write_place, words[0]], row.concat(column));
        };
        let place = row.concat(column.drop_low(1));
        let mut sides = Vec::new();
        for (word, side) in words.iter().zip(["even", "odd"]) {
            sides.push(self.column(graph, &format!("{name}_{side}"), [write, write_place, *word], place)?);
        }
        Ok(column.bit(0).delay(CYCLES_TO_WORD).named(&format!("{name}_is_odd")).select(sides[1], sides[0]))
    }
}
