//! What an operator must give, computed with integers alone; and for which operands it must.

use super::{Domain, Operator, Values};
use crate::number::{Format, Number, Soft, Subnormals, Window};

impl Operator {
    /// The word its hardware gives for operands in `format`: what [`Soft`] computes. `b` counts only if it has two, and
    /// serves for the third and fourth too.
    ///
    /// # Panics
    /// If a word has more bits than the format.
    pub fn twin(self, format: Format, a: u128, b: u128) -> u128 {
        self.twin_of(format, [a, b, b, b])
    }

    /// [`Operator::twin`] with an operand for each input; those it has not do not count.
    ///
    /// # Panics
    /// If a word that counts has more bits than the format.
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

    /// Whether hardware made for the values in `domain` gives the twin's word for these operands. `b` counts only if
    /// it has two, and serves for the third and fourth too.
    pub fn is_made_for(self, domain: Domain, a: u128, b: u128) -> bool {
        let b = if self.operands() == 1 { a } else { b };
        let format = domain.format();
        if self == Self::AddMagnitudes && [a, b].iter().any(|&word| is_negative(format, word)) {
            return false;
        }
        match domain.values() {
            Values::Any => true,
            Values::Finite => [a, b].iter().all(|&word| class(format, word) != Class::Special),
            Values::Normal => {
                let comes = |&word: &u128| matches!(class(format, word), Class::Zero | Class::Normal);
                [a, b].iter().all(comes) && self.gives_normal(format, a, b)
            }
        }
    }

    /// Whether the result for zero or normal operands is zero or, without regard to the exponent's ends, normal.
    fn gives_normal(self, format: Format, a: u128, b: u128) -> bool {
        let Ok(unbounded) = Format::new(15, format.fraction_bits(), Subnormals::Flushed)
            .and_then(|wider| wider.with_rounding(format.rounding()).with_roots(format.roots()))
        else {
            return false;
        };
        // Formats with the longest exponent cannot be looked at from a longer one: their ends are left out.
        let widen = |word: u128| Soft::from_bits(format, word).to(unbounded).bits();
        match self.result_format(format) {
            // The operand alone counts where the result is of another format, or a bit.
            Some(result) if result == format => {}
            _ => return true,
        }
        let result = self.twin(unbounded, widen(a), widen(b));
        if class(unbounded, result) == Class::Special {
            return false;
        }
        let exponent = (result >> format.fraction_bits()) as i32 & 0x7fff;
        let normal = format.min_exponent()..=format.bias();
        result & !unbounded.sign_mask() == 0 || normal.contains(&(exponent - unbounded.bias()))
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Zero,
    Subnormal,
    Normal,
    Special,
}

fn class(format: Format, word: u128) -> Class {
    let exponent = (word >> format.fraction_bits()) as u32 & format.special_exponent();
    match (exponent, word & format.fraction_mask()) {
        (0, 0) => Class::Zero,
        (0, _) => Class::Subnormal,
        (exponent, _) if exponent == format.special_exponent() => Class::Special,
        _ => Class::Normal,
    }
}

/// Below zero: −0 is not.
fn is_negative(format: Format, word: u128) -> bool {
    word & format.sign_mask() != 0 && word & !format.sign_mask() != 0
}
