//! Turns at an interval above 1. The pairs of an SCPU are always a multiple of the interval apart, even after the
//! feeder waited.
//!
//! A phase counter runs freely through the interval. SCPUs 0 to B − 1 take their pairs in phase 0 only, the next B in
//! phase 1, and so on. A group stays within such a block. With N SCPUs, an interval of II cycles takes N pairs, and B
//! is the lowest power of two that is not below N / II. So up to II SCPUs need one lane of the chain, and synthesis
//! leaves out the others. If a line has L pairs, B is at most L: if N is above L·II, the number of SCPUs is the largest
//! multiple of L·II that is not above N, because at most one line arrives per cycle ([`Spec::scpus_in_turn`]).
//!
//! The decision which pairs go needs only the place in the block, the block's size, and whether it is the last of the
//! round. The SCPU's number is counted where pairs are already on their way.

use crate::hdl::{Graph, Register, Signal};

use super::{MAX_SCPUS, SCPU_BITS, Spec};

/// The feeder's turns.
pub(super) struct Rounds<'g> {
    lanes: u32,
    interval: u32,
    /// For each power of two below the number of lanes: blocks are larger.
    above: Vec<Signal<'g>>,
    /// The block in turn, and the phase in which it takes pairs.
    block: Register<'g>,
    phase: Register<'g>,
    /// The place in the block of the SCPU in turn.
    within: Register<'g>,
    /// True if the block is the last of the round, which may be smaller.
    is_last: Register<'g>,
    /// The size of the block in turn.
    size: Signal<'g>,
    /// The number of blocks.
    blocks: Signal<'g>,
    /// True in the block's phase.
    pub may_go: Signal<'g>,
}

impl<'g> Rounds<'g> {
    /// The turns of `scpus` SCPUs; `None` at an interval of 1, where every cycle is suitable.
    pub fn new(graph: &'g Graph, spec: &Spec, scpus: Signal<'g>) -> Option<Self> {
        let (interval, lanes) = (spec.config.interval, spec.lanes());
        if interval <= 1 {
            return None;
        }
        let bits = u32::BITS - (interval - 1).leading_zeros();
        let free = graph.register("phase", bits, 0);
        free.next(following(free.value(), interval));
        let phase = graph.register("turn_phase", bits, 0);
        let may_go = free.equals(phase.value()).named("may_go");
        let shift = lanes.ilog2();
        let size_bits = shift + 1;
        let above: Vec<_> = (0..shift).map(|power| uses_lane(spec, scpus, 1 << power)).collect();
        let by_block = |name: &str, of: &dyn Fn(u32) -> Signal<'g>| {
            let above = above.iter().zip(1..);
            above.fold(of(0), |smaller, (above, power)| above.select(of(power), smaller)).named(name)
        };
        let count_bits = SCPU_BITS + 1;
        let blocks = by_block("blocks", &|power| {
            scpus.extend(count_bits).plus((1 << power) - 1).drop_low(power).extend(count_bits)
        });
        let full = by_block("full_block", &|power| graph.constant(size_bits, 1 << power));
        let rest = by_block("behind_full_blocks", &|power| match power {
            0 => graph.constant(size_bits, 0),
            _ => scpus.low(power).extend(size_bits),
        });
        let is_last = graph.register("block_is_last", 1, 0);
        let size = (*is_last & rest.any()).select(rest, full);
        Some(Self {
            lanes,
            interval,
            above,
            block: graph.register("turn_block", SCPU_BITS, 0),
            phase,
            within: graph.register("turn_within", shift.max(1), 0),
            is_last,
            size: size.named("block_size"),
            blocks,
            may_go,
        })
    }

    /// The place in the block behind that many more pairs.
    fn behind(&self, pairs: u32) -> Signal<'g> {
        let within = if self.lanes == 1 { self.size.same(0) } else { self.within.extend(self.size.width()) };
        within.plus(pairs.into())
    }

    /// True if a group that begins with the present turn may have a pair on this lane.
    pub fn admits(&self, lane: u32) -> Signal<'g> {
        match lane.checked_ilog2() {
            None => self.size.same(1).low(1),
            // Synthesis leaves out a lane that no block reaches.
            Some(power) => self.above[power as usize] & self.behind(lane).less_than(self.size),
        }
    }

    /// True if a group of this number of pairs is the last of its block.
    pub fn ends_block(&self, pairs: u32) -> Signal<'g> {
        self.behind(pairs).equals(self.size)
    }

    /// Advances past a group, `ends_block` set if its block ends; `within` is the place in the block behind the group.
    pub fn advance(&self, start: Signal<'g>, ends_block: Signal<'g>, within: Signal<'g>) {
        let wraps = (ends_block & *self.is_last).named("round_ends");
        let restarts = (start | wraps).named("round_begins");
        let next = |register: Register<'g>, moved: Signal<'g>| {
            register.next(restarts.select(register.same(0), ends_block.select(moved, *register)));
        };
        next(self.phase, following(*self.phase, self.interval));
        next(self.block, self.block.plus(1));
        // The last block follows the last but one; a single block is always the last.
        let only = self.blocks.is(1).named("one_block");
        let before_last = self.block.extend(SCPU_BITS + 1).plus(2).equals(self.blocks).named("before_last_block");
        self.is_last.next(restarts.select(only, ends_block.select(before_last, *self.is_last)));
        self.within.next((start | ends_block).select(self.within.same(0), within));
    }

    /// The place in the block behind a group of this number of pairs, if the block does not end with it.
    pub fn within_after(&self, pairs: u32) -> Signal<'g> {
        self.behind(pairs).low(self.within.width())
    }
}

/// The phase after this one.
fn following(phase: Signal<'_>, interval: u32) -> Signal<'_> {
    let last = phase.is(u128::from(interval - 1));
    last.select(phase.same(0), phase.plus(1))
}

/// One bit: any of so many SCPUs is ever given a pair on this lane. The number is a parameter, so synthesis leaves out
/// a lane that is not used.
pub(super) fn uses_lane<'g>(spec: &Spec, scpus: Signal<'g>, lane: u32) -> Signal<'g> {
    let most_without = match lane.checked_ilog2() {
        None => return scpus.graph().constant(1, 1),
        Some(power) if spec.config.interval > 1 => (spec.config.interval << power).min(MAX_SCPUS),
        Some(_) => lane,
    };
    scpus.greater_than(scpus.same(most_without.into())).named(&format!("uses_lane_{lane}"))
}
