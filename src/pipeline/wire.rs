//! Numbers and Booleans that are wires. Computing with them records a kernel.

use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Not, Sub, SubAssign};
use std::panic::Location;

use super::kernel::{Kind, Source};
use super::trace::{Handle, make};
use crate::number::{Boolean, Format, Number, Soft, Window};
use crate::operator::Operator;

/// A number in hardware. It belongs to the kernel that [`super::trace`] reads. A bad operation is recorded there and
/// returns a poisoned wire, on which further operations do nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wire(pub(super) Handle);

/// A Boolean in hardware: one bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bit(pub(super) Handle);

#[track_caller]
fn operate(operator: Operator, operands: &[Handle]) -> Handle {
    make(operator.name(), operands, Location::caller(), |kernel, ids| kernel.operator(operator, ids))
}

macro_rules! operators {
    ($($trait:ident::$method:ident, $assign_trait:ident::$assign_method:ident, $operator:ident;)*) => {$(
        impl $trait for Wire {
            type Output = Self;

            #[track_caller]
            fn $method(self, other: Self) -> Self {
                Self(operate(Operator::$operator, &[self.0, other.0]))
            }
        }

        impl $assign_trait for Wire {
            #[track_caller]
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}

operators! {
    Add::add, AddAssign::add_assign, Add;
    Sub::sub, SubAssign::sub_assign, Sub;
    Mul::mul, MulAssign::mul_assign, Mul;
    Div::div, DivAssign::div_assign, Div;
}

impl Number for Wire {
    type Bool = Bit;

    #[track_caller]
    fn constant(self, value: f64) -> Self {
        Self(make("constant", &[self.0], Location::caller(), |kernel, ids| {
            let kind = kernel.value(ids[0]).kind;
            let Kind::Number(format) = kind else { return Err("constant: of a Boolean".to_owned()) };
            let word = Soft::from_f64(format, value);
            if word.to_f64() != value {
                return Err(format!("constant: {value} is no number of {format}"));
            }
            Ok(kernel.constant(kind, word.bits()))
        }))
    }

    #[track_caller]
    fn sqrt(self) -> Self {
        Self(operate(Operator::Sqrt, &[self.0]))
    }

    #[track_caller]
    fn recip(self) -> Self {
        Self(operate(Operator::Recip, &[self.0]))
    }

    #[track_caller]
    fn gt(self, other: Self) -> Bit {
        Bit(operate(Operator::Greater, &[self.0, other.0]))
    }

    #[track_caller]
    fn le(self, other: Self) -> Bit {
        Bit(operate(Operator::AtMost, &[self.0, other.0]))
    }

    #[track_caller]
    fn root_exceeds(self, bound: Self) -> Bit {
        Bit(operate(Operator::RootExceeds, &[self.0, bound.0]))
    }

    #[track_caller]
    fn select(condition: Bit, yes: Self, no: Self) -> Self {
        Self(make("select", &[condition.0, yes.0, no.0], Location::caller(), |kernel, ids| {
            kernel.select(ids[0], ids[1], ids[2])
        }))
    }

    #[track_caller]
    fn to(self, format: Format) -> Self {
        Self(operate(Operator::Convert { to: format }, &[self.0]))
    }

    /// The first name given to a value is kept. A constant needs none.
    #[track_caller]
    fn named(self, name: &str) -> Self {
        Self(make("name", &[self.0], Location::caller(), |kernel, ids| {
            if kernel.as_constant(ids[0]).is_none() {
                kernel.values[ids[0].index()].name.get_or_insert_with(|| name.to_owned());
            }
            Ok(ids[0])
        }))
    }
}

impl Window for Wire {
    #[track_caller]
    fn plus_to_odd(self, other: Self) -> Self {
        Self(operate(Operator::AddToOdd, &[self.0, other.0]))
    }

    #[track_caller]
    fn minus_to_odd(self, other: Self) -> Self {
        Self(operate(Operator::SubToOdd, &[self.0, other.0]))
    }

    #[track_caller]
    fn square_excess(self, [x, y, z]: [Self; 3], to: Format) -> Self {
        Self(operate(Operator::SquareExcess { to }, &[self.0, x.0, y.0, z.0]))
    }
}

impl Boolean for Bit {}

impl BitAnd for Bit {
    type Output = Self;

    #[track_caller]
    fn bitand(self, other: Self) -> Self {
        logic("and", Source::And, self, other)
    }
}

impl BitOr for Bit {
    type Output = Self;

    #[track_caller]
    fn bitor(self, other: Self) -> Self {
        logic("or", Source::Or, self, other)
    }
}

#[track_caller]
fn logic(what: &str, source: Source, a: Bit, b: Bit) -> Bit {
    Bit(make(what, &[a.0, b.0], Location::caller(), |kernel, ids| Ok(kernel.logic(source, ids[0], ids[1]))))
}

impl Not for Bit {
    type Output = Self;

    #[track_caller]
    fn not(self) -> Self {
        Self(make("not", &[self.0], Location::caller(), |kernel, ids| Ok(kernel.not(ids[0]))))
    }
}
