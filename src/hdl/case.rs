//! A choice among several values by a number: a case statement.

use std::panic::Location;

use super::module::Op;
use super::signal::Signal;

impl<'g> Signal<'g> {
    /// The value whose place is this number, or the last one for all numbers above. Each value has a note that says
    /// what it is for, or an empty text. As the next value of a register, it is a case statement in Verilog.
    #[track_caller]
    pub(crate) fn case(self, values: &[(Signal<'g>, String)]) -> Self {
        let (graph, place) = (self.graph(), Location::caller());
        let signals: Vec<_> = values.iter().map(|(value, _)| *value).collect();
        let Some(mut ids) = graph.own("case", &signals, place) else { return Self::poison(graph) };
        let Some(selection) = graph.own("case", &[self], place) else { return Self::poison(graph) };
        let widths: Vec<_> = signals.iter().map(|value| value.width()).collect();
        let Some(&width) = widths.first().filter(|first| widths.iter().all(|width| width == *first)) else {
            graph.error(format!("case: values of {widths:?} bits"), place);
            return Self::poison(graph);
        };
        if let [only] = signals[..] {
            return only;
        }
        if self.width() < 32 && signals.len() > 1 << self.width() {
            graph.error(format!("case: {} values by a number of {} bits", signals.len(), self.width()), place);
            return Self::poison(graph);
        }
        ids.insert(0, selection[0]);
        let notes = values.iter().map(|(_, note)| note.clone()).collect();
        graph.shared(Op::Case { notes }, width, ids, place)
    }
}
