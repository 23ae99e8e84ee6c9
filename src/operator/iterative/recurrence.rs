//! A digit recurrence: a state, a step, and the logic before and after the steps.

use crate::hdl::Signal;
use crate::operator::Domain;

/// A digit recurrence with one digit per step.
pub(super) trait Recurrence {
    /// The values that it is made for.
    fn domain(&self) -> Domain;

    /// The number of steps.
    fn steps(&self) -> u32;

    /// Computes, from the operand, the state before the first step and the values that all steps use unchanged.
    fn begin<'g>(&self, a: Signal<'g>) -> (Vec<Signal<'g>>, Vec<Signal<'g>>);

    /// The state after `first` steps, as wide as the steps from there to `end` need.
    fn fit<'g>(&self, state: &[Signal<'g>], first: u32, end: u32) -> Vec<Signal<'g>>;

    /// The state one step later, as wide as before. The step's number is for names.
    fn step<'g>(&self, state: &[Signal<'g>], kept: &[Signal<'g>], index: u32) -> Vec<Signal<'g>>;

    /// The part of the state that is the result after all steps.
    fn outcome<'g>(&self, state: &[Signal<'g>]) -> Vec<Signal<'g>>;

    /// The result's word, from the operand and the outcome.
    fn finish<'g>(&self, a: Signal<'g>, outcome: &[Signal<'g>]) -> Signal<'g>;
}
