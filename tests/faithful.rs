//! Faithful reciprocals and roots: every significand of every fraction length, against exact integers.

use contact_afu::number::{FAITHFUL_FRACTION_BITS, Faithful, Function};

/// Whether `value` is less than one unit from the exact result and equal to it where that is a whole number of units;
/// and the sign of what is missing, for the middle.
fn check(function: Function, fraction_bits: u32, odd: u32, fraction: u64) -> Result<(), String> {
    let value = Faithful::of(function, fraction_bits).value(odd, fraction);
    let m = u128::from(fraction | 1 << fraction_bits);
    let value_wide = u128::from(value);
    let (low, high) = (value_wide - 1, value_wide + 1);
    // As integers: 2/m · 2^F = 2^(2F+1)/m, and √(m·2^odd) · 2^F = √(m · 2^(F+odd)).
    let (faithful, exact) = match function {
        Function::Reciprocal => {
            let whole = 1_u128 << (2 * fraction_bits + 1);
            (low * m < whole && whole < high * m, !whole.is_multiple_of(m) || value_wide * m == whole)
        }
        Function::Root => {
            let radicand = m << (fraction_bits + odd);
            let root = radicand.isqrt();
            (low * low < radicand && radicand < high * high, root * root != radicand || root == value_wide)
        }
    };
    let limits = match function {
        Function::Reciprocal => value > 1 << fraction_bits && (fraction == 0) == (value == 2 << fraction_bits),
        Function::Root => value >> fraction_bits == 1,
    };
    // A reciprocal just above 1 may be 1 itself.
    let limits = limits || function == Function::Reciprocal && value == 1 << fraction_bits;
    if faithful && exact && limits {
        return Ok(());
    }
    Err(format!("{function:?} of {fraction_bits} bits, odd {odd}, fraction {fraction:#x}: {value:#x}"))
}

#[test]
fn every_significand_is_within_a_unit() {
    std::thread::scope(|scope| {
        for odd in 0..2_u32 {
            scope.spawn(move || {
                for bits in 2..=FAITHFUL_FRACTION_BITS {
                    for fraction in 0..1_u64 << bits {
                        check(Function::Root, bits, odd, fraction).unwrap();
                        if (fraction & 1) as u32 == odd {
                            check(Function::Reciprocal, bits, 0, fraction).unwrap();
                        }
                    }
                }
            });
        }
    });
}
