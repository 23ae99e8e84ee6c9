//! Responses arrive in any order, and their requests leave in order. This file marks answered requests, the oldest
//! first.

use crate::hdl::{Graph, Signal};

/// Cycles from a response to its slot that goes, if it is the oldest: [`awaited`](super::awaited) registers its
/// arrival, and it is marked.
pub(super) const CYCLES_TO_GO: u32 = super::awaited::CYCLES_TO_ANSWER + 2;

/// A register of this name, true if the oldest of `slots` (a power of two) slots was answered and left. Slots are used
/// in turn, from 0 at `start`, and are reused only after they left. Marks of an earlier job go when it
/// [`clears`](super::awaited::clears).
///
/// `answered` is set when the response to an outstanding request has been [recognised](super::awaited). `slot` is the
/// response's slot in the cycle of its arrival. The marks are ordered by age and move up when the oldest leaves, so no
/// search for the oldest is needed.
pub(super) fn goes_in_order<'g>(
    graph: &'g Graph,
    name: &str,
    slots: u32,
    [start, clears]: [Signal<'g>; 2],
    slot: Signal<'g>,
    answered: Signal<'g>,
) -> Signal<'g> {
    let oldest = graph.register("oldest", slot.width(), 0);
    let came = graph.data_register("came", slots);
    let goes = (came.bit(0) & !clears).named("oldest_goes");
    oldest.next(start.select(oldest.same(0), oldest.value() + goes.extend(oldest.width())));

    // The age of an arrival is computed first, and marked one cycle later. That the oldest leaves meanwhile is the
    // borrow of one difference: with one more bit below, 2·slot − (2·oldest + goes).
    let age = graph.data_register("arrived_age", slot.width());
    let slot = slot.delay(super::awaited::CYCLES_TO_ANSWER - 1).named("slot_then");
    let twice_the_age = (slot.concat(graph.constant(1, 0)) - oldest.concat(goes)).named("twice_the_age");
    age.next(twice_the_age.drop_low(1));
    let marked = (*came | age.one_hot().gate(answered)).named("marked");
    let moved = marked.drop_low(1).extend(slots);
    came.next(goes.select(moved, marked).gate(!clears));
    (goes & !start).registered(name)
}
