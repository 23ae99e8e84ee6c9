//! Joins the answers of the deciders, in the order of the steps that they belong to, and numbers the hits: up to four
//! of a step leave in a cycle.

use std::sync::Arc;

use super::bits::{count, number, place_of};
use super::nth::{count_up_to_slices, cycles_to_count, cycles_to_nth, nth};
use super::walk::{Item, walk};
use super::{NUMBER_BITS, QUEUE, ROW, ROW_BITS, ROW_NUMBER_BITS, SLACK, Sizes};
use crate::afu::COUNT_BITS;
use crate::afu::counter::later;
use crate::afu::queue::{queue, steering_queue};
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Numbers of hits that leave in a cycle, at most.
pub(in crate::afu) const HIT_LANES: u32 = 4;
/// Cycles from a step of hits to their numbers, for so many spheres that are compared side by side.
pub(super) const fn cycles_to_numbers(compared: u32) -> u32 {
    cycles_to_nth(compared) + 3
}

/// Steps that are being counted when the queue behind has no room left still fit into it.
const _: () = assert!(cycles_to_count(ROW) + 2 <= SLACK);

/// Builds the module `contact_afu_hits`, of which so many hits of a step leave in a cycle. It remembers each step
/// of the last comparison until it is decided. A hit is the number of the first sphere, below that of the second.
pub(super) fn hits(sizes: &Sizes, lanes: u32) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_hits");
    graph.about("joins decisions in order, and gives each hit the numbers of its two spheres");
    let (compared, places_bits) = (sizes.compared, sizes.places_bits());
    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let may_leave = graph.input("may_leave", 1);
    let put = graph.input("put", 1);
    let own_row = graph.input("own_row", ROW_NUMBER_BITS);
    let row = graph.input("row", sizes.row_bits);
    let places = (places_bits > 0).then(|| graph.input("places", places_bits));
    let last = graph.input("last", 1);
    let asked: Vec<_> = (0..sizes.deciders).rev().map(|decider| graph.input(&format!("asks_{decider}"), 1)).collect();
    let word: Vec<_> = [own_row].into_iter().chain(places).chain([row, last]).chain(asked).collect();
    let word = Signal::join(&word);
    // Whom a step asked decides when it leaves, and whether it ends its row, if it matters without hits.
    let steps = steering_queue(sizes.undecided, (word.width(), sizes.deciders + 1), SLACK)?;
    let takes = graph.wire("takes", 1);
    let steps =
        graph.instance("step_queue", &steps, &[("start", start), ("put", put), ("word", word), ("take", takes)]);
    let oldest = steps.output("oldest");
    let asked = oldest.low(sizes.deciders).named("asked");

    // A step leaves when each decider that it asked has answered.
    let mut there = Vec::new();
    let mut answers = Vec::new();
    for decider in 0..sizes.deciders {
        let valid = graph.input(&format!("answer_valid_{decider}"), 1);
        there.push(valid | !asked.bit(decider));
        let answer = graph.input(&format!("answer_{decider}"), sizes.share());
        answers.push(answer.gate(asked.bit(decider)).named(&format!("hits_of_{decider}")));
    }
    there.reverse();
    let answered = steps.output("valid") & Signal::join(&there).named("answers_there").all();
    let columns = ROW / sizes.deciders;
    let pair = |sphere: u32, column: u32| {
        answers[(column % sizes.deciders) as usize].bit(sphere * columns + column / sizes.deciders)
    };
    let all: Vec<_> = (0..compared).flat_map(|sphere| (0..ROW).map(move |column| (sphere, column))).collect();
    let matrix: Vec<_> = all.into_iter().rev().map(|(sphere, column)| pair(sphere, column)).collect();
    let matrix = Signal::join(&matrix).named("hits_of_step");
    // A step without hits leaves at once, unless it ends its row.
    let has_room = graph.wire("hits_have_room", 1);
    let leaves = (answered & has_room).named("step_leaves");
    takes.drive(leaves);
    for decider in 0..sizes.deciders {
        graph.output(&format!("take_answer_{decider}"), leaves & asked.bit(decider));
    }
    let matters = (leaves & (matrix.any() | oldest.bit(sizes.deciders))).named("step_matters");

    // The hits of a step are counted, so that it is known how often four of them leave. It waits in a queue.
    let counted = cycles_to_count(compared);
    let matrix = matrix.delay(1).named("hits_counted");
    let up_to = count_up_to_slices("hits", matrix);
    let all = up_to[compared as usize - 1];
    let beats: Vec<_> =
        (0..compared * ROW / lanes).rev().map(|beat| all.greater_than(all.same((beat * lanes).into()))).collect();
    let about = oldest.drop_low(sizes.deciders).delay(counted + 2).named("step_counted");
    let sums: Vec<_> =
        up_to.iter().zip(0..).map(|(sum, slice)| sum.delay(1).named(&format!("hits_up_to_{slice}"))).collect();
    let sums = Signal::join(&sums.into_iter().rev().collect::<Vec<_>>());
    let matrix = matrix.delay(counted + 1).named("hits_put");
    let beats = Signal::join(&beats).named("beats_of_step").delay(1).named("beats_put");
    let word = Signal::join(&[about, sums, matrix, beats]);
    let hits_inputs = [
        ("start", start),
        ("put", later(start, matters, counted + 2, "step_put")),
        ("word", word),
        ("take", graph.wire("takes_hits", 1)),
    ];
    let waiting = graph.instance("hit_queue", &queue(QUEUE, word.width(), SLACK)?, &hits_inputs);
    has_room.drive(waiting.output("has_room"));
    let word = waiting.output("oldest");
    let item =
        Item { valid: waiting.output("valid"), mask: word.low(beats.width()), about: word.drop_low(beats.width()) };
    let walk = walk(&graph, start, &item, may_leave);
    hits_inputs[3].1.drive(walk.takes);

    // The hits of four ranks, side by side.
    let beat = number(walk.bit).delay(1).named("beat");
    let ended = walk.is_last & walk.about.drop_low(compared * ROW + sums.width()).bit(0);
    let ends_row = (walk.steps & ended & !start).registered("ends_row");
    let stepped = later(start, walk.steps, 1, "stepped");
    let in_hand = walk.about.delay(1).named("step_of_hits");
    let matrix = in_hand.low(compared * ROW);
    let sum_bits = all.width();
    let up_to: Vec<_> = (0..compared).map(|slice| in_hand.slice(compared * ROW + slice * sum_bits, sum_bits)).collect();
    let place_bits = lanes.ilog2();
    let ranks: Vec<_> = (0..lanes)
        .map(|lane| if lanes == 1 { beat } else { beat.concat(graph.constant(place_bits, lane.into())) })
        .collect();
    let cycles = cycles_to_nth(compared);
    let numbers = nth(&graph, "hit", matrix, &up_to, &ranks)?;
    let all = up_to[compared as usize - 1];
    let there = ranks.iter().map(|rank| stepped & all.greater_than(rank.extend(sum_bits))).rev();
    let there = Signal::join(&there.collect::<Vec<_>>()).named("ranks_with_hit");
    let carries: Vec<_> =
        (0..lanes).map(|lane| later(start, there.bit(lane), cycles, &format!("carrying_{lane}"))).collect();
    let carries = Signal::join(&carries.into_iter().rev().collect::<Vec<_>>()).named("carried");
    // Which lanes carry a hit is known one cycle before the hits.
    graph.output("carries", carries.gate(!start).registered("carries"));
    let about = in_hand.drop_low(compared * ROW + compared * sum_bits + 1).delay(cycles).named("step_numbered");
    let row = about.low(sizes.row_bits);
    let places = (places_bits > 0).then(|| about.slice(sizes.row_bits, places_bits));
    for (number, lane) in numbers.iter().zip(0..lanes) {
        let sphere = if compared > 1 { number.drop_low(ROW_BITS) } else { *number };
        let second = about.high(ROW_NUMBER_BITS).concat(place_of(&format!("place_{lane}"), places, sphere));
        let first = row.concat(number.low(ROW_BITS)).extend(NUMBER_BITS);
        let hit = second.concat(first).named(&format!("numbers_{lane}"));
        graph.output(&format!("record_{lane}"), hit.delay(2).named(&format!("leaving_{lane}")));
    }
    let found = count("count_of_hits", carries).gate(run).registered("hits_found");
    let total = graph.register("contact_count", COUNT_BITS, 0);
    total.next(start.select(total.same(0), total.value() + found.extend(COUNT_BITS)));
    graph.output("contacts", total.value());
    graph.output("row_ends", ends_row);
    graph.output("has_room", steps.output("has_room"));
    let all_ended = graph.input("all_ended", 1);
    graph.output("all_out", later(start, all_ended, cycles + 3, "all_out_soon"));
    graph.output("waits", (walk.is_active & !may_leave).registered("waits"));
    graph.finish()
}
