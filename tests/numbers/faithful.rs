//! Reciprocals and roots against exact integers, for every significand: faithful ones of every fraction length, and
//! correctly rounded ones of binary32. `src/number/faithful.rs` bounds the errors of the lengths that take minutes.

use std::ops::RangeInclusive;

use contact_afu::number::{FAITHFUL_FRACTION_BITS, Faithful, Format, Function, Number, Soft};

/// Checks that the faithful result is less than one unit from the exact one, so equal to it if that is a whole number
/// of units; and that the corrected result is the nearest.
fn check(function: Function, fraction_bits: u32, odd: u32, fraction: u64) -> Result<(), String> {
    let value = Faithful::of(function, fraction_bits).value(odd, fraction);
    let m = u128::from(fraction | 1 << fraction_bits);
    let (low, high) = (u128::from(value) - 1, u128::from(value) + 1);
    // As integers: 2/m · 2^F = 2^(2F+1)/m, and √(m·2^odd) · 2^F = √(m · 2^(F+odd)).
    let faithful = match function {
        Function::Reciprocal => {
            let whole = 1_u128 << (2 * fraction_bits + 1);
            low * m < whole && whole < high * m
        }
        Function::Root => {
            let radicand = m << (fraction_bits + odd);
            low * low < radicand && radicand < high * high
        }
    };
    let limits = match function {
        Function::Reciprocal => value > 1 << fraction_bits && (fraction == 0) == (value == 2 << fraction_bits),
        Function::Root => value >> fraction_bits == 1,
    };
    // A reciprocal just above 1 may be rounded to 1.
    let limits = limits || function == Function::Reciprocal && value == 1 << fraction_bits;

    let table = Faithful::of(function, fraction_bits);
    let nearest = table.nearest(odd, fraction);
    let (below, above) = (2 * u128::from(nearest) - 1, 2 * u128::from(nearest) + 1);
    let is_nearest = match function {
        Function::Reciprocal => (below * m..above * m).contains(&(1 << (2 * fraction_bits + 2))),
        Function::Root => (below * below..above * above).contains(&(m << (fraction_bits + odd + 2))),
    };
    let is_nearest = is_nearest && table.lower(odd, fraction) >> fraction_bits == 1;
    if faithful && limits && is_nearest {
        return Ok(());
    }
    Err(format!(
        "{function:?} of {fraction_bits} bits, odd {odd}, fraction {fraction:#x}: {value:#x}, nearest {nearest:#x}"
    ))
}

/// The faithful result is within one unit, and the corrected one is the nearest.
#[test]
fn every_significand_is_within_a_unit() {
    try_all(2..=23);
}

/// The same for the longer ones.
#[test]
#[ignore = "takes minutes: 13 thousand million significands"]
fn every_longer_significand_is_within_a_unit() {
    try_all(24..=FAITHFUL_FRACTION_BITS);
}

fn try_all(lengths: RangeInclusive<u32>) {
    std::thread::scope(|scope| {
        for odd in 0..2_u32 {
            let lengths = lengths.clone();
            scope.spawn(move || {
                for bits in lengths {
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

/// The significand with its leading bit, and the exponent of the unit in the last place.
fn parts(number: Soft) -> (u128, i32) {
    let bits = number.bits();
    (bits & 0x7F_FFFF | 1 << 23, (bits >> 23) as i32 - 150)
}

/// Checks that a root and a reciprocal of binary32 are less than half a unit off. Exactly half is impossible: neither
/// function has a result in the middle between two numbers.
fn half_a_unit(fraction: u32) {
    let m = u128::from(fraction | 1 << 23);
    for odd in 0..2 {
        let number = Soft::from_bits(Format::BINARY32, (127 + odd) << 23 | u128::from(fraction));
        let (root, unit) = parts(number.sqrt());
        // In units of 2^-23 the root's square is m · 2^(23 + odd). The square of twice the root is four times as much.
        let (radicand, twice) = (m << (25 + odd), 2 * root);
        assert_eq!(unit, -23, "{fraction:#x}");
        let is_near = (twice - 1) * (twice - 1) < radicand && radicand < (twice + 1) * (twice + 1);
        assert!(is_near, "root of {fraction:#x}, odd {odd}");
    }
    let (reciprocal, unit) = parts(Soft::from_bits(Format::BINARY32, 127 << 23 | u128::from(fraction)).recip());
    // In units of its last place the reciprocal is 2^(23 - unit) / m.
    let exact = 1_u128 << (23 - unit);
    assert!((2 * exact).abs_diff(2 * m * reciprocal) < m, "reciprocal of {fraction:#x}");
}

/// The promise of `correct` in the format that studies call `paper`: half a unit, for every significand of 23 fraction
/// bits. The hardware equals this twin bit for bit (`tests/hardware/operators.rs`).
#[test]
fn every_correct_root_and_reciprocal_is_within_half_a_unit() {
    std::thread::scope(|scope| {
        for first in 0..2 {
            scope.spawn(move || (first..1 << 23).step_by(2).for_each(half_a_unit));
        }
    });
}
