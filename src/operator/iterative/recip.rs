//! Reciprocal: the state is the partial remainder and the complemented digits so far. The divisor does not change.

use super::recurrence::Recurrence;
use crate::hdl::Signal;
use crate::operator::div::Step;
use crate::operator::parts::Operand;
use crate::operator::{Domain, recip};

/// 1 / a, as in [`recip::recip`].
pub(super) struct Reciprocal {
    pub domain: Domain,
}

impl Recurrence for Reciprocal {
    fn domain(&self) -> Domain {
        self.domain
    }

    /// One digit per step.
    fn steps(&self) -> u32 {
        recip::digits(self.domain)
    }

    fn begin<'g>(&self, a: Signal<'g>) -> (Vec<Signal<'g>>, Vec<Signal<'g>>) {
        let (_, divisor) = Operand::unpack(a, self.domain, "a").normalised();
        // 2 − divisor: what the digit 1 leaves, one place further on.
        let partial = (divisor.same(0) - divisor).extend(divisor.width() + 1);
        (vec![partial], vec![divisor])
    }

    fn fit<'g>(&self, state: &[Signal<'g>], _: u32, end: u32) -> Vec<Signal<'g>> {
        let zeros = state.get(1).map_or_else(|| state[0].graph().constant(end, 0), |zeros| zeros.extend(end));
        vec![state[0], zeros]
    }

    fn step<'g>(&self, state: &[Signal<'g>], kept: &[Signal<'g>], index: u32) -> Vec<Signal<'g>> {
        let (partial, zeros) = (state[0], state[1]);
        let Step { partial, negative } = Step { partial, negative: partial.msb() }.next(kept[0], index);
        let zeros = if zeros.width() == 1 { negative } else { zeros.low(zeros.width() - 1).concat(negative) };
        let zeros = zeros.named(&format!("zeros_{index}"));
        vec![partial, zeros]
    }

    fn outcome<'g>(&self, state: &[Signal<'g>]) -> Vec<Signal<'g>> {
        vec![(!state[1]).named("digits")]
    }

    fn finish<'g>(&self, a: Signal<'g>, outcome: &[Signal<'g>]) -> Signal<'g> {
        recip::rounded(self.domain, Operand::unpack(a, self.domain, "a"), outcome[0])
    }
}
