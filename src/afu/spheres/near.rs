//! Each sphere of the row that is searched against the box of another row, 16 comparisons at once.

use std::sync::Arc;

use super::bits::{every, number};
use super::bounds::{CYCLES_TO_MEET, meet};
use super::nth::{count_up_to_slices, cycles_to_count};
use super::store::{CYCLES_TO_WORD, Places, Store};
use super::walk::{Item, walk};
use super::{ROW, ROW_NUMBER_BITS, SLACK, Sizes};
use crate::afu::Spec;
use crate::afu::counter::later;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Cycles from a step to the spheres that it found. The place of its boxes is registered: many memories read there.
const CYCLES_TO_FIND: u32 = 1 + CYCLES_TO_WORD + CYCLES_TO_MEET;
/// Cycles from a step to what comes out: the spheres, and how many steps they take.
pub(super) const CYCLES: u32 = CYCLES_TO_FIND + cycles_to_count(1) + 1;
/// So many steps still fit into the queue behind when it has no room left.
const _: () = assert!(CYCLES <= SLACK);

/// Builds the module `contact_afu_near`. An item is the row that is searched, a group's number, the rows of it whose
/// boxes meet that of the row, and whether it is the last. What comes out is the row, another row's number, the
/// spheres of the first that are near the other, and a bit for each step that comparing these takes. Of two other rows
/// that are compared at once, the number has no lowest bit, and the spheres and the steps are those of both.
pub(super) fn near(spec: &Spec, sizes: &Sizes) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_near");
    graph.about("compares each sphere of a row with the box of another row");
    let start = graph.input("start", 1);
    let may_step = graph.input("may_step", 1);
    let row = graph.input("item_row", ROW_NUMBER_BITS);
    let place = graph.input("item_place", sizes.group_bits);
    let valid = graph.input("item_valid", 1);
    let mask = graph.input("item_mask", ROW);
    let last = graph.input("item_last", 1);
    // Rows that are compared at once stand side by side.
    let sides = sizes.near_rows;
    let any_side = |first: u32| mask.slice(first, sides).any();
    let item = if sides == 1 {
        Item { valid, mask, about: Signal::join(&[row, place, last]) }
    } else {
        let any: Vec<_> = (0..ROW).step_by(sides as usize).rev().map(any_side).collect();
        Item {
            valid,
            mask: Signal::join(&any).named("rows_side_by_side"),
            about: Signal::join(&[row, mask, place, last]),
        }
    };
    let walk = walk(&graph, start, &item, may_step);

    let other = walk.about.slice(1, sizes.group_bits).concat(number(walk.bit)).delay(1).named("other_row");
    // All boxes are written a cycle late, too. They are not read before that.
    let write = graph.input("write", 1).registered("writes_around");
    let write_row = graph.input("write_row", sizes.row_bits).delay(1).named("written_row");
    let write_box = graph.input("write_box", sizes.box_bits()).delay(1).named("written_box");
    // Each row's box, and whether the row is one of those that are asked for.
    let side_bits = sides.ilog2();
    let arounds = Store::new(spec, sizes.row_bits - side_bits);
    let mut around = Vec::new();
    if sides == 1 {
        around.push((arounds.column(&graph, "around", [write, write_row, write_box], other)?, walk.bit.any()));
    } else {
        let rows = walk.about.slice(1 + sizes.group_bits, ROW).named("rows_of_group");
        for side in 0..sides {
            let write = (write & write_row.low(side_bits).is(side.into())).named(&format!("writes_around_{side}"));
            let writes = [write, write_row.drop_low(side_bits), write_box];
            let bounds = arounds.column(&graph, &format!("around_{side}"), writes, other)?;
            let is_asked = (every(rows, side, sides) & walk.bit).any().named(&format!("asks_{side}"));
            around.push((bounds, is_asked));
        }
    }
    // All boxes of the row that is searched, at once.
    let row = walk.about.high(ROW_NUMBER_BITS);
    let kept = sizes.kept_bits;
    let own_place = Places::new(row.low(kept), "row_in_hand");
    let column = graph.input("write_column", sizes.loaded_bits());
    let write_own = graph.input("write_own", 1);
    let own_row = graph.input("write_own_row", ROW_NUMBER_BITS).low(kept).delay(1).named("written_own_row");
    let own_boxes = sizes.of_loaded("write_own_box").into_iter().zip(sizes.of_loaded("written_own_box"));
    let own_boxes: Vec<_> =
        own_boxes.map(|(input, name)| graph.input(&input, sizes.box_bits()).delay(1).named(&name)).collect();
    let store = Store::new(spec, kept);
    let mut own_boxes_now = Vec::new();
    for place in 0..ROW {
        let (is_loaded, side) = sizes.is_loaded(column, place);
        let writes = [(is_loaded & write_own).registered(&format!("writes_own_{place}")), own_row, own_boxes[side]];
        own_boxes_now.push(store.column(&graph, &format!("own_{place}"), writes, own_place.of(place))?);
    }
    let mut found = Vec::new();
    let mut turns = Vec::new();
    for (side, (bounds, is_asked)) in around.into_iter().enumerate() {
        let name = |name: &str| if sides == 1 { name.to_owned() } else { format!("{name}_of_{side}") };
        let meets =
            own_boxes_now.iter().zip(0..).map(|(mine, place)| meet(*mine, bounds, &name(&format!("meets_{place}"))));
        let meets = Signal::join(&meets.collect::<Vec<_>>().into_iter().rev().collect::<Vec<_>>());
        let had_bit = is_asked.delay(CYCLES_TO_FIND).named(&name("had_bit"));
        let spheres = meets.gate(had_bit).named(&name("found"));
        // As many spheres at a time as there are comparisons side by side.
        let count = count_up_to_slices(&name("near"), spheres)[0];
        found.push(spheres);
        turns.extend((0..sizes.turns()).map(|turn| count.greater_than(count.same((turn * sizes.compared).into()))));
    }
    found.reverse();
    turns.reverse();
    let found = Signal::join(&found);
    let stepped = later(start, walk.steps, CYCLES_TO_FIND, "stepped");
    let ends = (walk.is_last & walk.about.bit(0)).delay(CYCLES_TO_FIND).named("ends_row");
    let put = (stepped & (found.any() | ends)).named("puts");
    let rest = CYCLES - CYCLES_TO_FIND;
    graph.output("takes", walk.takes);
    graph.output("put", later(start, put, rest, "putting"));
    graph.output("row", row.delay(CYCLES).named("row"));
    graph.output("other", other.delay(CYCLES - 1).named("other"));
    graph.output("spheres", found.delay(rest).named("spheres"));
    graph.output("mask", Signal::join(&turns).named("turns").delay(1).named("mask"));
    graph.output("last", ends.delay(rest).named("last"));
    graph.finish()
}
