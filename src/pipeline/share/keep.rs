//! Values that wait: each is stored once per interval, in a row of registers or in a memory.

use std::collections::{BTreeSet, HashMap};

use crate::hdl::{Graph, Signal};

/// The longest row of registers. Beyond it, a memory is smaller.
const LONGEST_ROW: u32 = 6;
/// Narrower values always wait in registers.
const NARROWEST_MEMORY: u32 = 12;

/// The phases of the present pair.
pub(super) struct Phases<'g> {
    graph: &'g Graph,
    /// One bit per phase: set in the cycles of that phase, from the first pair on.
    pub now: Vec<Signal<'g>>,
    /// The same, one cycle early.
    pub next: Vec<Signal<'g>>,
    /// Places in memories, by depth and by the phase in which they advance: the present one, and the next one.
    places: HashMap<(u32, u32), [Signal<'g>; 2]>,
}

impl<'g> Phases<'g> {
    /// A ring of `interval` phases that begins one cycle after the first `take`. Later ones come a whole number of
    /// intervals after it, when the ring is there by itself. So `take` decides nothing but the first phase, and what
    /// selects operands in the others does not wait for it.
    pub fn new(graph: &'g Graph, interval: u32, take: Signal<'g>) -> Self {
        let phase = graph.register("phase", interval, 0);
        let next = phase.low(interval - 1).concat(phase.msb() | take).named("phase_next");
        phase.next(next);
        let bits = |of: Signal<'g>| (0..interval).map(|index| of.bit(index)).collect();
        Self { graph, now: bits(phase.value()), next: bits(next), places: HashMap::new() }
    }

    fn interval(&self) -> u32 {
        self.now.len() as u32
    }

    /// Bit k is set k cycles after this cycle of a pair.
    pub fn since(&self, cycle: u32) -> Signal<'g> {
        let bits: Vec<_> = (0..self.interval()).rev().map(|later| self.at(cycle + later)).collect();
        Signal::join(&bits)
    }

    /// Set in this cycle of a pair.
    fn at(&self, cycle: u32) -> Signal<'g> {
        self.now[(cycle % self.interval()) as usize]
    }

    fn place(&mut self, depth: u32, cycle: u32) -> [Signal<'g>; 2] {
        let phase = cycle % self.interval();
        let (graph, moves) = (self.graph, self.at(cycle));
        *self.places.entry((depth, phase)).or_insert_with(|| {
            let bits = u32::BITS - (depth - 1).leading_zeros();
            let place = graph.register(&format!("place_of_{depth}_in_phase_{phase}"), bits, 0);
            let last = place.is(u128::from(depth - 1));
            let next = last.select(place.same(0), place.plus(1));
            let next = next.named(&format!("place_of_{depth}_in_phase_{phase}_next"));
            place.next_if(moves, next);
            [place.value(), next]
        })
    }
}

/// A stored form of a value, and the cycles in which it is available.
#[derive(Clone, Copy)]
struct Kept<'g> {
    signal: Signal<'g>,
    first: u32,
    last: u32,
}

/// A value from its first cycle on, in all its stored forms.
#[derive(Clone)]
pub(super) struct Keeper<'g>(Vec<Kept<'g>>);

impl<'g> Keeper<'g> {
    /// A value that is available without storage from cycle `ready` for `stays` ≥ 1 cycles, and is also `wanted` in
    /// other cycles.
    pub fn new(
        phases: &mut Phases<'g>,
        name: &str,
        signal: Signal<'g>,
        [ready, stays]: [u32; 2],
        wanted: &BTreeSet<u32>,
    ) -> Self {
        let mut this = Self(vec![Kept { signal, first: ready, last: ready + stays - 1 }]);
        let steps = steps(phases.interval(), signal.width(), ready + stays - 1, wanted);
        for (index, row) in steps.chunk_by(|one, next| [one, next] == [&Step::Register; 2]).enumerate() {
            let Some(from) = this.0.last().copied() else { break };
            let name = if index == 0 { format!("{name}_kept") } else { format!("{name}_kept_{}", index + 1) };
            match row[0] {
                Step::Register => this.0.extend(registers(phases, &name, from, row.len() as u32)),
                Step::Memory { depth } => this.0.push(memory(phases, &name, from, depth)),
            }
        }
        this
    }

    /// The form that is available in `cycle`.
    fn form(&self, cycle: u32) -> Option<usize> {
        self.0.iter().position(|kept| (kept.first..=kept.last).contains(&cycle))
    }

    /// The value, as it is available in `cycle`.
    pub fn at(&self, cycle: u32) -> Option<Signal<'g>> {
        Some(self.0[self.form(cycle)?].signal)
    }
}

/// One stored form of a value, made of the one before. It is stored in the last cycle in which that is available.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// A register, which keeps it for another interval.
    Register,
    /// A memory.
    Memory { depth: u32 },
}

/// The steps by which a value that is there until cycle `last` reaches the `wanted` cycles.
fn steps(interval: u32, width: u32, mut last: u32, wanted: &BTreeSet<u32>) -> Vec<Step> {
    let mut steps = Vec::new();
    for &cycle in wanted {
        while last < cycle {
            let distance = cycle - last;
            if distance.div_ceil(interval) < LONGEST_ROW || width < NARROWEST_MEMORY {
                steps.push(Step::Register);
                last += interval;
            } else {
                let depth = 2 + (distance - 2) / interval;
                steps.push(Step::Memory { depth });
                last += 1 + (depth - 1) * interval;
            }
        }
    }
    steps
}

/// A shift register of this many words, which moves once per interval, and its words from the newest on.
fn registers<'g>(phases: &Phases<'g>, name: &str, from: Kept<'g>, words: u32) -> Vec<Kept<'g>> {
    let (interval, width) = (phases.interval(), from.signal.width());
    let row = phases.graph.data_register(name, words * width);
    let shifted = if words == 1 { from.signal } else { row.low((words - 1) * width).concat(from.signal) };
    row.next_if(phases.at(from.last), shifted);
    let word = |word: u32| {
        let first = from.last + 1 + word * interval;
        Kept { signal: row.slice(word * width, width), first, last: first + interval - 1 }
    };
    (0..words).map(word).collect()
}

/// The value is written at `place` while the next word, which is the oldest, is read. A read takes one cycle.
fn memory<'g>(phases: &mut Phases<'g>, name: &str, from: Kept<'g>, depth: u32) -> Kept<'g> {
    let interval = phases.interval();
    let [place, next] = phases.place(depth, from.last);
    let memory = phases.graph.memory(&format!("{name}_words"), depth, from.signal.width());
    memory.write(phases.at(from.last), place, from.signal);
    let signal = memory.read(next).named(name);
    let first = from.last + 2 + (depth - 2) * interval;
    Kept { signal, first, last: first + interval - 1 }
}
