//! The feeder: takes pairs from lines and gives them to the SCPUs in turn. In each cycle it gives as many as there are
//! pairs, turns and room for their results. Pair p of a job goes to SCPU p mod N, at an interval above 1 in the
//! [phase](super::rounds) of that SCPU.
//!
//! The decision which pairs leave needs only counts. The SCPUs' numbers and the pairs themselves follow it.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::counter::{Countdown, Level, from_zero};
use super::lines::CYCLES_TO_WORD;
use super::rounds::Rounds;
use super::{COUNT_BITS, SCPU_BITS, Spec, wide};

/// Register ranks from the decision which pairs leave to the pairs themselves. Their data arrive as late as lines do,
/// and are registered.
const RANKS: u32 = CYCLES_TO_WORD + 1;
/// Register ranks from the decision to the lanes that carry pairs and the SCPUs that these are for. The slots get them
/// one cycle before the pairs, so that each knows which pair it takes.
const RANKS_TO_GROUP: u32 = RANKS - 1;
/// Cycles from a line that is announced to a group of its pairs that leaves for the slots: the line is counted, it is
/// in hand, and the ranks of the decision.
pub(super) const CYCLES_TO_ISSUE: u32 = 2 + RANKS;
/// The number of groups, including the new one, whose results are not counted yet when the room for the new one is
/// checked.
const UNSEEN_GROUPS: u32 = 4;

/// The number of results, a power of two, for which there must be room when a group enters: its own, and those of
/// earlier groups that are not yet counted.
pub(super) fn room_to_enter(spec: &Spec) -> u32 {
    spec.lanes() * UNSEEN_GROUPS.next_power_of_two()
}

/// Builds the module `contact_afu_feeder`.
pub(super) fn feeder(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_feeder");
    graph.about("hands pairs to the SCPUs in turn, only when there is room for their results");
    let layout = spec.layout();
    let (per_line, pair_bits, lanes) = (layout.pairs_per_line(), layout.pair_bits(), spec.lanes());
    let place_bits = per_line.ilog2().max(1);

    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let scpus = graph.input("scpus", SCPU_BITS);
    let lines = graph.input("lines", COUNT_BITS);
    let last_place = graph.input("last_place", place_bits);
    let comes = graph.input("line_comes", 1);
    let line = graph.input("line", spec.line_bits);
    let may_enter = graph.input("may_enter", 1).registered("may_go_on");

    // A window of two lines: the line in hand, and the oldest that waits in the collector. Their contents arrive later.
    // These are the places of the next pair and of the last pair in the line in hand.
    let in_hand = graph.register("in_hand", 1, 0);
    let place = graph.data_register("place", place_bits);
    let last = graph.data_register("last", place_bits);
    let take = graph.wire("take", 1);
    let coming = Coming::new(&graph, spec, [start, comes, take], lines);
    let line_ready = coming.line_ready;
    let of_full = graph.constant(place_bits, u128::from(per_line - 1));
    let next_last = coming.last_is_next.select(last_place, of_full).named("next_last");

    let rounds = Rounds::new(&graph, spec, scpus);
    let after = |pairs: u32| {
        let place_after = place.extend(place_bits + 2).plus(u128::from(pairs));
        place_after.named(&format!("place_after_{pairs}"))
    };
    // Whether the line in hand has a pair this far behind the next one is known a cycle ahead.
    let holds: Vec<_> = (1..=lanes.min(per_line - 1)).map(|on| graph.register(&format!("holds_{on}"), 1, 0)).collect();
    let holds_at = |on: u32| holds.get(on as usize - 1).map_or(in_hand.same(0), |flag| flag.value());

    // Lane j carries a pair if all lanes before it do.
    let mut going = rounds.as_ref().map_or(may_enter, |rounds| may_enter & rounds.may_go) & *in_hand;
    let mut go = Vec::new();
    for lane in 0..lanes {
        let unit = rounds.as_ref().map_or_else(|| more_than(scpus, lane), |rounds| rounds.admits(lane));
        going = going & unit.named(&format!("unit_{lane}"));
        if lane > 0 {
            // A line may have been used up by a group that began in the line before it.
            let reach = after(lane);
            let is_next = reach.drop_low(place_bits).any() & line_ready;
            let has_place = is_in(reach.low(place_bits), next_last).named(&format!("next_line_has_place_{lane}"));
            going = going & (holds_at(lane) | (is_next & has_place)).named(&format!("present_{lane}"));
        }
        going = going.named(&format!("go_{lane}"));
        go.push(going);
    }
    let done_after = |pairs: u32| if pairs == 0 { in_hand.same(0) } else { !holds_at(pairs) };
    let line_done = by_group(&go, done_after).named("line_done");
    take.drive(line_ready & (line_done | !*in_hand));
    let taken = (take & !start).registered("taken");
    last.next_if(take, next_last);
    // In the next line, if the present one is finished; after the last line there is none, and the value is not used.
    let place_after = |pairs: u32| if per_line == 1 { place.same(0) } else { after(pairs).low(place_bits) };
    let next_place = by_group(&go, place_after).named("next_place");
    place.next((start | !*in_hand).select(place.same(0), next_place));
    // A group that goes on in the next line may use it up.
    let moved = |on: u32| {
        let goes_on =
            by_group(&go, |pairs| is_in(place_after(pairs).extend(place_bits + 2).plus(on.into()), next_last))
                .named(&format!("next_line_goes_on_{on}"));
        let begins = next_last.at_least(next_last.same(on.into()));
        in_hand.select(goes_on, begins).named(&format!("next_holds_{on}"))
    };
    in_hand.next(!start & take.select(moved(0), *in_hand & !line_done));
    for (flag, on) in holds.iter().zip(1..) {
        let stays = by_group(&go, |pairs| is_in(after(pairs + on), *last)).named(&format!("still_holds_{on}"));
        flag.next(take.select(moved(on), stays));
    }
    // The place in the collector's memory of the line after the one in hand.
    let head = graph.data_register("head", spec.max_outstanding.ilog2());
    from_zero(head, start, take, head.plus(1));
    if let Some(rounds) = &rounds {
        let ends_block = by_group(&go, |pairs| rounds.ends_block(pairs)).named("ends_block");
        rounds.advance(start, ends_block, by_group(&go, |pairs| rounds.within_after(pairs)).named("next_within"));
    }

    // The window itself, as late as lines arrive, and its pairs from the decided place on.
    let takes_line =
        wide::steering(take.delay(CYCLES_TO_WORD - 1).named("takes_line_soon"), "takes_line", spec.line_bits);
    let held = wide::register_if(&takes_line, "held", line);
    let first_place = place.delay(CYCLES_TO_WORD - 1).named("first_place_soon");
    let mut aligned = line.concat(held).named("window");
    for bit in (0..place_bits).rev() {
        let step = pair_bits << bit;
        if step < aligned.width() {
            let used = (lanes * pair_bits + step - pair_bits).min(aligned.width());
            let shifted = aligned.drop_low(step).extend(aligned.width()).low(used);
            let shifts = wide::steering(first_place.bit(bit), &format!("aligns_by_{}", 1 << bit), used);
            aligned = wide::select(&shifts, shifted, aligned.low(used)).named(&format!("aligned_by_{}", 1 << bit));
        }
    }
    let aligned = aligned.low(lanes * pair_bits).named("aligned");

    // On the way to the slots: how many pairs, on which lanes, for which SCPUs.
    let group = by_group(&go, |pairs| graph.constant(spec.group_bits(), pairs.into())).registered("entered");
    let going = go.into_iter().rev().reduce(Signal::concat).unwrap_or(*in_hand);
    let carries = (0..RANKS_TO_GROUP).fold(going, |before, rank| {
        let is_last = rank + 1 == RANKS_TO_GROUP;
        before.registered(&if is_last { "carries".to_owned() } else { format!("carries_rank_{rank}") })
    });
    let [targets, names_first] = targets(&graph, start, scpus, group, lanes);
    // No pair of the job is left to give. This is known many cycles before the last pair leaves the slots, except for a
    // job without lines, which is known as it begins. In the cycle after that, the flags do not know the lines yet.
    let some_left = (*in_hand | line_ready | coming.some_left).named("some_left");
    let all_given = graph.register("all_given", 1, 0);
    let began = start.registered("began");
    all_given.next(start.select(!lines.any(), (*all_given | !began) & !some_left));
    graph.output("entered", group);
    graph.output("all_given", all_given.value());
    graph.output("carries", carries);
    graph.output("targets", targets.delay(RANKS_TO_GROUP - 1).named("targets"));
    graph.output("names", names_first.delay(RANKS_TO_GROUP - 1).named("names"));
    graph.output("pairs", aligned.delay(1).named("pairs"));
    graph.output("head", head.value());
    graph.output("taken", taken);
    let waits = (run & some_left).named("waits");
    graph.output("waits_for_input", (waits & !*in_hand).delay(1));
    graph.output("waits_for_output", (waits & *in_hand & !may_enter).delay(1));
    graph.finish()
}

/// The lines of the job that are not in hand yet. Up to two that have come are ready to be taken, so that a line that
/// is taken decides nothing but how many are.
struct Coming<'g> {
    /// One bit: a line is ready.
    line_ready: Signal<'g>,
    /// One bit: that line is the job's last.
    last_is_next: Signal<'g>,
    /// One bit: there are lines of the job that are not ready.
    some_left: Signal<'g>,
}

impl<'g> Coming<'g> {
    /// For a job of so many `lines`, one of which `comes` and one of which is taken at `take`. Even if the link brings
    /// data that was not requested, no more than the job's lines become ready.
    fn new(graph: &'g Graph, spec: &Spec, [start, comes, take]: [Signal<'g>; 3], lines: Signal<'g>) -> Self {
        let ready = ["line_ready", "two_lines_ready"].map(|name| graph.register(name, 1, 0));
        let [one, two] = ready.map(|flag| flag.value());
        let waiting = Level::new(graph, "lines_waiting", spec.max_outstanding.ilog2() + 1, 0);
        let lines_left = Countdown::new(graph, "lines_left", COUNT_BITS);
        let (some_left, last_is_first) = (lines_left.any, lines_left.one);
        let readies = ((*waiting.any | comes) & some_left & !two).named("line_readies");
        waiting.connect(start, comes, readies);
        lines_left.connect(start, lines, readies);
        ready[0].next(!start & (readies | two | (one & !take)));
        ready[1].next(!start & one & !take & (two | readies));
        let last_ready = graph.register("last_line_ready", 1, 0);
        last_ready.next(!start & (*last_ready | (readies & last_is_first)));
        Self { line_ready: one, last_is_next: (*last_ready & !two).named("last_is_next"), some_left }
    }
}

/// The SCPUs that the lanes of a group are for, and whether that is SCPU 0; lane 0 in the lowest bits. `group` is the
/// number of its pairs.
fn targets<'g>(
    graph: &'g Graph,
    start: Signal<'g>,
    scpus: Signal<'g>,
    group: Signal<'g>,
    lanes: u32,
) -> [Signal<'g>; 2] {
    let turn = graph.register("turn", SCPU_BITS, 0);
    // The first turn that wraps. There are never more pairs in a group than SCPUs.
    let last = |pairs: u32| scpus.minus(pairs.into()).delay(1).named(&format!("turns_before_{pairs}"));
    let behind = |pairs: u32| {
        let last = last(pairs);
        let wrapped = turn.at_least(last).select(turn.value() - last, turn.plus(pairs.into()));
        wrapped.named(&format!("turn_after_{pairs}"))
    };
    let next = (1..=lanes).fold(turn.value(), |fewer, pairs| group.is(u128::from(pairs)).select(behind(pairs), fewer));
    turn.next(start.select(turn.same(0), next.named("next_turn")));
    let of_lane = |lane: u32| match lane {
        0 => (turn.value(), turn.is(0)),
        _ => (behind(lane), turn.equals(last(lane))),
    };
    let (targets, names_first): (Vec<_>, Vec<_>) = (0..lanes).rev().map(of_lane).unzip();
    [Signal::join(&targets), Signal::join(&names_first)]
}

/// `of` applied to the number of pairs that enter. Its value is computed for each possible number; the number itself
/// selects last.
fn by_group<'g>(go: &[Signal<'g>], of: impl Fn(u32) -> Signal<'g>) -> Signal<'g> {
    (1..).zip(go).fold(of(0), |fewer, (pairs, go)| go.select(of(pairs), fewer))
}

/// One bit: a line whose last pair is at `last` has one at this place.
fn is_in<'g>(place: Signal<'g>, last: Signal<'g>) -> Signal<'g> {
    place.at_most(last.extend(place.width()))
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
