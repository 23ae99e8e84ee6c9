//! An instance's operand: one of several signals, selected by the phase, and registered.

use std::collections::HashMap;

use super::keep::Phases;
use crate::hdl::{Graph, Signal};

/// Builds selections, and the select signals that they share.
pub(super) struct Chooser<'g> {
    graph: &'g Graph,
    selections: HashMap<Vec<Option<usize>>, Signal<'g>>,
}

impl<'g> Chooser<'g> {
    pub fn new(graph: &'g Graph) -> Self {
        Self { graph, selections: HashMap::new() }
    }

    /// In each phase, the signal whose index in `signals` is in `by_phase`. In other phases, any signal.
    pub fn choose(
        &mut self,
        phases: &Phases<'g>,
        name: &str,
        by_phase: &[Option<usize>],
        signals: &[Signal<'g>],
    ) -> Option<Signal<'g>> {
        if let [only] = signals {
            return Some(*only);
        }
        let bits = usize::BITS - (signals.len() - 1).leading_zeros();
        let graph = self.graph;
        let selection = *self.selections.entry(by_phase.to_vec()).or_insert_with(|| {
            let next: Vec<_> = (0..bits).rev().map(|bit| wanted(graph, phases, by_phase, bit)).collect();
            let selection = graph.register(&format!("{name}_choice"), bits, 0);
            selection.next(Signal::join(&next));
            selection.value()
        });
        tree(selection, signals)
    }
}

/// True if the selection in the next cycle has this bit set.
fn wanted<'g>(graph: &'g Graph, phases: &Phases<'g>, by_phase: &[Option<usize>], bit: u32) -> Signal<'g> {
    let has = |index: &Option<usize>| index.is_some_and(|index| index >> bit & 1 == 1);
    let of = by_phase.iter().zip(&phases.next).filter(|(index, _)| has(index)).map(|(_, next)| *next);
    of.reduce(|all, one| all | one).unwrap_or_else(|| graph.constant(1, 0))
}

fn tree<'g>(selection: Signal<'g>, signals: &[Signal<'g>]) -> Option<Signal<'g>> {
    let [first, ..] = signals else { return None };
    if signals.len() == 1 {
        return Some(*first);
    }
    let bits = usize::BITS - (signals.len() - 1).leading_zeros();
    let (low, high) = signals.split_at(1 << (bits - 1));
    Some(selection.bit(bits - 1).select(tree(selection, high)?, tree(selection, low)?))
}
