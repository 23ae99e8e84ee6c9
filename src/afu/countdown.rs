//! A counter that goes down one at a time, and flags of what it has come to that do not wait for its subtraction.

use crate::hdl::{Graph, Register, Signal};

/// The counter under construction.
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

    /// Begins with `from` at `start`; goes down at `step`, which is set only while something is left. Gives whether anything
    /// will be left.
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
