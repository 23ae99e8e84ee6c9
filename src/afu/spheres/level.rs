//! A level of the tree of boxes: 16 boxes a word, which are compared at once with the box of the row that is
//! searched. The upper level has the boxes of groups of 16 rows, the lower one those of rows.

use std::sync::Arc;

use super::bits::number;
use super::bounds::{CYCLES_TO_MEET, meet};
use super::store::{CYCLES_TO_WORD, Places, Store, kept_boxes};
use super::walk::{Item, walk};
use super::{ROW, ROW_BITS, ROW_NUMBER_BITS, SLACK, Sizes};
use crate::afu::Spec;
use crate::afu::counter::later;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Cycles from a step to what it found. The place of its boxes is registered, because many memories read it.
pub(super) const CYCLES: u32 = 1 + CYCLES_TO_WORD + CYCLES_TO_MEET + 1;
/// So many steps still fit into the queue behind when it has no room left.
const _: () = assert!(CYCLES <= SLACK);

/// Which level it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    /// Of the boxes of groups.
    Groups,
    /// Of the boxes of rows.
    Rows,
}

/// Builds the module `contact_afu_groups` or `contact_afu_group_rows`.
///
/// An item is the `row` that is searched, a `place`, the 16 words from there on that are to be looked at, and whether
/// it is the `last` of its row. What comes out has the same form: a word with the boxes in it that meet that of the
/// row.
pub(super) fn level(spec: &Spec, sizes: &Sizes, level: Level) -> Result<Arc<Module>, BuildErrors> {
    let (name, about, index_bits) = match level {
        Level::Groups => {
            ("contact_afu_groups", "compares a row's box with the boxes of groups of rows", sizes.top_bits)
        }
        Level::Rows => {
            ("contact_afu_group_rows", "compares a row's box with the boxes of the rows of groups", sizes.group_bits)
        }
    };
    let graph = Graph::new(name);
    graph.about(about);
    let start = graph.input("start", 1);
    let may_step = graph.input("may_step", 1);
    let place_bits = match level {
        Level::Groups => 0,
        Level::Rows => index_bits.saturating_sub(ROW_BITS),
    };
    let place = (place_bits > 0).then(|| graph.input("item_place", place_bits));
    let about: Vec<_> = [graph.input("item_row", ROW_NUMBER_BITS)]
        .into_iter()
        .chain(place)
        .chain([graph.input("item_last", 1)])
        .collect();
    let about = Signal::join(&about);
    let item = Item { valid: graph.input("item_valid", 1), mask: graph.input("item_mask", ROW), about };
    let walk = walk(&graph, start, &item, may_step);

    // The boxes of columns are written a cycle late, too. They are not read before that.
    let column = graph.input("write_column", ROW_BITS);
    let write = column.one_hot().gate(graph.input("write", 1)).registered("writes_column");
    let write_box = graph.input("write_box", sizes.box_bits()).delay(1).named("written_box");
    let row = walk.about.high(ROW_NUMBER_BITS).delay(1).named("row_in_hand");
    let query = kept_boxes(&graph, spec, sizes, "query", row)?;
    // The word of a step, if there are several.
    let low = number(walk.bit).named("word_in_item");
    let word = (index_bits > 0).then(|| match place {
        Some(_) => walk.about.slice(1, place_bits).concat(low),
        None => low.low(index_bits),
    });
    let words = word.map(|word| Places::new(word, "word"));
    let word = words.as_ref().map(|words| words.of(0));
    let write_word = word.map(|_| graph.input("write_word", index_bits).delay(1).named("written_word"));
    let store = Store::new(spec, index_bits);
    let mut meets = Vec::new();
    for column in 0..ROW {
        let (name, write) = (format!("column_{column}"), write.bit(column));
        let bounds = match (&words, write_word) {
            (Some(words), Some(write_word)) => {
                store.column(&graph, &name, [write, write_word, write_box], words.of(column))?
            }
            // A register, which is as good as its word two cycles later: no box changes that is compared.
            _ => {
                let bounds = graph.data_register(&name, sizes.box_bits());
                bounds.next_if(write, write_box);
                bounds.value()
            }
        };
        meets.push(meet(bounds, query, &format!("meets_{column}")));
    }
    let meets = Signal::join(&meets.into_iter().rev().collect::<Vec<_>>());

    // Boxes behind the last one are not there yet.
    let cycles = CYCLES - 2;
    let one_set = graph.input("one_set", 1);
    let last_row = one_set.select(row.low(sizes.row_bits), graph.input("table_last", sizes.row_bits));
    let limit = match level {
        Level::Groups => last_row.drop_low(ROW_BITS).extend(index_bits + ROW_BITS),
        Level::Rows => last_row,
    };
    let limit = limit.delay(cycles).named("last_box");
    let word_then = word.map(|word| word.delay(cycles).named("word_then"));
    let in_last = word_then.map_or(graph.constant(1, 1), |word| word.equals(limit.drop_low(ROW_BITS)));
    let in_last = in_last.named("is_last_word");
    let present: Vec<_> = (0..ROW)
        .rev()
        .map(|column| {
            let columns = limit.low(ROW_BITS);
            !in_last | columns.at_least(columns.same(column.into()))
        })
        .collect();
    let mut found = (meets & Signal::join(&present).named("boxes_there")).named("found");
    if level == Level::Groups {
        // The group that a row is in always meets it. It is still being written, so it is not compared.
        found = found | limit.low(ROW_BITS).one_hot().gate(one_set & in_last);
    }
    // A row that is compared with none has an item without a bit.
    let stepped = later(start, walk.steps, CYCLES - 1, "stepped");
    let had_bit = walk.bit.any().delay(CYCLES - 1).named("had_bit");
    let ends = (walk.is_last & walk.about.bit(0)).delay(CYCLES - 1).named("ends_row");
    let found = found.gate(had_bit).named("found_in_word");
    let put = (stepped & (found.any() | ends)).named("puts");
    graph.output("takes", walk.takes);
    graph.output("put", (put & !start).registered("put"));
    graph.output("row", row.delay(CYCLES - 1).named("row"));
    if let Some(word) = word_then {
        graph.output("place", word.delay(1).named("place"));
    }
    graph.output("mask", found.delay(1).named("mask"));
    graph.output("last", ends.delay(1).named("last"));
    graph.finish()
}
