//! Counts the pairs that leave, in their order, for the status.

use crate::hdl::{Graph, Signal};

use super::COUNT_BITS;

/// The results that leave the chain of slots.
pub(super) struct Leaving<'g> {
    /// The lanes on which a result leaves in the next cycle.
    pub(super) leaves: Signal<'g>,
    /// Their number.
    pub(super) group: Signal<'g>,
    /// The lanes on which a result leaves.
    here: Signal<'g>,
    graph: &'g Graph,
}

impl<'g> Leaving<'g> {
    /// The input of this kind and lane, if a result leaves on the lane.
    pub(super) fn of(&self, lane: u32, kind: &str) -> Signal<'g> {
        (self.graph.input(&format!("{kind}_{lane}"), 1) & self.here.bit(lane)).named(&format!("{kind}_here_{lane}"))
    }
}

/// The inputs `leaves` and `filled`: what leaves counts only once the delay lines have been filled since reset.
pub(super) fn results(graph: &Graph, lanes: u32) -> Leaving<'_> {
    let filled = graph.input("filled", 1).registered("filled_here");
    let leaves = graph.input("leaves", lanes).gate(filled).named("leaves_now");
    Leaving { leaves, group: number(graph, leaves), here: leaves.registered("leaves_here"), graph }
}

/// The number of lanes in use, which are the lowest.
pub(super) fn number<'g>(graph: &'g Graph, lanes: Signal<'g>) -> Signal<'g> {
    if lanes.width() == 1 {
        return lanes;
    }
    let bits = lanes.width().ilog2() + 1;
    let count = (0..lanes.width()).fold(graph.constant(bits, 0), |fewer, lane| {
        lanes.bit(lane).select(graph.constant(bits, u128::from(lane + 1)), fewer)
    });
    count.named("group")
}

/// The number of pairs that left before this cycle's `group` since `start`.
pub(super) fn emerged<'g>(graph: &'g Graph, start: Signal<'g>, group: Signal<'g>) -> Signal<'g> {
    let emerged = graph.data_register("emerged", COUNT_BITS);
    emerged.next(start.select(emerged.same(0), emerged.value() + group.extend(COUNT_BITS)));
    emerged.value()
}

/// Counts contacts and invalid pairs, as the outputs `contacts`, `invalid` and `first_invalid`. The two lists have one
/// bit per lane. `emerged_before` is the number of the pair that was in lane 0 one cycle ago.
pub(super) fn count<'g>(
    graph: &'g Graph,
    start: Signal<'g>,
    emerged_before: Signal<'g>,
    contacts: &[Signal<'g>],
    invalids: &[Signal<'g>],
) {
    let lanes = invalids.len() as u32;
    // A register of their own clears the counts, a cycle after the start or reset: long before the first result.
    let clears = graph.register("clears_counts", 1, 1);
    clears.next(start);
    let start = clears.value();
    let contact_count = graph.data_register("contact_count", COUNT_BITS);
    let invalid_count = graph.data_register("invalid_count", COUNT_BITS);
    let first_invalid = graph.data_register("first_invalid_pair", COUNT_BITS);
    for (count, bits, name) in [(contact_count, contacts, "contacts_now"), (invalid_count, invalids, "invalid_now")] {
        let now = ones(graph, bits).registered(name).extend(COUNT_BITS);
        count.next(start.select(count.same(0), count.value() + now));
    }
    // The first invalid lane is found before its number is added, so all lanes share one sum.
    let none_yet = graph.data_register("none_invalid", 1);
    let mut first = emerged_before;
    if lanes > 1 {
        let of_lane = |lane: u32| graph.constant(lanes.ilog2(), lane.into());
        let lane = (0..lanes - 1)
            .rev()
            .fold(of_lane(lanes - 1), |later, lane| invalids[lane as usize].select(of_lane(lane), later));
        first = first + lane.delay(1).named("first_invalid_lane").extend(COUNT_BITS);
    }
    let some = invalids.iter().fold(graph.constant(1, 0), |any, bit| any | *bit).registered("some_invalid");
    none_yet.next(start | (*none_yet & !some));
    let updated = (some & *none_yet).select(first, *first_invalid);
    first_invalid.next(start.select(first_invalid.same(u128::from(u32::MAX)), updated));
    graph.output("contacts", contact_count.value());
    graph.output("invalid", invalid_count.value());
    graph.output("first_invalid", first_invalid.value());
}

/// The number of set bits.
fn ones<'g>(graph: &'g Graph, bits: &[Signal<'g>]) -> Signal<'g> {
    let width = bits.len().ilog2() + 1;
    bits.iter().fold(graph.constant(width, 0), |sum, bit| sum + bit.extend(width))
}
