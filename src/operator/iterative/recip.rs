//! Reciprocal: the state is the partial remainder and the digits so far, complemented; the divisor stays.

use super::recurrence::Recurrence;
use crate::hdl::Signal;
use crate::operator::div::Step;
use crate::operator::parts::{Operand, Rounding, Unrounded};
use crate::operator::{Domain, recip};

/// 1 / a, as [`recip::recip`] has it.
pub(super) struct Reciprocal {
    pub domain: Domain,
}

impl Reciprocal {
    fn to_nearest(&self) -> bool {
        self.domain.rounding() != Rounding::TowardZero
    }
}

impl Recurrence for Reciprocal {
    fn domain(&self) -> Domain {
        self.domain
    }

    /// The first two digits are known; behind the significand stands a guard bit, where anything asks for it.
    fn steps(&self) -> u32 {
        self.domain.significand_bits() - 1 + u32::from(self.to_nearest())
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
        vec![partial, zeros]
    }

    fn outcome<'g>(&self, state: &[Signal<'g>]) -> Vec<Signal<'g>> {
        vec![!state[1]]
    }

    fn finish<'g>(&self, a: Signal<'g>, outcome: &[Signal<'g>]) -> Signal<'g> {
        let domain = self.domain;
        let operand = Operand::unpack(a, domain, "a");
        let (a_exponent, divisor) = operand.normalised();
        let exponent = a_exponent.subtracted_from(2 * i64::from(domain.bias()) - 1).named("quotient_exponent");
        let graph = a.graph();
        let (digits, one, zero) = (outcome[0], graph.constant(1, 1), graph.constant(1, 0));
        let unrounded = if self.to_nearest() {
            Unrounded {
                exponent,
                significand: one.concat(digits.drop_low(1)).named("significand"),
                guard: digits.bit(0).named("guard"),
                // 1 / a ends only if a is a power of two; and that one is to be rounded up.
                sticky: one,
                doubled: None,
            }
        } else {
            // Nothing rounds 0.111…1 up: a power of two is a case of its own.
            let is_power = divisor.low(domain.fraction_bits()).is_zero().named("is_power_of_two");
            let significand = one.concat(digits.gate(!is_power)).named("significand");
            Unrounded { exponent, significand, guard: zero, sticky: zero, doubled: Some(is_power) }
        };
        recip::finish(domain, operand, unrounded)
    }
}
