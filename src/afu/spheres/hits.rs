//! Joins the answers of the deciders, in the order of the steps that they belong to, and numbers the hits: up to four
//! of one sphere leave in a cycle.

use std::sync::Arc;

use super::bits::{chosen, count, number};
use super::queue::queue;
use super::walk::{Item, later, walk};
use super::{NUMBER_BITS, ROW, ROW_NUMBER_BITS, SLACK, Sizes, UNDECIDED};
use crate::afu::COUNT_BITS;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Hits that leave in a cycle, at most: those of one sphere with this many columns side by side.
pub(super) const LANES: u32 = 4;

/// Builds the module `contact_afu_hits`. It remembers each step of the last comparison until it is decided. A hit is
/// the number of the first sphere, below that of the second.
pub(super) fn hits(sizes: &Sizes) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_hits");
    graph.about("joins decisions in order, and gives each hit the numbers of its two spheres");
    let (compared, chunk_bits) = (sizes.compared, sizes.chunk_bits());
    let start = graph.input("start", 1);
    let may_leave = graph.input("may_leave", 1);
    let put = graph.input("put", 1);
    let own_row = graph.input("own_row", ROW_NUMBER_BITS);
    let row = graph.input("row", sizes.row_bits);
    let chunk = (chunk_bits > 0).then(|| graph.input("chunk", chunk_bits));
    let last = graph.input("last", 1);
    let asked: Vec<_> = (0..sizes.deciders).rev().map(|decider| graph.input(&format!("asks_{decider}"), 1)).collect();
    let word: Vec<_> = [own_row].into_iter().chain(chunk).chain([row, last]).chain(asked).collect();
    let word = Signal::join(&word);
    let steps = queue(UNDECIDED, word.width(), SLACK)?;
    let takes = graph.wire("takes", 1);
    let steps =
        graph.instance("step_queue", &steps, &[("start", start), ("put", put), ("word", word), ("take", takes)]);
    let oldest = steps.output("oldest");
    let asked = oldest.low(sizes.deciders).named("asked");

    // A step leaves when each decider that it asked has answered.
    let mut answered = steps.output("valid");
    let mut answers = Vec::new();
    for decider in 0..sizes.deciders {
        let valid = graph.input(&format!("answer_valid_{decider}"), 1);
        answered = answered & (valid | !asked.bit(decider));
        answers.push(graph.input(&format!("answer_{decider}"), sizes.share()).gate(asked.bit(decider)));
    }
    let columns = ROW / sizes.deciders;
    let pair = |sphere: u32, column: u32| {
        answers[(column % sizes.deciders) as usize].bit(sphere * columns + column / sizes.deciders)
    };
    let all: Vec<_> = (0..compared).flat_map(|sphere| (0..ROW).map(move |column| (sphere, column))).collect();
    let matrix: Vec<_> = all.into_iter().rev().map(|(sphere, column)| pair(sphere, column)).collect();
    let matrix = Signal::join(&matrix).named("hits_of_step");
    let parts = compared * ROW / LANES;
    let parts_with_hits: Vec<_> = (0..parts).rev().map(|part| matrix.slice(part * LANES, LANES).any()).collect();
    // A step without hits leaves at once, unless it ends its row.
    let answered = answered.named("answered");
    let is_empty = (!matrix.any() & !oldest.bit(sizes.deciders)).named("has_no_hit");
    let item = Item {
        valid: (answered & !is_empty).named("has_hits"),
        mask: Signal::join(&parts_with_hits),
        about: oldest.drop_low(sizes.deciders).concat(matrix),
    };
    let walk = walk(&graph, start, &item, may_leave);
    let leaves = (walk.takes | (answered & is_empty)).named("step_leaves");
    takes.drive(leaves);
    for decider in 0..sizes.deciders {
        graph.output(&format!("take_answer_{decider}"), leaves & asked.bit(decider));
    }

    let hits: Vec<_> = (0..parts).map(|part| walk.about.slice(part * LANES, LANES)).collect();
    let hits = chosen("hits", walk.bit, &hits).gate(walk.steps & !start).registered("hits_in_part");
    let part = number(walk.bit).delay(1).named("part");
    let about = walk.about.drop_low(compared * ROW).named("step_about");
    let ends_row = (walk.steps & walk.is_last & about.bit(0) & !start).registered("ends_row");
    let about = about.drop_low(1).delay(1).named("step_of_hits");
    // Which lanes carry a hit is known one cycle before the hits.
    let packed = |lane: u32| -> Vec<u128> {
        let nth = |bits: u128| (0..LANES).filter(|place| bits >> place & 1 == 1).nth(lane as usize);
        (0..1 << LANES).map(|bits| nth(bits).map_or(0, u128::from)).collect()
    };
    let carried: Vec<u128> = (0..1_u32 << LANES).map(|bits| (1_u128 << bits.count_ones()) - 1).collect();
    graph.output("carries", hits.lookup(&carried, LANES).gate(!start).registered("carries"));
    let place_bits = LANES.ilog2();
    let quarter_bits = (ROW / LANES).ilog2();
    let row = about.low(sizes.row_bits);
    let sphere: Vec<_> = [about.high(ROW_NUMBER_BITS)]
        .into_iter()
        .chain((chunk_bits > 0).then(|| about.slice(sizes.row_bits, chunk_bits)))
        .chain((compared > 1).then(|| part.drop_low(quarter_bits)))
        .collect();
    let second = Signal::join(&sphere);
    let quarter = part.low(quarter_bits);
    for lane in 0..LANES {
        let place = hits.lookup(&packed(lane), place_bits);
        let first = Signal::join(&[row, quarter, place]).extend(NUMBER_BITS);
        let hit = second.concat(first).delay(1).named(&format!("hit_{lane}"));
        graph.output(&format!("record_{lane}"), hit.delay(1).named(&format!("leaving_{lane}")));
    }
    let found = count("count_of_hits", hits).registered("hits_found");
    let total = graph.register("contact_count", COUNT_BITS, 0);
    total.next(start.select(total.same(0), total.value() + found.extend(COUNT_BITS)));
    graph.output("contacts", total.value());
    graph.output("row_ends", ends_row);
    graph.output("has_room", steps.output("has_room"));
    let all_ended = graph.input("all_ended", 1);
    graph.output("all_out", later(start, all_ended, 4, "all_out_soon"));
    graph.output("waits", (walk.is_active & !may_leave).registered("waits"));
    graph.finish()
}
