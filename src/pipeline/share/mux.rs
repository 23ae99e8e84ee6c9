//! An instance's operand: one of several signals, selected by the phase, and registered.

use std::collections::HashMap;

use super::keep::Phases;
use crate::hdl::{Graph, Signal};

/// Numbers of one digit in the name of a selection. A longer or wider one has a number of its own.
const DIGITS: &[u8] = b"0123456789abcdefghijklmnopqrstuvw";
const MOST_DIGITS: usize = 24;

/// Builds selections, and the select signals that they share.
pub(super) struct Chooser<'g> {
    graph: &'g Graph,
    selections: HashMap<Vec<Option<usize>>, Signal<'g>>,
}

impl<'g> Chooser<'g> {
    pub fn new(graph: &'g Graph) -> Self {
        Self { graph, selections: HashMap::new() }
    }

    /// In each phase, the signal whose index in `signals` is in `by_phase`. In other phases, any signal. Each has a
    /// note that says what it is for.
    pub fn choose(
        &mut self,
        phases: &Phases<'g>,
        by_phase: &[Option<usize>],
        signals: &[(Signal<'g>, String)],
    ) -> Option<Signal<'g>> {
        if let [(only, _)] = signals {
            return Some(*only);
        }
        let bits = usize::BITS - signals.len().checked_sub(1)?.leading_zeros();
        let (graph, number) = (self.graph, self.selections.len());
        let selection = *self.selections.entry(by_phase.to_vec()).or_insert_with(|| {
            let next: Vec<_> = (0..bits).rev().map(|bit| wanted(graph, phases, by_phase, bit)).collect();
            let selection = graph.register(&name(by_phase, number), bits, 0);
            selection.next(Signal::join(&next));
            selection.value()
        });
        Some(selection.case(signals))
    }
}

/// Digit k of the name is the number in phase k, or x for any.
fn name(by_phase: &[Option<usize>], number: usize) -> String {
    let digit = |index: &Option<usize>| match index {
        None => Some('x'),
        Some(index) => DIGITS.get(*index).map(|digit| char::from(*digit)),
    };
    let digits: Option<String> = by_phase.iter().map(digit).collect();
    match digits.filter(|digits| digits.len() <= MOST_DIGITS) {
        Some(digits) => format!("operand_{digits}"),
        None => format!("operand_choice_{number}"),
    }
}

/// True if the selection in the next cycle has this bit set.
fn wanted<'g>(graph: &'g Graph, phases: &Phases<'g>, by_phase: &[Option<usize>], bit: u32) -> Signal<'g> {
    let has = |index: &Option<usize>| index.is_some_and(|index| index >> bit & 1 == 1);
    let of = by_phase.iter().zip(&phases.next).filter(|(index, _)| has(index)).map(|(_, next)| *next);
    of.reduce(|all, one| all | one).unwrap_or_else(|| graph.constant(1, 0))
}
