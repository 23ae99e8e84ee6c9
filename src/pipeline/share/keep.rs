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
    /// A ring of `interval` phases that restarts one cycle after `take`.
    pub fn new(graph: &'g Graph, interval: u32, take: Signal<'g>) -> Self {
        let registers: Vec<_> = (0..interval).map(|index| graph.register(&format!("phase_{index}"), 1, 0)).collect();
        let now: Vec<_> = registers.iter().map(|register| register.value()).collect();
        let next: Vec<_> = (0..interval as usize)
            .map(|index| match index {
                0 => (take | now[now.len() - 1]).named("phase_0_next"),
                _ => (now[index - 1] & !take).named(&format!("phase_{index}_next")),
            })
            .collect();
        registers.iter().zip(&next).for_each(|(register, next)| register.next(*next));
        Self { graph, now, next, places: HashMap::new() }
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
        for &cycle in wanted {
            while let Some(from) = this.0.last().copied().filter(|kept| kept.last < cycle) {
                this.0.push(keep(phases, &format!("{name}_kept_{}", this.0.len()), from, cycle));
            }
        }
        this
    }

    /// The form that is available in `cycle`.
    pub fn form(&self, cycle: u32) -> Option<usize> {
        self.0.iter().position(|kept| (kept.first..=kept.last).contains(&cycle))
    }

    /// The value, as it is available in `cycle`.
    pub fn at(&self, cycle: u32) -> Option<Signal<'g>> {
        Some(self.0[self.form(cycle)?].signal)
    }
}

/// The next stored form of a value, on the way to `wanted`. It is stored in the last cycle in which the form before is
/// available.
fn keep<'g>(phases: &mut Phases<'g>, name: &str, from: Kept<'g>, wanted: u32) -> Kept<'g> {
    let (graph, interval, width) = (phases.graph, phases.interval(), from.signal.width());
    let distance = wanted - from.last;
    if distance.div_ceil(interval) < LONGEST_ROW || width < NARROWEST_MEMORY {
        let register = graph.data_register(name, width);
        register.next_if(phases.at(from.last), from.signal);
        return Kept { signal: register.value(), first: from.last + 1, last: from.last + interval };
    }
    // The value is written at `place` while the next word, which is the oldest, is read. A read takes one cycle.
    let depth = 2 + (distance - 2) / interval;
    let [place, next] = phases.place(depth, from.last);
    let memory = graph.memory(&format!("{name}_words"), depth, width);
    memory.write(phases.at(from.last), place, from.signal);
    let signal = memory.read(next).named(name);
    let first = from.last + 2 + (depth - 2) * interval;
    Kept { signal, first, last: first + interval - 1 }
}
