//! Counters whose next value is known without waiting for a sum. One counts down, with flags about its value. The other
//! counts up and down, with the slots that it counts.

use crate::hdl::{Graph, Register, Signal};

/// A counter that counts down in steps of one.
pub(super) struct Countdown<'g> {
    left: Register<'g>,
    /// True if anything is left.
    pub(super) any: Signal<'g>,
    /// True if exactly one is left.
    pub(super) one: Signal<'g>,
    flags: [Register<'g>; 2],
}

impl<'g> Countdown<'g> {
    /// A counter of this number of bits, which is zero after reset.
    pub(super) fn new(graph: &'g Graph, name: &str, width: u32) -> Self {
        let flags = ["any", "one"].map(|flag| graph.register(&format!("{flag}_{name}"), 1, 0));
        let [any, one] = flags.map(Register::value);
        Self { left: graph.register(name, width, 0), any, one, flags }
    }

    /// Starts from `from` at `start`, and counts down at `step`, which is set only while something is left. Returns
    /// whether anything will be left.
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

/// Connects a counter that is 0 at `start`, goes up on one event and down on another. The second event arrives last.
pub(super) fn up_down<'g>(count: Register<'g>, start: Signal<'g>, up: Signal<'g>, down: Signal<'g>) {
    let moved = up.select(count.plus(1), count.minus(1));
    count.next_if(start | (up ^ down), start.select(count.same(0), moved));
}

/// True if all of a power of two slots are used after a cycle in which `reserved` are used at the beginning.
pub(super) fn all_used<'g>(reserved: Register<'g>, takes: Signal<'g>, frees: Signal<'g>) -> Signal<'g> {
    let slots = reserved.width() - 1;
    !frees & (reserved.msb() | (reserved.low(slots).all() & takes))
}

/// A counter like that of [`up_down`] for up to `2^(width − 1)` things, with a flag that is set while it is not 0. It
/// goes down only while the flag is set.
pub(super) fn waiting<'g>(
    graph: &'g Graph,
    name: &str,
    width: u32,
    start: Signal<'g>,
    up: Signal<'g>,
) -> (Signal<'g>, impl FnOnce(Signal<'g>) + use<'g>) {
    let count = graph.register(name, width, 0);
    let some = graph.register(&format!("any_{name}"), 1, 0);
    let connect = move |down: Signal<'g>| {
        up_down(count, start, up, down);
        let more = count.drop_low(1).any();
        some.next(!start & (up | more | (count.bit(0) & !down)));
    };
    (some.value(), connect)
}
