//! A digit recurrence: a state, a step, and the logic before and after.

use crate::hdl::Signal;
use crate::operator::Domain;

/// A digit recurrence that gives a digit a step.
pub(super) trait Recurrence {
    /// The values it is made for.
    fn domain(&self) -> Domain;

    /// The number of steps.
    fn steps(&self) -> u32;

    /// From the operand: the state before the first step, and what all steps need as it is.
    fn begin<'g>(&self, a: Signal<'g>) -> (Vec<Signal<'g>>, Vec<Signal<'g>>);

    /// The state after `first` steps, as wide as it must be for the steps from there to `end`.
    fn fit<'g>(&self, state: &[Signal<'g>], first: u32, end: u32) -> Vec<Signal<'g>>;

    /// The state a step later, as wide as before. The step's number is for names.
    fn step<'g>(&self, state: &[Signal<'g>], kept: &[Signal<'g>], index: u32) -> Vec<Signal<'g>>;

    /// The part of the state that is the result after all steps.
    fn outcome<'g>(&self, state: &[Signal<'g>]) -> Vec<Signal<'g>>;

    /// The result's word, from the operand and the outcome.
    fn finish<'g>(&self, a: Signal<'g>, outcome: &[Signal<'g>]) -> Signal<'g>;
}
