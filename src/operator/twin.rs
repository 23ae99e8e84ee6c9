//! The correct result of an operator, computed with integers only.

use super::Operator;
use crate::number::{Format, Number, Soft, Window};

impl Operator {
    /// The word that the hardware gives for operands in `format`: the result of [`Soft`]. `b` is used only if the
    /// operator has two operands. It is then also the third and fourth operand.
    ///
    /// # Panics
    /// Panics if a word has more bits than the format.
    pub fn twin(self, format: Format, a: u128, b: u128) -> u128 {
        self.twin_of(format, [a, b, b, b])
    }

    /// As [`Operator::twin`], with an operand for each input. Operands that the operator does not have are ignored.
    ///
    /// # Panics
    /// Panics if a word that is used has more bits than the format.
    pub fn twin_of(self, format: Format, operands: [u128; 4]) -> u128 {
        let operand = |index: usize| Soft::from_bits(format, operands[index.min(self.operands() - 1)]);
        let (x, y) = (operand(0), operand(1));
        match self {
            Self::Add | Self::AddMagnitudes => (x + y).bits(),
            Self::Sub => (x - y).bits(),
            Self::AddToOdd => x.plus_to_odd(y).bits(),
            Self::SubToOdd => x.minus_to_odd(y).bits(),
            Self::WideningAdd { to } => (x.to(to) + y.to(to)).bits(),
            Self::WideningSub { to } => (x.to(to) - y.to(to)).bits(),
            Self::Mul => (x * y).bits(),
            Self::Square => (x * x).bits(),
            Self::Div => (x / y).bits(),
            Self::Recip => x.recip().bits(),
            Self::Sqrt => x.sqrt().bits(),
            Self::Halve => (x * x.constant(0.5)).bits(),
            Self::Greater => x.gt(y).into(),
            Self::AtMost => x.le(y).into(),
            Self::RootExceeds => x.root_exceeds(y).into(),
            Self::SquareExcess { to } => x.square_excess([y, operand(2), operand(3)], to).bits(),
            Self::Convert { to } => x.to(to).bits(),
        }
    }
}
