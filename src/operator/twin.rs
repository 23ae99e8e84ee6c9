//! What an operator must give, computed with integers alone.

use super::Operator;
use crate::number::{Format, Number, Soft};

impl Operator {
    /// The word its hardware gives for operands in `format`: what [`Soft`] computes. `b` counts only if it has two.
    ///
    /// # Panics
    /// If a word has more bits than the format.
    pub fn twin(self, format: Format, a: u128, b: u128) -> u128 {
        let x = Soft::from_bits(format, a);
        let y = if self.operands() == 2 { Soft::from_bits(format, b) } else { x };
        match self {
            Self::Add => (x + y).bits(),
            Self::Sub => (x - y).bits(),
            Self::Mul => (x * y).bits(),
            Self::Div => (x / y).bits(),
            Self::Recip => x.recip().bits(),
            Self::Sqrt => x.sqrt().bits(),
            Self::Halve => (x * x.constant(0.5)).bits(),
            Self::Greater => x.gt(y).into(),
            Self::AtMost => x.le(y).into(),
            Self::RootExceeds => x.root_exceeds(y).into(),
            Self::Convert { to } => x.to(to).bits(),
        }
    }
}
