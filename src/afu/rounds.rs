//! Turns at an interval above 1. The pairs of an SCPU are always a multiple of the interval apart, even after the
//! feeder waited.
//!
//! A phase counter runs freely through the interval. If a line has L pairs, SCPUs 0 to L − 1 take theirs in phase 0
//! only, the next L in phase 1, and so on. A group stays within such a block. With N SCPUs, an interval of II cycles
//! takes N pairs. If N is above L·II, the number of SCPUs is the largest multiple of L·II that is not above N, because
//! at most one line arrives per cycle ([`Spec::scpus_in_turn`]).

use crate::hdl::{Graph, Register, Signal};

use super::{SCPU_BITS, Spec};

/// The feeder's turns.
pub(super) struct Rounds<'g> {
    graph: &'g Graph,
    interval: u32,
    lanes: u32,
    turn: Signal<'g>,
    /// The phase in which the SCPU in turn takes a pair.
    turn_phase: Register<'g>,
    scpus: Signal<'g>,
    /// True in that phase.
    pub may_go: Signal<'g>,
}

impl<'g> Rounds<'g> {
    /// The turns of `scpus` SCPUs; `None` at an interval of 1, where every cycle is suitable.
    pub fn new(graph: &'g Graph, spec: &Spec, scpus: Signal<'g>, turn: Signal<'g>) -> Option<Self> {
        let (interval, lanes) = (spec.config.interval, spec.lanes());
        if interval <= 1 {
            return None;
        }
        let bits = u32::BITS - (interval - 1).leading_zeros();
        let phase = graph.register("phase", bits, 0);
        phase.next(following(phase.value(), interval));
        let turn_phase = graph.register("turn_phase", bits, 0);
        let may_go = phase.equals(turn_phase.value()).named("may_go");
        Some(Self { graph, interval, lanes, turn, turn_phase, scpus, may_go })
    }

    /// True if a group that begins with the present turn may have a pair on this lane.
    pub fn admits(&self, lane: u32) -> Signal<'g> {
        let reach = self.turn.extend(SCPU_BITS + 1).plus(u128::from(lane));
        let exists = reach.less_than(self.scpus.extend(SCPU_BITS + 1));
        match self.within() {
            Some(within) if lane > 0 => exists & within.at_most(within.same(u128::from(self.lanes - 1 - lane))),
            _ => exists,
        }
    }

    /// True if a group of this number of pairs is the last of its block.
    pub fn ends_block(&self, pairs: u32) -> Signal<'g> {
        match self.within() {
            None => self.graph.constant(1, u128::from(pairs > 0)),
            Some(within) => within.extend(within.width() + 2).plus(u128::from(pairs)).is(u128::from(self.lanes)),
        }
    }

    /// Advances to the phase of the next turn. `wraps` is set when turns restart with this group, `ends_block` when its
    /// block ends.
    pub fn advance(&self, start: Signal<'g>, ends_block: Signal<'g>, wraps: Signal<'g>) {
        let moved = ends_block.named("ends_block").select(following(*self.turn_phase, self.interval), *self.turn_phase);
        let first = self.graph.constant(moved.width(), 0);
        self.turn_phase.next((start | wraps).select(first, moved));
    }

    /// The place of the turn in its block; `None` if a block is a single turn.
    fn within(&self) -> Option<Signal<'g>> {
        (self.lanes > 1).then(|| self.turn.low(self.lanes.ilog2()))
    }
}

/// The phase after this one.
fn following(phase: Signal<'_>, interval: u32) -> Signal<'_> {
    let last = phase.is(u128::from(interval - 1));
    last.select(phase.same(0), phase.plus(1))
}
