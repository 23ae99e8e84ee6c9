//! Counters whose next value is known without waiting for a sum. A step that decides much is counted one cycle late,
//! and flags about the counter's value know it at once.

use crate::hdl::{Graph, Register, Signal};

/// A counter that counts down in steps of one, each one cycle late.
pub(super) struct Countdown<'g> {
    name: String,
    left: Register<'g>,
    /// True if anything is left.
    pub(super) any: Signal<'g>,
    /// True if exactly one is left.
    pub(super) one: Signal<'g>,
    flags: [Register<'g>; 2],
    /// True if there were so many a cycle ago that more than three are left whatever was counted since: counted down,
    /// or as many as they were at the start.
    many: [Register<'g>; 2],
    has_many: Signal<'g>,
    counts: Register<'g>,
    /// True in the cycle in which a step is counted.
    pub(super) counted: Signal<'g>,
}

impl<'g> Countdown<'g> {
    /// A counter of this number of bits, which is zero after reset.
    pub(super) fn new(graph: &'g Graph, name: &str, width: u32) -> Self {
        let flags = ["any", "one"].map(|flag| graph.register(&format!("{flag}_{name}"), 1, 0));
        let [any, one] = flags.map(Register::value);
        let counts = graph.register(&format!("{name}_step"), 1, 0);
        let many = ["many", "started_with_many"].map(|flag| graph.register(&format!("{flag}_{name}"), 1, 0));
        let has_many = (*many[0] | *many[1]).named(&format!("has_many_{name}"));
        let left = graph.register(name, width, 0);
        Self { name: name.to_owned(), left, any, one, flags, many, has_many, counts, counted: *counts }
    }

    /// Starts from `from` at `start`, and counts down at `step`, which is set only while something is left. Returns
    /// whether anything will be left.
    pub(super) fn connect(self, start: Signal<'g>, from: Signal<'g>, step: Signal<'g>) -> AtStep<'g> {
        let (left, counted, many) = (self.left, self.counted, self.has_many);
        self.counts.next(step & !start);
        left.next_if(start | counted, start.select(from, left.minus(1)));
        // From eight on, three bits that are two steps late say nothing, and `many` says it.
        self.many[0].next(!start & left.drop_low(3).any());
        self.many[1].next(start & from.drop_low(3).any());
        let few = left.low(3);
        let name = |of: &str| format!("{of}_{}", self.name);
        // Whether any is left follows from both flags, without the count, but for the cycle after the start.
        let started = start.registered(&name("started"));
        let begins = (self.many[1].value() | (started & few.any())).named(&name("begins"));
        let next_any = AtStep { with: self.any & !self.one, without: self.any | begins }.named(&name("any"));
        let next_one = by_steps(counted, &name("one"), |steps| !many & few.is(u128::from(steps + 1)));
        // The flags know the new count a cycle after it is there.
        self.flags[0].next(!start & next_any.at(step));
        self.flags[1].next(!start & next_one.at(step));
        next_any
    }
}

/// What will be true with a step in this cycle, and without one. Whether there is a step is known last, so both are
/// computed before.
#[derive(Clone, Copy)]
pub(super) struct AtStep<'g> {
    with: Signal<'g>,
    without: Signal<'g>,
}

impl<'g> AtStep<'g> {
    /// The one of both that `step` chooses.
    pub(super) fn at(self, step: Signal<'g>) -> Signal<'g> {
        step.select(self.with, self.without)
    }

    fn named(self, name: &str) -> Self {
        let Self { with, without } = self;
        let named = |signal: Signal<'g>, when: &str| signal.named(&format!("{name}_{when}_step"));
        Self { with: named(with, "after"), without: named(without, "without") }
    }

    /// True if both are true.
    pub(super) fn and(self, other: Self) -> Self {
        Self { with: self.with & other.with, without: self.without & other.without }
    }
}

/// `of` the number of steps that are not counted yet; the signals are named after it.
fn by_steps<'g>(counted: Signal<'g>, name: &str, of: impl Fn(u32) -> Signal<'g>) -> AtStep<'g> {
    let [none, one, two] = [0, 1, 2].map(|steps| of(steps).named(&format!("{name}_after_{steps}")));
    AtStep { with: counted.select(two, one), without: counted.select(one, none) }
}

/// Connects a counter that is 0 at `start`, and takes `next` where it `moves`. `start` resets it and delays nothing, so
/// one that means nothing before a job needs no reset.
pub(super) fn from_zero<'g>(count: Register<'g>, start: Signal<'g>, moves: Signal<'g>, next: Signal<'g>) {
    count.next(start.select(count.same(0), moves.select(next, *count)));
}

/// Connects a counter that is 0 at `start`, goes up on one event and down on another. The second event arrives last.
pub(super) fn up_down<'g>(count: Register<'g>, start: Signal<'g>, up: Signal<'g>, down: Signal<'g>) {
    let moved = up.select(count.plus(1), count.minus(1));
    from_zero(count, start, up ^ down, moved);
}

/// A counter of things that come and go, which knows whether there are any without a look at the count.
#[derive(Clone, Copy)]
pub(super) struct Outstanding<'g> {
    /// Their number.
    pub(super) count: Register<'g>,
    any: Register<'g>,
}

impl<'g> Outstanding<'g> {
    /// A counter of this number of bits, which is zero after reset.
    pub(super) fn new(graph: &'g Graph, name: &str, width: u32) -> Self {
        Self { count: graph.register(name, width, 0), any: graph.register(&format!("any_{name}"), 1, 0) }
    }

    /// One bit: there are some.
    pub(super) fn any(self) -> Signal<'g> {
        self.any.value()
    }

    /// One bit: there are fewer than `2^(width − 1)`, after a cycle in which one comes, or goes.
    pub(super) fn has_room_after(self, comes: Signal<'g>, goes: Signal<'g>) -> Signal<'g> {
        some_free(self.count, goes).at(comes)
    }

    /// One comes, or goes, which it does only while there are some.
    pub(super) fn connect(self, comes: Signal<'g>, goes: Signal<'g>) {
        let Self { count, any } = self;
        any.next(comes | (*any & !(goes & count.is(1))));
        up_down(count, comes.same(0), comes, goes);
    }
}

/// True if one of a power of two slots is free after a cycle that may take one, with `reserved` in use before it.
pub(super) fn some_free<'g>(reserved: Register<'g>, frees: Signal<'g>) -> AtStep<'g> {
    let slots = reserved.width() - 1;
    let without = (frees | !reserved.msb()).named("some_free_now");
    AtStep { with: without & (frees | !reserved.low(slots).all()), without }
}

/// The number of things that come and go, one at a time. One that goes is counted a cycle late; whether there are any,
/// and whether there is exactly one, is known at once.
pub(super) struct Level<'g> {
    name: String,
    first: u128,
    /// Their number, with the one that went in the last cycle.
    pub(super) count: Register<'g>,
    /// True if there are any.
    pub(super) any: Register<'g>,
    one: Register<'g>,
    /// True in the cycle in which one that went is counted.
    pub(super) counted: Register<'g>,
    /// True if a cycle ago there were so many that there are neither two nor three now.
    many: Option<Register<'g>>,
}

impl<'g> Level<'g> {
    /// A level of this number of bits, `first` after a reset and at the start: less than eight, or a multiple of it.
    pub(super) fn new(graph: &'g Graph, name: &str, width: u32, first: u128) -> Self {
        let flag = |of: &str, set: bool| graph.register(&format!("{of}_{name}"), 1, set.into());
        Self {
            first,
            count: graph.register(name, width, first),
            any: flag("any", first > 0),
            one: flag("one", first == 1),
            counted: graph.register(&format!("{name}_step"), 1, 0),
            many: (width > 3).then(|| flag("many", false)),
            name: name.to_owned(),
        }
    }

    /// One comes, or goes, which it does only while there are some, or in the cycle in which it comes. Returns whether
    /// there will be any.
    pub(super) fn connect(&self, start: Signal<'g>, comes: Signal<'g>, goes: Signal<'g>) -> AtStep<'g> {
        let Self { count, any, one, counted, many, .. } = *self;
        counted.next(goes & !start);
        let moved = comes.select(count.plus(1), count.minus(1));
        count.next(start.select(count.same(self.first), (comes ^ *counted).select(moved, *count)));
        let low = count.low(3.min(count.width()));
        let mut two = counted.select(low.is(3), low.is(2));
        if let Some(many) = many {
            many.next(!start & count.drop_low(3).any());
            two = two & !*many;
        }
        let next_any = AtStep { with: *any & (comes | !*one), without: *any | comes };
        let next_any = next_any.named(&format!("any_{}", self.name));
        let two = two.named(&format!("two_{}", self.name));
        let next_one = AtStep { with: comes.select(*one, two), without: comes.select(!*any, *one) };
        let at_start = |flag: bool, next: Signal<'g>| if flag { start | next } else { !start & next };
        any.next(at_start(self.first > 0, next_any.at(goes)));
        one.next(at_start(self.first == 1, next_one.at(goes)));
        next_any
    }
}

/// The place of the oldest word in a memory of a power of two of words, which `moves` on. Returns the place in the next
/// cycle, to read the memory from. The place behind it is kept too, so that no sum stands before the memory.
pub(super) fn oldest_place<'g>(graph: &'g Graph, name: &str, width: u32, moves: Signal<'g>) -> Signal<'g> {
    let place = graph.register(name, width, 0);
    let behind = graph.register(&format!("behind_{name}"), width, 1);
    behind.next_if(moves, behind.plus(1));
    let next = moves.select(*behind, *place).named(&format!("next_{name}"));
    place.next(next);
    next
}

/// A count of the cycles in which `counts` is set, from `first` at `restart`, where `counts` is set too. Its upper half
/// counts when the lower half is about to wrap, which is known a cycle ahead, so no carry passes the whole width.
pub(super) fn cycles<'g>(
    graph: &'g Graph,
    name: &str,
    width: u32,
    [restart, counts]: [Signal<'g>; 2],
    first: u32,
) -> Signal<'g> {
    let half = width / 2;
    let low = graph.register(&format!("{name}_low"), half, 0);
    let high = graph.register(&format!("{name}_high"), width - half, 0);
    let is_full = graph.register(&format!("{name}_low_is_full"), 1, 0);
    low.next_if(counts, restart.select(low.same(first.into()), low.plus(1)));
    let last_but_one = low.drop_low(1).all() & !low.bit(0);
    is_full.next_if(counts, !restart & last_but_one);
    high.next_if(counts & (restart | *is_full), restart.select(high.same(0), high.plus(1)));
    high.concat(low.value()).named(name)
}

/// A pulse, `cycles` cycles later, zero after reset; `start` forgets those on their way.
pub(super) fn later<'g>(start: Signal<'g>, pulse: Signal<'g>, cycles: u32, name: &str) -> Signal<'g> {
    if cycles == 0 {
        return pulse;
    }
    let graph = pulse.graph();
    let way = graph.register(name, cycles, 0);
    let next = if cycles == 1 { pulse } else { way.low(cycles - 1).concat(pulse) };
    way.next(next.gate(!start));
    way.msb()
}
