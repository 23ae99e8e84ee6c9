//! Evaluates the kernel with an `f32` that detects IEEE overflow and underflow.

use contact_afu::kernel::contact;
use contact_afu::number::{Format, Number};
use contact_afu::query::{Fields, Flow, PairRecord, Query};
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Sub, SubAssign};

thread_local! {
    /// True if an operation of [`Watched`] overflowed or underflowed.
    static RAISED: Cell<bool> = const { Cell::new(false) };
}

/// An `f32` that detects IEEE overflow (a finite operation gives infinity) and underflow (tiny and inexact).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Watched(f32);

impl Watched {
    /// Records the exceptions of an operation. `exact` is true if `result` needed no rounding.
    fn watch(result: f32, finite: bool, exact: bool) -> Self {
        let overflow = result.is_infinite() && finite;
        let underflow = result.abs() <= f32::MIN_POSITIVE && !exact;
        RAISED.set(RAISED.get() | overflow | underflow);
        Self(result)
    }
}

macro_rules! watched {
    ($($trait:ident::$method:ident, $assign:ident::$assign_method:ident, $exact:ident;)*) => {$(
        impl $trait for Watched {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                let result = self.0.$method(other.0);
                let exact = $exact(self.0.into(), other.0.into(), result.into());
                Self::watch(result, self.0.is_finite() && other.0.is_finite(), exact)
            }
        }

        impl $assign for Watched {
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}

/// A tiny sum is always exact.
const fn sum_is_exact(_: f64, _: f64, _: f64) -> bool {
    true
}

/// The product of two binary32 numbers is exact in binary64.
fn product_is_exact(a: f64, b: f64, result: f64) -> bool {
    a * b == result
}

fn quotient_is_exact(a: f64, b: f64, result: f64) -> bool {
    b * result == a
}

watched! {
    Add::add, AddAssign::add_assign, sum_is_exact;
    Sub::sub, SubAssign::sub_assign, sum_is_exact;
    Mul::mul, MulAssign::mul_assign, product_is_exact;
    Div::div, DivAssign::div_assign, quotient_is_exact;
}

impl Number for Watched {
    type Bool = bool;

    fn constant(self, value: f64) -> Self {
        Self(value as f32)
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn recip(self) -> Self {
        if self.0 == 0.0 { Self(f32::INFINITY) } else { Self(1.0) / self }
    }

    fn gt(self, other: Self) -> bool {
        self.0 > other.0
    }

    fn le(self, other: Self) -> bool {
        self.0 <= other.0
    }

    fn root_exceeds(self, bound: Self) -> bool {
        self.0.root_exceeds(bound.0)
    }

    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }

    fn to(self, _: Format) -> Self {
        self
    }
}

/// True if evaluating this pair's flow in f32 overflows or underflows.
pub fn raises(query: Query, pair: &PairRecord, flow: Flow) -> bool {
    // Only a real contact computes more than the decision.
    let fields = if flow == Flow::Real { Fields::ALL } else { Fields::HIT };
    RAISED.set(false);
    let word = |word: usize| Watched(f32::from_bits(pair.0[word]));
    let _ = contact(query, word, true, Format::BINARY32, Format::BINARY32, fields);
    RAISED.get()
}
