//! The smallest and largest values of a kernel, derived on its graph. They show which operators need no logic for
//! infinities, NaN, subnormals, overflow and underflow.

use super::guard::Guards;
use super::kernel::{Kernel, Kind, Source, ValueId};
use crate::number::{Format, Soft};
use crate::operator::{Domain, Operator, Values};

/// The known range of a number that is neither infinite nor NaN. Bounds are powers of two, which rounding keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Range {
    /// The value is a multiple of 2^unit.
    unit: i32,
    /// The value is at least 2^smallest, if it is not zero.
    smallest: i32,
    /// The value is at most 2^largest.
    largest: i32,
    /// The value is never below zero.
    not_negative: bool,
    may_be_zero: bool,
}

/// Stands for the exponent of zero. No sum of a few exponents can leave this range.
const FAR: i32 = 1 << 24;

impl Range {
    /// All finite numbers of a format.
    fn finite(format: Format, not_negative: bool) -> Self {
        let fraction = format.fraction_bits() as i32;
        let unit = format.min_exponent() - fraction;
        let smallest = if format.keeps_subnormals() { unit } else { format.min_exponent() };
        Self { unit, smallest, largest: format.bias() + 1, not_negative, may_be_zero: true }
    }

    /// The range of one number; `None` if it is infinite or NaN.
    fn constant(format: Format, bits: u128) -> Option<Self> {
        let magnitude = bits & !format.sign_mask();
        let not_negative = bits == magnitude || magnitude == 0;
        if magnitude >= format.infinity_bits() {
            return None;
        }
        if Soft::from_bits(format, magnitude).to_f64() == 0.0 {
            return Some(Self { unit: FAR, smallest: FAR, largest: -FAR, not_negative, may_be_zero: true });
        }
        let biased = (magnitude >> format.fraction_bits()) as i32;
        let exponent = biased.max(1) - format.bias();
        let unit = exponent - format.fraction_bits() as i32;
        let smallest = if biased == 0 { unit } else { exponent };
        Some(Self { unit, smallest, largest: exponent + 1, not_negative, may_be_zero: false })
    }

    /// A result that is at least 2^smallest and at most 2^largest, rounded to this number of fraction bits.
    fn rounded(smallest: i32, largest: i32, fraction: i32) -> Self {
        Self { unit: smallest - fraction, smallest, largest, not_negative: false, may_be_zero: false }
    }

    fn either(self, other: Self) -> Self {
        Self {
            unit: self.unit.min(other.unit),
            smallest: self.smallest.min(other.smallest),
            largest: self.largest.max(other.largest),
            not_negative: self.not_negative && other.not_negative,
            may_be_zero: self.may_be_zero || other.may_be_zero,
        }
    }

    fn sum(self, other: Self, subtract: bool) -> Self {
        let both = self.either(other);
        let is_sum_of_magnitudes = !subtract && both.not_negative;
        Self {
            // Cancellation leaves at least one unit.
            smallest: if is_sum_of_magnitudes { both.smallest } else { both.unit },
            largest: both.largest + 1,
            not_negative: is_sum_of_magnitudes,
            may_be_zero: true,
            ..both
        }
    }

    fn product(self, other: Self, fraction: i32) -> Self {
        let rounded = Self::rounded(self.smallest + other.smallest, self.largest + other.largest, fraction);
        Self {
            unit: rounded.unit.max(self.unit + other.unit),
            not_negative: self.not_negative && other.not_negative,
            may_be_zero: self.may_be_zero || other.may_be_zero,
            ..rounded
        }
    }

    /// The bounds of numbers that are not zero.
    fn quotient(self, divisor: Self, fraction: i32) -> Self {
        let (smallest, largest) = (self.smallest - divisor.largest, self.largest - divisor.smallest);
        Self {
            not_negative: self.not_negative && divisor.not_negative,
            may_be_zero: self.may_be_zero,
            ..Self::rounded(smallest, largest, fraction)
        }
    }

    fn root(self, fraction: i32) -> Self {
        let (smallest, largest) = (self.smallest.div_euclid(2), (self.largest + 1).div_euclid(2));
        Self { not_negative: true, may_be_zero: self.may_be_zero, ..Self::rounded(smallest, largest, fraction) }
    }

    fn halved(self) -> Self {
        Self { unit: self.unit - 1, smallest: self.smallest - 1, largest: self.largest - 1, ..self }
    }

    fn has_subnormals(self, format: Format) -> bool {
        self.smallest < format.min_exponent()
    }

    fn is_normal(self, format: Format) -> bool {
        !self.has_subnormals(format) && self.largest <= format.bias()
    }
}

/// An operator as it is built: which one, and for which values.
pub(super) type Unit = (Operator, Domain);

/// The result of the analysis.
pub(super) struct Ranges {
    /// The unit of each operator, by value; `None` for other values.
    pub units: Vec<Option<Unit>>,
    /// The first operator with room for improvement, and why.
    pub short: Option<String>,
}

impl Ranges {
    /// Analyses every value once. Inputs without a promise have no known range.
    pub fn of(kernel: &Kernel) -> Self {
        let guards = Guards::new(kernel);
        let mut known: Vec<Option<Range>> = Vec::with_capacity(kernel.values.len());
        let mut found = Self { units: Vec::with_capacity(kernel.values.len()), short: None };
        for (index, value) in kernel.values.iter().enumerate() {
            let operand = |position: usize| known[value.operands[position].index()];
            let (range, unit) = match (value.source, value.kind) {
                (Source::Input(_), Kind::Number(format)) => (promised(kernel, &guards, index, format), None),
                (Source::Constant(bits), Kind::Number(format)) => (Range::constant(format, bits), None),
                (Source::Select, Kind::Number(_)) => (operand(1).zip(operand(2)).map(|(yes, no)| yes.either(no)), None),
                (Source::Operator(operator, format), _) => {
                    let ranges: Option<Vec<Range>> = value.operands.iter().map(|id| known[id.index()]).collect();
                    let is_guarded = || guards.hide_division_by_zero(kernel, ValueId(index as u32));
                    let judged = judge(operator, format, value.operands.as_slice(), ranges.as_deref(), is_guarded);
                    if let Some(why) = judged.short {
                        let name = value.name.as_deref().unwrap_or(operator.name());
                        found.short.get_or_insert_with(|| format!("`{name}` in {format}: {why}"));
                    }
                    (judged.range, Some(judged.unit))
                }
                _ => (None, None),
            };
            known.push(range);
            found.units.push(unit);
        }
        found
    }
}

/// The range that an input's promise guarantees, if no output depends on the input while the promise is broken.
fn promised(kernel: &Kernel, guards: &Guards, index: usize, format: Format) -> Option<Range> {
    let promise = kernel.promises.iter().find(|promise| promise.value.index() == index)?;
    guards.hide_broken_promises.then(|| Range::finite(format, promise.not_negative))
}

struct Judged {
    unit: Unit,
    range: Option<Range>,
    short: Option<String>,
}

fn judge(
    operator: Operator,
    format: Format,
    ids: &[ValueId],
    operands: Option<&[Range]>,
    is_guarded: impl Fn() -> bool,
) -> Judged {
    let with = |operator, values| (operator, Domain::new(format, values));
    let Some(operands) = operands else {
        let short = Some("an operand may be infinite or NaN".to_owned());
        return Judged { unit: with(operator, Values::Any), range: None, short };
    };
    let finite =
        |short: &str| Judged { unit: with(operator, Values::Finite), range: None, short: Some(short.to_owned()) };
    let divides_by = |divisor: Range| divisor.may_be_zero && !is_guarded();
    let (a, b) = (operands[0], operands[operands.len() - 1]);
    let fraction = operator.result_format(format).map_or(0, |format| format.fraction_bits() as i32);
    let result = match operator {
        Operator::Add | Operator::AddMagnitudes | Operator::AddToOdd | Operator::WideningAdd { .. } => {
            Some(a.sum(b, false))
        }
        Operator::Sub | Operator::SubToOdd | Operator::WideningSub { .. } => Some(a.sum(b, true)),
        Operator::Mul if ids[0] == ids[ids.len() - 1] => Some(Range { not_negative: true, ..a.product(b, fraction) }),
        Operator::Mul => Some(a.product(b, fraction)),
        Operator::Square => Some(Range { not_negative: true, ..a.product(a, fraction) }),
        Operator::Halve => Some(a.halved()),
        Operator::Sqrt if !a.not_negative => return finite("the root of a negative number"),
        Operator::Sqrt => Some(a.root(fraction)),
        Operator::Recip | Operator::Div if divides_by(b) => return finite("a division by zero that may be seen"),
        Operator::Recip => Some(
            Range { unit: 0, smallest: 0, largest: 0, not_negative: true, may_be_zero: false }.quotient(b, fraction),
        ),
        Operator::Div => Some(a.quotient(b, fraction)),
        Operator::SquareExcess { .. } => return finite("an excess of squares in doubt is a NaN"),
        Operator::Convert { .. } => Some(a),
        Operator::Greater | Operator::AtMost | Operator::RootExceeds => None,
    };
    let is_exact = |range: &Range| operator.result_format(format).is_some_and(|to| range.is_normal(to));
    let range = result.filter(is_exact);
    if operands.iter().any(|operand| operand.has_subnormals(format)) {
        let unit = with(operator, Values::Finite);
        let takes_them =
            matches!(operator, Operator::Convert { .. } | Operator::WideningAdd { .. } | Operator::WideningSub { .. });
        let short = (!takes_them).then(|| "an operand may be subnormal".to_owned());
        return Judged { unit, range, short };
    }
    match (operator, result) {
        (Operator::Convert { .. }, _) | (_, None) => {}
        (_, Some(result)) if range.is_none() => {
            let (low, high) = (result.smallest, result.largest);
            return finite(&format!("results from 2^{low} to 2^{high} leave the normal range"));
        }
        _ => {}
    }
    let adds_magnitudes = operator == Operator::Add && a.not_negative && b.not_negative;
    let operator = if adds_magnitudes { Operator::AddMagnitudes } else { operator };
    Judged { unit: with(operator, Values::Normal), range, short: None }
}
