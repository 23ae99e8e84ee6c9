//! Each sphere of the row that is searched against the box of another row, 16 comparisons at once.

use std::sync::Arc;

use super::bits::number;
use super::bounds::{CYCLES_TO_MEET, meet};
use super::nth::{count_up_to_slices, cycles_to_count};
use super::store::{CYCLES_TO_WORD, Store};
use super::walk::{Item, walk};
use super::{KEPT_ROWS, ROW, ROW_NUMBER_BITS, SLACK, Sizes};
use crate::afu::Spec;
use crate::afu::counter::later;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Cycles from a step to the spheres that it found.
const CYCLES_TO_FIND: u32 = CYCLES_TO_WORD + CYCLES_TO_MEET;
/// Cycles from a step to what comes out: the spheres, and how many steps they take.
const CYCLES: u32 = CYCLES_TO_FIND + cycles_to_count(1) + 1;
/// So many steps still fit into the queue behind when it has no room left.
const _: () = assert!(CYCLES <= SLACK);

/// Builds the module `contact_afu_near`. An item is the row that is searched, a group's number, the rows of it whose
/// boxes meet that of the row, and whether it is the last. What comes out is the row, another row's number, the
/// spheres of the first that are near the other, and a bit for each step that comparing these takes.
pub(super) fn near(spec: &Spec, sizes: &Sizes) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_near");
    graph.about("compares each sphere of a row with the box of another row");
    let start = graph.input("start", 1);
    let may_step = graph.input("may_step", 1);
    let row = graph.input("item_row", ROW_NUMBER_BITS);
    let place = graph.input("item_place", sizes.group_bits);
    let item = Item {
        valid: graph.input("item_valid", 1),
        mask: graph.input("item_mask", ROW),
        about: Signal::join(&[row, place, graph.input("item_last", 1)]),
    };
    let walk = walk(&graph, start, &item, may_step);

    let other = walk.about.slice(1, sizes.group_bits).concat(number(walk.bit)).named("other_row");
    let write = ["write", "write_row", "write_box"]
        .into_iter()
        .zip([1, sizes.row_bits, sizes.box_bits()])
        .map(|(name, width)| graph.input(name, width))
        .collect::<Vec<_>>();
    let bounds = Store::new(spec, sizes.row_bits).column(&graph, "around", [write[0], write[1], write[2]], other)?;
    // All boxes of the row that is searched, at once.
    let row = walk.about.high(ROW_NUMBER_BITS).named("row_in_hand");
    let kept = KEPT_ROWS.ilog2();
    let column = graph.input("write_column", sizes.loaded_bits());
    let write_own = graph.input("write_own", 1);
    let own_row = graph.input("write_own_row", ROW_NUMBER_BITS).low(kept);
    let own_boxes = sizes.of_loaded("write_own_box");
    let own_boxes: Vec<_> = own_boxes.iter().map(|name| graph.input(name, sizes.box_bits())).collect();
    let store = Store::new(spec, kept);
    let mut meets = Vec::new();
    for place in 0..ROW {
        let (is_loaded, side) = sizes.is_loaded(column, place);
        let writes = [(is_loaded & write_own).named(&format!("writes_own_{place}")), own_row, own_boxes[side]];
        let mine = store.column(&graph, &format!("own_{place}"), writes, row.low(kept))?;
        meets.push(meet(mine, bounds, &format!("meets_{place}")));
    }
    meets.reverse();
    let meets = Signal::join(&meets);
    let stepped = later(start, walk.steps, CYCLES_TO_FIND, "stepped");
    let had_bit = walk.bit.any().delay(CYCLES_TO_FIND).named("had_bit");
    let ends = (walk.is_last & walk.about.bit(0)).delay(CYCLES_TO_FIND).named("ends_row");
    let found = meets.gate(had_bit).named("found");
    let put = (stepped & (found.any() | ends)).named("puts");
    // As many spheres at a time as there are comparisons side by side.
    let count = count_up_to_slices("near", found)[0];
    let turns: Vec<_> =
        (0..sizes.turns()).rev().map(|turn| count.greater_than(count.same((turn * sizes.compared).into()))).collect();
    let rest = CYCLES - CYCLES_TO_FIND;
    graph.output("takes", walk.takes);
    graph.output("put", later(start, put, rest, "putting"));
    graph.output("row", row.delay(CYCLES).named("row"));
    graph.output("other", other.delay(CYCLES).named("other"));
    graph.output("spheres", found.delay(rest).named("spheres"));
    graph.output("mask", Signal::join(&turns).named("turns").delay(1).named("mask"));
    graph.output("last", ends.delay(rest).named("last"));
    graph.finish()
}
