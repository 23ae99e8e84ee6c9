//! The operands for which hardware must give its twin's word. Hardware for certain values may differ for others.

use contact_afu::number::{Format, Number, Soft, Subnormals};
use contact_afu::operator::{Domain, Operator, Values};

/// True if hardware made for the values in `domain` must give the twin's word for these operands. `b` is used only if
/// there are two or more operands; it is then also the third and fourth.
pub fn is_made_for(operator: Operator, domain: Domain, a: u128, b: u128) -> bool {
    let b = if operator.operands() == 1 { a } else { b };
    let format = domain.format();
    if operator == Operator::AddMagnitudes && [a, b].iter().any(|&word| is_negative(format, word)) {
        return false;
    }
    match domain.values() {
        Values::Any => true,
        Values::Finite => [a, b].iter().all(|&word| class(format, word) != Class::Special),
        Values::Normal => {
            let comes = |&word: &u128| matches!(class(format, word), Class::Zero | Class::Normal);
            [a, b].iter().all(comes) && gives_normal(operator, format, a, b)
        }
    }
}

/// True if the result for zero or normal operands, computed with a longer exponent, is zero or in the normal range.
fn gives_normal(operator: Operator, format: Format, a: u128, b: u128) -> bool {
    let Ok(unbounded) = Format::new(15, format.fraction_bits(), Subnormals::Flushed)
        .and_then(|wider| wider.with_rounding(format.rounding()).with_roots(format.roots()))
    else {
        return false;
    };
    // Formats with the longest exponent cannot be widened, so the ends of their range are not tested.
    let widen = |word: u128| Soft::from_bits(format, word).to(unbounded).bits();
    match operator.result_format(format) {
        // If the result has another format or is a bit, only the operands count.
        Some(result) if result == format => {}
        _ => return true,
    }
    let result = operator.twin(unbounded, widen(a), widen(b));
    if class(unbounded, result) == Class::Special {
        return false;
    }
    let exponent = (result >> format.fraction_bits()) as i32 & 0x7fff;
    let normal = format.min_exponent()..=format.bias();
    result & !unbounded.sign_mask() == 0 || normal.contains(&(exponent - unbounded.bias()))
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

/// True for negative words, but not for −0.
fn is_negative(format: Format, word: u128) -> bool {
    word & format.sign_mask() != 0 && word & !format.sign_mask() != 0
}
