//! Square root: the state is the remainder, the root so far, and the rest of the radicand.

use super::recurrence::Recurrence;
use crate::hdl::Signal;
use crate::operator::parts::Operand;
use crate::operator::{Domain, sqrt};

/// √a, as in [`sqrt::sqrt`].
pub(super) struct Root {
    pub domain: Domain,
}

impl Root {
    /// The number of bits after the first two of the radicand that may be set. A step takes two bits.
    fn rest_bits(&self) -> u32 {
        (self.domain.significand_bits() - 1).next_multiple_of(2)
    }
}

impl Recurrence for Root {
    fn domain(&self) -> Domain {
        self.domain
    }

    /// The first digit is always 1.
    fn steps(&self) -> u32 {
        sqrt::digits(self.domain) - 1
    }

    fn begin<'g>(&self, a: Signal<'g>) -> (Vec<Signal<'g>>, Vec<Signal<'g>>) {
        let radicand = sqrt::radicand(&Operand::unpack(a, self.domain, "a"));
        let width = radicand.width();
        let remainder = radicand.high(2).minus(1);
        let rest = radicand.low(width - 2).append_zeros(self.rest_bits() + 2 - width);
        (vec![remainder, rest], Vec::new())
    }

    fn fit<'g>(&self, state: &[Signal<'g>], first: u32, end: u32) -> Vec<Signal<'g>> {
        // The first digit is not passed on.
        let one = [state[0], state[0].graph().constant(1, 1), state[1]];
        let state = if first == 0 { &one } else { state };
        let mut fitted = vec![state[0].extend(end + 2), state[1].extend(end + 1)];
        let left = self.rest_bits().saturating_sub(2 * first);
        fitted.extend(state.get(2).filter(|_| left > 0).map(|rest| rest.high(left)));
        fitted
    }

    fn step<'g>(&self, state: &[Signal<'g>], _: &[Signal<'g>], index: u32) -> Vec<Signal<'g>> {
        let (remainder, root, rest) = (state[0], state[1], state.get(2).copied());
        let graph = root.graph();
        // With the root so far r and the remainder m, a digit 1 subtracts 4r + 1 from 4m + the next two bits.
        let shifted = remainder.concat(rest.map_or_else(|| graph.constant(2, 0), |rest| rest.high(2)));
        let shifted = shifted.named(&format!("shifted_{index}"));
        let trial = root.concat(graph.constant(2, 1)).extend(shifted.width());
        let difference = (shifted - trial).named(&format!("difference_{index}"));
        let negative = difference.msb().named(&format!("borrow_{index}"));
        let width = remainder.width();
        let remainder = negative.select(shifted.low(width), difference.low(width)).named(&format!("remainder_{index}"));
        let root = root.low(root.width() - 1).concat(!negative).named(&format!("root_{index}"));
        let mut state = vec![remainder, root];
        state.extend(rest.map(|rest| match rest.width() {
            2 => graph.constant(2, 0),
            width => rest.low(width - 2).append_zeros(2),
        }));
        state
    }

    fn outcome<'g>(&self, state: &[Signal<'g>]) -> Vec<Signal<'g>> {
        vec![state[1], state[0]]
    }

    fn finish<'g>(&self, a: Signal<'g>, outcome: &[Signal<'g>]) -> Signal<'g> {
        let (root, remainder) = (outcome[0], outcome[1]);
        sqrt::rounded(self.domain, Operand::unpack(a, self.domain, "a"), root, remainder.any())
    }
}
