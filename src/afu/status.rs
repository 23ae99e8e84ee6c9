//! Counts the pairs that leave, in their order, for the status.

use crate::hdl::{Graph, Signal};

use super::COUNT_BITS;

/// The number of pairs that left before this cycle's `group` since `start`, and a bit that is set if all `count` had
/// left one cycle ago.
pub(super) fn emerged<'g>(
    graph: &'g Graph,
    start: Signal<'g>,
    group: Signal<'g>,
    count: Signal<'g>,
) -> (Signal<'g>, Signal<'g>) {
    let emerged = graph.register("emerged", COUNT_BITS, 0);
    emerged.next(start.select(emerged.same(0), emerged.value() + group.extend(COUNT_BITS)));
    (emerged.value(), (!start & emerged.equals(count)).registered("all_seen"))
}

/// Counts contacts and invalid pairs, as the outputs `contacts`, `invalid` and `first_invalid`. `emerged` is the number
/// of the pair in lane 0. The two lists have one bit per lane.
pub(super) fn count<'g>(
    graph: &'g Graph,
    start: Signal<'g>,
    emerged: Signal<'g>,
    contacts: &[Signal<'g>],
    invalids: &[Signal<'g>],
) {
    let lanes = invalids.len() as u32;
    let contact_count = graph.register("contact_count", COUNT_BITS, 0);
    let invalid_count = graph.register("invalid_count", COUNT_BITS, 0);
    let first_invalid = graph.register("first_invalid_pair", COUNT_BITS, u128::from(u32::MAX));
    contact_count.next(start.select(contact_count.same(0), contact_count.value() + ones(graph, contacts)));
    invalid_count.next(start.select(invalid_count.same(0), invalid_count.value() + ones(graph, invalids)));
    let none_yet = graph.register("none_invalid", 1, 1);
    let mut first = emerged.plus(u128::from(lanes - 1));
    for lane in (0..lanes - 1).rev() {
        first = invalids[lane as usize].select(emerged.plus(u128::from(lane)), first);
    }
    let some = invalids.iter().fold(graph.constant(1, 0), |any, bit| any | *bit).named("some_invalid");
    none_yet.next(start | (*none_yet & !some));
    let updated = (some & *none_yet).select(first, *first_invalid);
    first_invalid.next(start.select(first_invalid.same(u128::from(u32::MAX)), updated));
    graph.output("contacts", contact_count.value());
    graph.output("invalid", invalid_count.value());
    graph.output("first_invalid", first_invalid.value());
}

/// The number of set bits, as a pair count.
fn ones<'g>(graph: &'g Graph, bits: &[Signal<'g>]) -> Signal<'g> {
    let width = bits.len().ilog2() + 1;
    let sum = bits.iter().fold(graph.constant(width, 0), |sum, bit| sum + bit.extend(width));
    sum.extend(COUNT_BITS)
}
