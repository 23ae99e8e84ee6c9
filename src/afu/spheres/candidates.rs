//! Box against box: some spheres of the row that is searched with the 16 of another row at once. Those whose boxes
//! meet are candidates.

use std::sync::Arc;

use super::bits::{chosen, count, every, number};
use super::bounds::{CYCLES_TO_MEET, meet};
use super::store::{CYCLES_TO_WORD, Store};
use super::walk::{Item, later, walk};
use super::{KEPT_ROWS, ROW, ROW_BITS, ROW_NUMBER_BITS, Sizes};
use crate::afu::{COUNT_BITS, Spec};
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Cycles from a step to what it found.
pub(super) const CYCLES: u32 = CYCLES_TO_WORD + CYCLES_TO_MEET + 1;

/// Builds the module `contact_afu_candidates`.
///
/// A step takes a chunk of the row that is searched: 1 to 16 spheres, side by side. What comes out is the number of
/// the chunk, the other row, and a bit for each pair: 16 for each sphere of the chunk.
pub(super) fn candidates(spec: &Spec, sizes: &Sizes) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_candidates");
    graph.about("compares boxes of spheres with the boxes of a row");
    let compared = sizes.compared;
    let chunks = ROW / compared;
    let box_bits = sizes.box_bits();
    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let may_step = graph.input("may_step", 1);
    let near = graph.input("item_mask", ROW);
    let row = graph.input("item_row", ROW_NUMBER_BITS);
    let other = graph.input("item_other", sizes.row_bits);
    let last = graph.input("item_last", 1);
    // A chunk is looked at if any sphere of it is near.
    let looked_at = (0..chunks).rev().map(|chunk| near.slice(chunk * compared, compared).any()).collect::<Vec<_>>();
    let item = Item {
        valid: graph.input("item_valid", 1),
        mask: Signal::join(&looked_at),
        about: Signal::join(&[near, row, other, last]),
    };
    let walk = walk(&graph, start, &item, may_step);
    let other = walk.about.slice(1, sizes.row_bits).named("other_row");
    let row = walk.about.slice(1 + sizes.row_bits, ROW_NUMBER_BITS).named("row_in_hand");
    let near = walk.about.high(ROW).named("near_spheres");

    // The boxes of the chunk: a memory for each place in it.
    let kept = KEPT_ROWS.ilog2();
    let (chunk_bits, place_bits) = (sizes.chunk_bits(), ROW_BITS - sizes.chunk_bits());
    let column = graph.input("write_column", ROW_BITS);
    let write_own = graph.input("write_own", 1);
    let write_row = graph.input("write_row", ROW_NUMBER_BITS);
    let write_box = graph.input("write_box", box_bits);
    let chunk_in_hand = (chunk_bits > 0).then(|| number(walk.bit).named("chunk_in_hand"));
    let place = with_chunk(row.low(kept), chunk_in_hand);
    let write_place = with_chunk(write_row.low(kept), (chunk_bits > 0).then(|| column.high(chunk_bits)));
    let own = Store::new(spec, kept + chunk_bits);
    let mut mine = Vec::new();
    for sphere in 0..compared {
        let is_it = if place_bits == 0 { write_own } else { write_own & column.low(place_bits).is(sphere.into()) };
        let write = is_it.named(&format!("writes_own_{sphere}"));
        mine.push(own.column(&graph, &format!("own_{sphere}"), [write, write_place, write_box], place)?);
    }
    let store = Store::new(spec, sizes.row_bits);
    let write = column.one_hot().gate(graph.input("write", 1)).named("writes_column");
    let mut others = Vec::new();
    for column in 0..ROW {
        let name = format!("column_{column}");
        others.push(store.column(
            &graph,
            &name,
            [write.bit(column), write_row.low(sizes.row_bits), write_box],
            other,
        )?);
    }

    // Within a row each pair comes once: the first sphere is the one with the lower number.
    let one_set = graph.input("one_set", 1);
    let same = (one_set & other.equals(row.low(sizes.row_bits))).delay(CYCLES - 1).named("is_same_row");
    let bit_late = walk.bit.delay(CYCLES - 1).named("chunk_compared");
    let near_late = near.delay(CYCLES - 1).named("near_compared");
    let mut pairs = Vec::new();
    for sphere in 0..compared {
        let bounds = mine[sphere as usize];
        let meets =
            (0..ROW).rev().map(|column| meet(bounds, others[column as usize], &format!("meets_{sphere}_{column}")));
        let meets = Signal::join(&meets.collect::<Vec<_>>());
        // The sphere's place in its row decides which columns of the same row are before it.
        let before = chosen(
            &format!("before_{sphere}"),
            bit_late,
            &(0..chunks)
                .map(|chunk| {
                    let place = chunk * compared + sphere;
                    graph.constant(ROW, (1_u128 << place) - 1)
                })
                .collect::<Vec<_>>(),
        );
        let near: Vec<_> = (0..chunks).map(|chunk| near_late.bit(chunk * compared + sphere)).collect();
        let is_near = chosen(&format!("is_near_{sphere}"), bit_late, &near);
        let allowed = before | (!same).repeat(ROW);
        pairs.push((meets & allowed).gate(is_near).named(&format!("candidates_{sphere}")));
    }
    pairs.reverse();
    let pairs = Signal::join(&pairs).named("candidates");
    let stepped = later(start, walk.steps, CYCLES - 1, "stepped");
    let ends = (walk.is_last & walk.about.bit(0)).delay(CYCLES - 1).named("ends_row");
    let puts = (stepped & (pairs.any() | ends)).named("puts");
    let put = (puts & !start).registered("put");
    let pairs = pairs.delay(1).named("pairs");
    graph.output("takes", walk.takes);
    graph.output("put", put);
    graph.output("row", row.delay(CYCLES).named("row"));
    graph.output("other", other.delay(CYCLES).named("other"));
    if let Some(chunk) = chunk_in_hand {
        graph.output("chunk", chunk.delay(CYCLES).named("chunk"));
    }
    graph.output("last", ends.delay(1).named("last"));
    // Column j belongs to decider j mod D.
    for decider in 0..sizes.deciders {
        let share = every(pairs, decider, sizes.deciders).named(&format!("share_{decider}"));
        graph.output(&format!("share_{decider}"), share);
    }
    // Those of each sphere are counted first, and then all of them.
    let sum_bits = (compared * ROW).ilog2() + 1;
    let of_sphere = |sphere: u32| {
        let found = count(&format!("count_{sphere}"), pairs.slice(sphere * ROW, ROW));
        found.gate(put & run).delay(1).named(&format!("found_{sphere}")).extend(sum_bits)
    };
    let found =
        (1..compared).fold(of_sphere(0), |sum, sphere| (sum + of_sphere(sphere)).named(&format!("sum_to_{sphere}")));
    let total = graph.register("candidate_count", COUNT_BITS, 0);
    let found = found.delay(1).named("found");
    total.next(start.select(total.same(0), total.value() + found.extend(COUNT_BITS)));
    graph.output("candidates", total.value());
    graph.finish()
}

/// The place of a chunk of a row; there may be one alone.
fn with_chunk<'g>(row: Signal<'g>, chunk: Option<Signal<'g>>) -> Signal<'g> {
    chunk.map_or(row, |chunk| row.concat(chunk))
}
