//! Turns at an interval above 1. The pairs of an SCPU are always a multiple of the interval apart, even after the
//! feeder waited.
//!
//! A phase counter runs freely through the interval. If a line has L pairs, SCPUs 0 to L − 1 take theirs in phase 0
//! only, the next L in phase 1, and so on. A group stays within such a block. With N SCPUs, an interval of II cycles
//! takes N pairs. If N is above L·II, the number of SCPUs is the largest multiple of L·II that is not above N, because
//! at most one line arrives per cycle ([`Spec::scpus_in_turn`]).
//!
//! The decision which pairs go needs only the place in the block, the block's size, and whether it is the last of the
//! round. The SCPU's number is counted where pairs are already on their way.

use crate::hdl::{Graph, Register, Signal};

use super::{SCPU_BITS, Spec};

/// The feeder's turns.
pub(super) struct Rounds<'g> {
    lanes: u32,
    interval: u32,
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
        let round_up = scpus.extend(SCPU_BITS + 1).plus(u128::from(lanes - 1)).drop_low(shift);
        let blocks = round_up.extend(SCPU_BITS + 1).named("blocks");
        let size_bits = shift + 1;
        let all = graph.constant(size_bits, lanes.into());
        let is_last = graph.register("block_is_last", 1, 0);
        let size = if shift == 0 {
            all
        } else {
            let rest = scpus.low(shift).extend(size_bits);
            (*is_last & rest.any()).select(rest, all)
        };
        Some(Self {
            lanes,
            interval,
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
        if lane == 0 { self.size.same(1).low(1) } else { self.behind(lane).less_than(self.size) }
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
