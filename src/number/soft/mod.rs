//! `Soft`: a number of any [`Format`], computed with integers alone. The exact twin of the generated hardware.

mod arithmetic;
mod compare;
mod faithful;
mod parts;
mod window;

use super::{Format, Number, Roots, Rounding, Window};
use parts::{Parts, pack, pack_odd, unpack};
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A word with its format.
///
/// Every operation is exact inside and rounds once, as its format says (faithful roots are computed as the hardware
/// computes them). Every NaN that an operation produces is the canonical one. An operation on two numbers of different
/// formats panics with the names of both formats.
///
/// `==` compares words, so +0 differs from −0 and a NaN equals itself: use [`Number::gt`] and [`Number::le`] for
/// IEEE comparisons.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Soft {
    bits: u128,
    format: Format,
}

impl Soft {
    /// The number whose word is `bits`.
    ///
    /// # Panics
    /// Panics if `bits` has a bit set beyond the format's width.
    #[inline]
    pub fn from_bits(format: Format, bits: u128) -> Self {
        assert!(bits >> format.width() == 0, "{bits:#x} has more bits than a word of {format}");
        Self { bits, format }
    }

    /// `value` rounded once to `format`.
    pub fn from_f64(format: Format, value: f64) -> Self {
        Self::from_bits(Format::BINARY64, value.to_bits().into()).to(format)
    }

    /// The same word as `value`, in [`Format::BINARY32`].
    #[inline]
    pub fn from_f32(value: f32) -> Self {
        Self { bits: value.to_bits().into(), format: Format::BINARY32 }
    }

    /// The value rounded once to `f64`: exact for exponents of up to 11 bits.
    pub fn to_f64(self) -> f64 {
        f64::from_bits(self.to(Format::BINARY64).bits as u64)
    }

    /// The word.
    #[inline]
    pub fn bits(self) -> u128 {
        self.bits
    }

    /// The format of the word.
    #[inline]
    pub fn format(self) -> Format {
        self.format
    }

    /// True if the word is a NaN, canonical or not.
    pub fn is_nan(self) -> bool {
        self.bits & !self.format.sign_mask() > self.format.infinity_bits()
    }

    #[inline]
    fn parts(self) -> Parts {
        unpack(self.format, self.bits)
    }

    /// An operation on two numbers of one format.
    #[inline]
    fn with(self, other: Self, operation: impl Fn(Parts, Parts) -> Parts) -> Self {
        self.must_share_format(other);
        Self { bits: pack(self.format, operation(self.parts(), other.parts())), format: self.format }
    }

    /// A faithful result keeps its accuracy; if a subnormal has fewer bits, it is rounded to nearest.
    fn faithful(self, function: impl Fn(u32, Parts) -> Parts) -> Self {
        let result = function(self.format.fraction_bits(), self.parts());
        Self { bits: pack(self.format.with_rounding(Rounding::Nearest), result), ..self }
    }

    #[inline]
    fn must_share_format(self, other: Self) {
        assert!(self.format == other.format, "an operation mixes the formats {} and {}", self.format, other.format);
    }
}

impl fmt::Debug for Soft {
    /// Writes the nearest `f64`, the format and the word: `0.5 (e5f10 0x3800)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} ({} {:#x})", self.to_f64(), self.format, self.bits)
    }
}

impl Neg for Soft {
    type Output = Self;

    /// Flips the sign; a NaN becomes the canonical one.
    fn neg(self) -> Self {
        let bits = if self.is_nan() { self.format.nan_bits() } else { self.bits ^ self.format.sign_mask() };
        Self { bits, format: self.format }
    }
}

/// The operators and their assigning forms.
macro_rules! operators {
    ($($trait:ident::$method:ident, $assign_trait:ident::$assign_method:ident, $function:expr;)*) => {$(
        impl $trait for Soft {
            type Output = Self;

            #[inline]
            fn $method(self, other: Self) -> Self {
                self.with(other, $function)
            }
        }

        impl $assign_trait for Soft {
            #[inline]
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}

operators! {
    Add::add, AddAssign::add_assign, arithmetic::add;
    Sub::sub, SubAssign::sub_assign, |a, b| arithmetic::add(a, b.negated());
    Mul::mul, MulAssign::mul_assign, arithmetic::multiply;
    Div::div, DivAssign::div_assign, arithmetic::divide;
}

impl Number for Soft {
    type Bool = bool;

    fn constant(self, value: f64) -> Self {
        let constant = Self::from_f64(self.format, value);
        debug_assert!(constant.to_f64() == value, "{value} is not a number of {}", self.format);
        constant
    }

    #[inline]
    fn sqrt(self) -> Self {
        match self.format.roots() {
            Roots::Correct => Self { bits: pack(self.format, arithmetic::square_root(self.parts())), ..self },
            Roots::Faithful => self.faithful(faithful::square_root),
        }
    }

    #[inline]
    fn recip(self) -> Self {
        match self.format.roots() {
            Roots::Correct => Self { bits: pack(self.format, arithmetic::divide(Parts::ONE, self.parts())), ..self },
            Roots::Faithful => self.faithful(faithful::reciprocal),
        }
    }

    #[inline]
    fn gt(self, other: Self) -> bool {
        self.must_share_format(other);
        compare::order(self.format, self.bits, other.bits) == Some(Ordering::Greater)
    }

    #[inline]
    fn le(self, other: Self) -> bool {
        self.must_share_format(other);
        matches!(compare::order(self.format, self.bits, other.bits), Some(Ordering::Less | Ordering::Equal))
    }

    #[inline]
    fn root_exceeds(self, bound: Self) -> bool {
        self.must_share_format(bound);
        compare::root_exceeds(self.format, self.parts(), bound.parts())
    }

    #[inline]
    fn select(condition: bool, yes: Self, no: Self) -> Self {
        yes.must_share_format(no);
        if condition { yes } else { no }
    }

    /// This number in another format, rounded once. In its own format the word does not change.
    #[inline]
    fn to(self, format: Format) -> Self {
        if format == self.format { self } else { Self { bits: pack(format, self.parts()), format } }
    }
}

impl Window for Soft {
    fn plus_to_odd(self, other: Self) -> Self {
        self.must_share_format(other);
        let sum = arithmetic::add(self.parts(), other.parts());
        Self { bits: pack_odd(self.format, sum), format: self.format }
    }

    fn minus_to_odd(self, other: Self) -> Self {
        self.plus_to_odd(-other)
    }

    fn square_excess(self, others: [Self; 3], to: Format) -> Self {
        others.iter().for_each(|other| self.must_share_format(*other));
        let excess = window::square_excess(self.format, self.parts(), others.map(Self::parts));
        Self { bits: pack(to, excess), format: to }
    }
}
