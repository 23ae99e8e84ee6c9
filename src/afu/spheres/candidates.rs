//! Box against box: some spheres of the row that is searched with the 16 of another row at once. Those whose boxes
//! meet are candidates.

use std::sync::Arc;

use super::bits::{count, every, number};
use super::bounds::{CYCLES_TO_MEET, meet};
use super::nth::{count_up_to_slices, cycles_to_count, cycles_to_nth, nth};
use super::store::{CYCLES_TO_WORD, Store};
use super::walk::{Item, walk};
use super::{ROW, ROW_BITS, ROW_NUMBER_BITS, SLACK, Sizes};
use crate::afu::counter::later;
use crate::afu::{COUNT_BITS, Spec};
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Steps that are on the way when the queue behind has no room left still fit into it.
const _: () = assert!(cycles_to_nth(1) + CYCLES_TO_WORD + CYCLES_TO_MEET < SLACK);

/// Cycles from a step to its places, which are known at once if all spheres of a row are compared.
const fn cycles_to_places(sizes: &Sizes) -> u32 {
    if sizes.places_bits() == 0 { 0 } else { cycles_to_nth(1) }
}

/// Cycles from a step to what comes out.
pub(super) const fn cycles(sizes: &Sizes) -> u32 {
    cycles_to_places(sizes) + CYCLES_TO_WORD + CYCLES_TO_MEET + 1
}

/// Builds the module `contact_afu_candidates`.
///
/// A step takes some spheres of the row that is searched, 1 to 16 side by side: the next ones that are near the other
/// row. What comes out is their places, the other row, and a bit for each pair: 16 for each of these spheres.
pub(super) fn candidates(spec: &Spec, sizes: &Sizes) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_candidates");
    graph.about("compares boxes of spheres with the boxes of a row");
    let compared = sizes.compared;
    let box_bits = sizes.box_bits();
    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let may_step = graph.input("may_step", 1);
    let sides = sizes.near_rows;
    let other_bits = sizes.row_bits - sides.ilog2();
    let near = graph.input("item_near", sides * ROW);
    let row = graph.input("item_row", ROW_NUMBER_BITS);
    let other = graph.input("item_other", other_bits);
    let last = graph.input("item_last", 1);
    let item = Item {
        valid: graph.input("item_valid", 1),
        mask: graph.input("item_mask", sides * sizes.turns()),
        about: Signal::join(&[near, row, other, last]),
    };
    let walk = walk(&graph, start, &item, may_step);
    let near = walk.about.high(sides * ROW);
    let other = walk.about.slice(1, other_bits);
    // Of two other rows, one after the other.
    let (near, other, turn_bit) = if sides == 1 {
        (near, other, walk.bit)
    } else {
        let turns = sizes.turns();
        let is_odd = walk.bit.high(turns).any().named("is_odd_row");
        (is_odd.select(near.high(ROW), near.low(ROW)), other.concat(is_odd), walk.bit.high(turns) | walk.bit.low(turns))
    };
    let near = near.named("near_spheres");

    // The places of the next spheres; all of a row stand side by side if so many are compared.
    let is_row = sizes.places_bits() == 0;
    let cycles_to_places = cycles_to_places(sizes);
    let cycles = cycles(sizes) - 1;
    let places = if is_row {
        (0..ROW).map(|place| graph.constant(ROW_BITS, place.into())).collect()
    } else {
        let turn = if sizes.turns() > 1 { number(turn_bit) } else { graph.constant(1, 0) };
        let lanes = compared.ilog2();
        let ranks: Vec<_> = (0..compared)
            .map(|lane| if lanes == 0 { turn } else { turn.concat(graph.constant(lanes, lane.into())) })
            .collect();
        nth(&graph, "near", near, &[], &ranks)?
    };
    let near_count = count_up_to_slices("near_now", near)[0];
    let turn = turn_bit.delay(cycles_to_count(1)).named("turn_counted");
    let are_near: Vec<_> = (0..compared)
        .map(|lane| {
            if is_row {
                return near.bit(lane).delay(cycles).named(&format!("is_near_{lane}"));
            }
            let reaches = (0..sizes.turns()).map(|turn_now| {
                let rank = turn_now * compared + lane;
                turn.bit(turn_now) & near_count.greater_than(near_count.same(rank.into()))
            });
            let reaches: Vec<_> = reaches.collect();
            let there = Signal::join(&reaches).any().named(&format!("has_sphere_{lane}"));
            there.delay(cycles - cycles_to_count(1)).named(&format!("is_near_{lane}"))
        })
        .collect();
    let other = other.delay(cycles_to_places).named("other_row");
    let row = walk.about.slice(1 + other_bits, ROW_NUMBER_BITS).delay(cycles_to_places).named("row_in_hand");

    // The boxes of these spheres: a memory for each.
    let kept = sizes.kept_bits;
    let column = graph.input("write_column", sizes.loaded_bits());
    let write_own = graph.input("write_own", 1);
    let write_row = graph.input("write_row", ROW_NUMBER_BITS);
    let write_boxes = sizes.of_loaded("write_box");
    let write_boxes: Vec<_> = write_boxes.iter().map(|name| graph.input(name, box_bits)).collect();
    let own = Store::new(spec, kept);
    let own_columns = Store::new(spec, kept + sizes.loaded_bits());
    let mut mine = Vec::new();
    for (sphere, place) in (0..compared).zip(&places) {
        let name = format!("own_{sphere}");
        let (kept_row, write_kept) = (row.low(kept), write_row.low(kept));
        mine.push(if is_row {
            let (is_loaded, side) = sizes.is_loaded(column, sphere);
            let write = (write_own & is_loaded).named(&format!("writes_own_{sphere}"));
            own.column(&graph, &name, [write, write_kept, write_boxes[side]], kept_row)?
        } else {
            let place = (kept_row, *place);
            own_columns.sides(&graph, &name, (write_own, write_kept.concat(column)), &write_boxes, place)?
        });
    }
    let store = Store::new(spec, sizes.row_bits);
    let write = graph.input("write", 1);
    let mut others = Vec::new();
    for place in 0..ROW {
        let (is_loaded, side) = sizes.is_loaded(column, place);
        let write = (write & is_loaded).named(&format!("writes_column_{place}"));
        let writes = [write, write_row.low(sizes.row_bits), write_boxes[side]];
        others.push(store.column(&graph, &format!("column_{place}"), writes, other)?);
    }

    // Within a row each pair comes once: the first sphere is the one with the lower number.
    let one_set = graph.input("one_set", 1);
    let compared_cycles = CYCLES_TO_WORD + CYCLES_TO_MEET;
    let same = (one_set & other.equals(row.low(sizes.row_bits))).delay(compared_cycles).named("is_same_row");
    let places: Vec<_> = places
        .iter()
        .zip(0..)
        .map(
            |(place, lane)| {
                if is_row { *place } else { place.delay(compared_cycles).named(&format!("place_compared_{lane}")) }
            },
        )
        .collect();
    let mut pairs = Vec::new();
    for sphere in 0..compared {
        let (bounds, place) = (mine[sphere as usize], places[sphere as usize]);
        let meets =
            (0..ROW).rev().map(|column| meet(bounds, others[column as usize], &format!("meets_{sphere}_{column}")));
        let meets = Signal::join(&meets.collect::<Vec<_>>());
        // The sphere's place in its row decides which columns of the same row are before it.
        let before: Vec<_> = (0..ROW).rev().map(|column| place.greater_than(place.same(column.into()))).collect();
        let before = Signal::join(&before).named(&format!("before_{sphere}"));
        let allowed = before | (!same).repeat(ROW);
        pairs.push((meets & allowed).gate(are_near[sphere as usize]).named(&format!("candidates_{sphere}")));
    }
    pairs.reverse();
    let pairs = Signal::join(&pairs).named("candidates");
    let stepped = later(start, walk.steps, cycles, "stepped");
    let ends = (walk.is_last & walk.about.bit(0)).delay(cycles).named("ends_row");
    let puts = (stepped & (pairs.any() | ends)).named("puts");
    let put = (puts & !start).registered("put");
    let pairs = pairs.delay(1).named("pairs");
    graph.output("takes", walk.takes);
    graph.output("put", put);
    graph.output("row", row.delay(compared_cycles + 1).named("row"));
    graph.output("other", other.delay(compared_cycles + 1).named("other"));
    if !is_row {
        let places: Vec<_> = places.iter().rev().map(|place| place.delay(1)).collect();
        graph.output("places", Signal::join(&places).named("places"));
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
