//! Counters that say what they come to without waiting for the sum: one that goes down, with flags of what it has come
//! to, and one that goes up and down, with the slots it counts.

use crate::hdl::{Graph, Register, Signal};

/// A counter that goes down one at a time.
pub(super) struct Countdown<'g> {
    left: Register<'g>,
    /// Whether anything is left.
    pub(super) any: Signal<'g>,
    /// Whether one is left.
    pub(super) one: Signal<'g>,
    flags: [Register<'g>; 2],
}

impl<'g> Countdown<'g> {
    /// A counter of that many bits: nothing is left after reset.
    pub(super) fn new(graph: &'g Graph, name: &str, width: u32) -> Self {
        let flags = ["any", "one"].map(|flag| graph.register(&format!("{flag}_{name}"), 1, 0));
        let [any, one] = flags.map(Register::value);
        Self { left: graph.register(name, width, 0), any, one, flags }
    }

    /// Begins with `from` at `start`; goes down at `step`, which is set only while something is left. Gives whether
    /// anything will be left.
    pub(super) fn connect(self, start: Signal<'g>, from: Signal<'g>, step: Signal<'g>) -> Signal<'g> {
        let left = self.left;
        left.next_if(start | step, start.select(from, left.minus(1)));
        let above = |value: Signal<'g>| value.drop_low(1).any();
        let is_two = !left.drop_low(2).any() & left.bit(1) & !left.bit(0);
        let next_any = step.select(above(*left), left.any());
        let next_one = step.select(is_two, left.bit(0) & !above(*left));
        self.flags[0].next(start.select(from.any(), next_any));
        self.flags[1].next(start.select(from.bit(0) & !above(from), next_one));
        next_any
    }
}

/// Connects a counter, from 0 at `start`, that one event takes up and another down: which comes last.
pub(super) fn up_down<'g>(count: Register<'g>, start: Signal<'g>, up: Signal<'g>, down: Signal<'g>) {
    let moved = up.select(count.plus(1), count.minus(1));
    count.next_if(start | (up ^ down), start.select(count.same(0), moved));
}

/// Whether all of a power of two slots are used after a cycle, of which `reserved` are at its beginning.
pub(super) fn all_used<'g>(reserved: Register<'g>, takes: Signal<'g>, frees: Signal<'g>) -> Signal<'g> {
    let slots = reserved.width() - 1;
    !frees & (reserved.msb() | (reserved.low(slots).all() & takes))
}
