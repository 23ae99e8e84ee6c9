//! Credits: a pair enters only if its result has a place. A pair takes its place when it enters, and a line frees its
//! places when it leaves for memory. If only hits are written, a pair without contact frees its place as soon as the
//! decision is known, and a contact when it leaves the backlog; with `--decide`, when no pair before it is needed.
//!
//! It also knows when all pairs of the job have left the slots, and when the delay lines beside the SCPUs are filled,
//! before which no job begins.

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{BuildErrors, Graph, Module};

use super::{SCPU_BITS, Spec, feeder};

/// Cycles after a reset until the delay lines beside the SCPUs, and the chain behind them, hold nothing from before.
pub(super) fn cycles_to_fill(slot_latency: u32, scpus: u32) -> u32 {
    slot_latency + scpus + 1
}

/// Bits of the number of places that are free again in a cycle, of `capacity`: those of a group and of another one, or
/// all.
pub(super) fn freed_bits(spec: &Spec, capacity: u32) -> u32 {
    if spec.config.decide > 0 { capacity.ilog2() + 1 } else { spec.group_bits() + 1 }
}

/// Builds the module `contact_afu_credits`, for `capacity` results and slots of this latency.
pub(super) fn credits(spec: &Spec, capacity: u32, slot_latency: u32) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_credits");
    graph.about("lets pairs enter when there is room for their results");
    let room_bits = capacity.ilog2() + 1;
    let layout = spec.layout();
    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let scpus = graph.input("scpus", SCPU_BITS);
    let entered = graph.input("entered", spec.group_bits());
    let emerged = graph.input("emerged", spec.group_bits());
    let all_given = graph.input("all_given", 1);
    let freed = match spec.config.results {
        Results::All => graph.input("line_left", 1),
        Results::Hits => graph.input("places_freed", freed_bits(spec, capacity)),
    };

    // The content of a delay line is not reset. So what leaves counts only once the line has been filled since reset.
    let longest = slot_latency + super::MAX_SCPUS;
    let age_bits = longest.ilog2() + 1;
    let age = graph.register("cycles_since_reset", age_bits, 0);
    let filled = graph.register("filled", 1, 0);
    let last = scpus.extend(age_bits).plus(u128::from(slot_latency)).named("cycles_to_fill");
    filled.next(*filled | age.equals(last));
    age.next_if(!*filled, age.plus(1));

    let room = graph.register("room", room_bits, u128::from(capacity));
    let returned = match spec.config.results {
        Results::All => graph.constant(room_bits, u128::from(layout.contacts_per_line())).gate(freed),
        Results::Hits => freed.extend(room_bits),
    };
    let change = (returned - entered.extend(room_bits)).gate(!start).registered("room_change");
    let next_room = (room.value() + change).named("room_now");
    room.next(start.select(room.same(u128::from(capacity)), next_room));
    // True if a group may enter, whatever the size of earlier groups that are not counted yet.
    let enough = next_room.drop_low(feeder::room_to_enter(spec).ilog2()).any().named("room_for_more");
    graph.output("may_enter", (run & enough).registered("may_enter"));

    let inside = graph.register("pairs_inside", room_bits, 0);
    // What leaves is counted a cycle late, so it counts from a cycle after the lines are filled.
    let emerged = emerged.delay(1).named("emerged_now");
    let counts = filled.registered("counts_emerged");
    let next_inside = inside.value() + entered.extend(room_bits) - emerged.extend(room_bits);
    inside.next(next_inside.gate(counts));
    let is_empty = (!inside.any() & !entered.any()).named("is_empty");
    graph.output("none_inside", is_empty.registered("none_inside"));
    graph.output("all_emerged", (!start & all_given & is_empty).registered("all_emerged"));
    graph.output("filled", filled.value());
    graph.finish()
}
