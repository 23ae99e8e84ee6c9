//! The feeder: takes pairs from lines and gives them to the SCPUs in turn, as many a cycle as there are pairs, turns
//! and room for their results. Pair p of a job goes to SCPU p mod N; at an interval above 1 in that one's
//! [phase](super::rounds).

use std::sync::Arc;

use crate::hdl::{Errors, Graph, Module, Signal};

use super::rounds::Rounds;
use super::{COUNT_BITS, SCPU_BITS, Spec};

/// From a line offered to a group of its pairs on their way to the slots: the line in hand, the group registered.
pub(super) const CYCLES_TO_ISSUE: u32 = 2;

/// Builds the module `contact_afu_feeder`. `room_bits` holds the number of results there is room for.
pub(super) fn feeder(spec: &Spec, room_bits: u32) -> Result<Arc<Module>, Errors> {
    let graph = Graph::new("contact_afu_feeder");
    graph.about("hands pairs to the SCPUs in turn, only when there is room for their results");
    let layout = spec.layout();
    let (per_line, pair_bits, lanes) = (layout.pairs_per_line(), layout.pair_bits(), spec.lanes());
    let place_bits = per_line.ilog2().max(1);

    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let scpus = graph.input("scpus", SCPU_BITS);
    let count = graph.input("count", COUNT_BITS);
    let line_valid = graph.input("line_valid", 1);
    let line = graph.input("line", spec.line_bits);
    let room = graph.input("room", room_bits);

    // A window of two lines: the one in hand, and the one the collector offers.
    let held = graph.data_register("held", spec.line_bits);
    let held_valid = graph.register("held_valid", 1, 0);
    let place = graph.register("place", place_bits, 0);
    let remaining = graph.register("remaining", COUNT_BITS, 0);
    let turn = graph.register("turn", SCPU_BITS, 0);

    // Lane j carries a pair when all lanes before it do.
    let rounds = Rounds::new(&graph, spec, scpus, turn.value());
    let mut going = rounds.as_ref().map_or(run, |rounds| run & rounds.may_go);
    let mut go = Vec::new();
    for lane in 0..lanes {
        let reach = place.extend(place_bits + 1).plus(u128::from(lane)).named(&format!("reach_{lane}"));
        let in_held = reach.less_than(reach.same(u128::from(per_line)));
        let present = (*held_valid & (in_held | line_valid)).named(&format!("present_{lane}"));
        let wanted = more_than(remaining.value(), lane).named(&format!("wanted_{lane}"));
        let roomy = more_than(room, lane).named(&format!("roomy_{lane}"));
        let unit = rounds.as_ref().map_or_else(|| more_than(scpus, lane), |rounds| rounds.admits(lane));
        let unit = unit.named(&format!("unit_{lane}"));
        going = (going & present & wanted & roomy & unit).named(&format!("go_{lane}"));
        go.push(going);
    }
    let group_bits = spec.group_bits();
    let group = go.iter().fold(graph.constant(group_bits, 0), |sum, go| sum + go.extend(group_bits)).named("group");

    // The pairs of the window, from `place` on.
    let window = line.concat(held.value()).named("window");
    let mut aligned = window;
    for bit in (0..place_bits).rev() {
        let step = pair_bits << bit;
        if step < aligned.width() {
            let shifted = aligned.drop_low(step).extend(aligned.width());
            aligned = place.bit(bit).select(shifted, aligned);
        }
    }
    let aligned = aligned.low(lanes * pair_bits).named("aligned");

    let sum_bits = place_bits.max(group_bits) + 1;
    let next_place = (place.extend(sum_bits) + group.extend(sum_bits)).named("next_place");
    let line_done = next_place.at_least(next_place.same(u128::from(per_line))).named("line_done");
    let take = (line_valid & (line_done | !*held_valid)).named("take");
    held.next_if(take, line);
    held_valid.next(!start & (take | (*held_valid & !line_done)));
    let wrapped = line_done.select(next_place.minus(u128::from(per_line)), next_place).named("wrapped_place");
    place.next((start | !*held_valid).select(place.same(0), wrapped.low(place_bits)));
    remaining.next(start.select(count, remaining.value() - group.extend(COUNT_BITS)));

    let next_turn = (turn.extend(SCPU_BITS + 1) + group.extend(SCPU_BITS + 1)).named("next_turn");
    let all = rounds.as_ref().map_or(scpus, |rounds| rounds.scpus).extend(SCPU_BITS + 1);
    let turn_wraps = next_turn.at_least(all).named("turn_wraps");
    let turned = turn_wraps.select(next_turn - all, next_turn).named("turned");
    turn.next(start.select(turn.same(0), turned.low(SCPU_BITS)));
    if let Some(rounds) = &rounds {
        rounds.advance(start, group, turn_wraps);
    }

    // Registered towards the slots.
    let group_out = graph.register("issue_group", group_bits, 0);
    group_out.next(group);
    graph.output("issue_group", group_out.value());
    graph.output("issue_turn", turn.delay(1).named("issue_turn"));
    graph.output("issue_pairs", aligned.delay(1).named("issue_pairs"));
    graph.output("take", take);
    graph.output("group", group);
    graph.output("waits_for_input", run & remaining.any() & !*held_valid);
    graph.output("waits_for_output", run & remaining.any() & *held_valid & !room.any());
    graph.finish()
}

/// One bit: `value` > `lane`, for a small lane: no carry chain over the whole width.
fn more_than(value: Signal<'_>, lane: u32) -> Signal<'_> {
    if lane == 0 {
        return value.any();
    }
    let bits = 32 - lane.leading_zeros();
    let low = value.low(bits);
    let high = value.drop_low(bits).any();
    high | low.greater_than(low.same(u128::from(lane)))
}
