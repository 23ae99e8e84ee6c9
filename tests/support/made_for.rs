//! For which operands hardware must give its twin's word: that made for certain values need not for others.

use contact_afu::number::{Format, Number, Soft, Subnormals};
use contact_afu::operator::{Domain, Operator, Values};

/// Whether hardware made for the values in `domain` gives the twin's word for these operands. `b` counts only if
/// it has two, and serves for the third and fourth too.
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

/// Whether the result for zero or normal operands is zero or, without regard to the exponent's ends, normal.
fn gives_normal(operator: Operator, format: Format, a: u128, b: u128) -> bool {
    let Ok(unbounded) = Format::new(15, format.fraction_bits(), Subnormals::Flushed)
        .and_then(|wider| wider.with_rounding(format.rounding()).with_roots(format.roots()))
    else {
        return false;
    };
    // Formats with the longest exponent cannot be looked at from a longer one: their ends are left out.
    let widen = |word: u128| Soft::from_bits(format, word).to(unbounded).bits();
    match operator.result_format(format) {
        // The operand alone counts where the result is of another format, or a bit.
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

/// Below zero: −0 is not.
fn is_negative(format: Format, word: u128) -> bool {
    word & format.sign_mask() != 0 && word & !format.sign_mask() != 0
}
