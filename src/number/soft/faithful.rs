//! Faithful reciprocal and root of unpacked values.

use super::parts::{Class, Parts};
use crate::number::{Faithful, Function};

/// 1/a.
pub fn reciprocal(fraction_bits: u32, a: Parts) -> Parts {
    match a.class {
        Class::Nan => Parts::NAN,
        Class::Infinity => Parts::zero(a.negative),
        Class::Zero => Parts::infinity(a.negative),
        Class::Finite => {
            // 2/m of the significand m in [1, 2): in (1, 2].
            let value = Faithful::of(Function::Reciprocal, fraction_bits).value(0, fraction(fraction_bits, a));
            let zeros = value.leading_zeros();
            Parts::finite(a.negative, 63 - zeros as i32 - fraction_bits as i32 - 1 - a.exponent, value << zeros)
        }
    }
}

/// √a. √−0 is −0; of any other negative number it is NaN.
pub fn square_root(fraction_bits: u32, a: Parts) -> Parts {
    match a.class {
        Class::Zero | Class::Nan => a,
        _ if a.negative => Parts::NAN,
        Class::Infinity => a,
        Class::Finite => {
            let odd = a.exponent & 1;
            let table = Faithful::of(Function::Root, fraction_bits);
            let value = table.value(odd as u32, fraction(fraction_bits, a));
            Parts::finite(false, (a.exponent - odd) / 2, value << (63 - fraction_bits))
        }
    }
}

fn fraction(fraction_bits: u32, a: Parts) -> u64 {
    (a.significand << 1) >> (64 - fraction_bits)
}
