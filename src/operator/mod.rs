//! Floating-point hardware for any [`Format`]. Each file has one operator, as a graph of bit operations that rounds
//! once, as the format says, and equals its twin in [`crate::number::Soft`] bit for bit.
//!
//! Operators are made combinational ([`build`]) and cut into stages for a clock afterwards ([`pipelined`]).

mod add;
mod architecture;
mod compare;
mod convert;
mod corrected;
mod div;
mod domain;
mod faithful;
mod halve;
mod iterative;
mod mul;
mod parts;
mod recip;
mod root_exceeds;
mod sqrt;
mod square_excess;
mod twin;
mod widening;

pub use architecture::Architecture;
pub use domain::{Domain, Values};
pub use iterative::iterative;
pub(crate) use widening::is_direct;

use std::sync::Arc;

use crate::hdl::{BuildErrors, DelayModel, Graph, Module, Signal, cut};
use crate::number::{self, Format, Roots};
use parts::Rounding;

/// The function of an operator, of operands `a`, `b`, `c` and `d` in one format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Operator {
    /// a + b.
    Add,
    /// a − b.
    Sub,
    /// a + b, rounded to odd.
    AddToOdd,
    /// a − b, rounded to odd.
    SubToOdd,
    /// a + b in another format, to which both are converted first.
    WideningAdd {
        /// The format of the result.
        to: Format,
    },
    /// a − b in another format, to which both are converted first.
    WideningSub {
        /// The format of the result.
        to: Format,
    },
    /// a · b.
    Mul,
    /// a · a.
    Square,
    /// a + b of operands that are not negative: less logic than [`Operator::Add`] for [`Values::Normal`], the same for
    /// others.
    AddMagnitudes,
    /// a / b.
    Div,
    /// 1 / a.
    Recip,
    /// √a.
    Sqrt,
    /// a · ½.
    Halve,
    /// a > b; one bit.
    Greater,
    /// a ≤ b; one bit.
    AtMost,
    /// One bit: the rounded √a is greater than b.
    RootExceeds,
    /// a² − (b² + c² + d²) in another format, from exact squares in a window; NaN if the result is in doubt.
    SquareExcess {
        /// The format of the result.
        to: Format,
    },
    /// a in another format.
    Convert {
        /// The format of the result.
        to: Format,
    },
}

impl Operator {
    /// The number of operands: 1, 2 or 4.
    pub const fn operands(self) -> usize {
        match self {
            Self::SquareExcess { .. } => 4,
            Self::Square | Self::Recip | Self::Sqrt | Self::Halve | Self::Convert { .. } => 1,
            _ => 2,
        }
    }

    /// The format of the result for operands in `format`; `None` if the result is one bit.
    pub const fn result_format(self, format: Format) -> Option<Format> {
        match self {
            Self::Greater | Self::AtMost | Self::RootExceeds => None,
            Self::Convert { to } | Self::SquareExcess { to } | Self::WideningAdd { to } | Self::WideningSub { to } => {
                Some(to)
            }
            _ => Some(format),
        }
    }

    /// A short name in lower case, as in `add`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Add => "add",
            Self::Sub => "sub",
            Self::AddToOdd => "add_to_odd",
            Self::SubToOdd => "sub_to_odd",
            Self::WideningAdd { .. } => "widening_add",
            Self::WideningSub { .. } => "widening_sub",
            Self::Mul => "mul",
            Self::Square => "square",
            Self::AddMagnitudes => "add_magnitudes",
            Self::Div => "div",
            Self::Recip => "recip",
            Self::Sqrt => "sqrt",
            Self::Halve => "halve",
            Self::Greater => "greater",
            Self::AtMost => "at_most",
            Self::RootExceeds => "root_exceeds",
            Self::SquareExcess { .. } => "square_excess",
            Self::Convert { .. } => "convert",
        }
    }

    /// The name of its module, as in `fp_add_e8f23`.
    pub fn module_name(self, domain: impl Into<Domain>) -> String {
        let domain = domain.into();
        match self {
            Self::Convert { to } | Self::SquareExcess { to } | Self::WideningAdd { to } | Self::WideningSub { to } => {
                format!("fp_{}_{domain}_to_{to}", self.name())
            }
            _ => format!("fp_{}_{domain}", self.name()),
        }
    }

    fn about(self, faithful: bool) -> String {
        match self {
            Self::Add => "result = a + b, rounded once".to_owned(),
            Self::Sub => "result = a - b, rounded once".to_owned(),
            Self::AddToOdd => "result = a + b, rounded to odd: what does not fit sets the last bit".to_owned(),
            Self::SubToOdd => "result = a - b, rounded to odd: what does not fit sets the last bit".to_owned(),
            Self::WideningAdd { to } => format!("result = a + b in {to}, rounded once"),
            Self::WideningSub { to } => format!("result = a - b in {to}, rounded once"),
            Self::Mul => "result = a * b, rounded once".to_owned(),
            Self::Square => "result = a * a, rounded once".to_owned(),
            Self::AddMagnitudes => "result = a + b, neither of them negative, rounded once".to_owned(),
            Self::Div => "result = a / b, rounded once".to_owned(),
            Self::Recip if faithful => "result = 1 / a, within one unit of the last place".to_owned(),
            Self::Sqrt if faithful => "result = square root of a, within one unit of the last place".to_owned(),
            Self::Recip => "result = 1 / a, rounded once".to_owned(),
            Self::Sqrt => "result = square root of a, rounded once".to_owned(),
            Self::Halve => "result = a / 2, rounded once".to_owned(),
            Self::Greater => "result = a > b; clear when either is a NaN".to_owned(),
            Self::AtMost => "result = a <= b; clear when either is a NaN".to_owned(),
            Self::RootExceeds => "result = (square root of a, rounded) > b, decided without the root".to_owned(),
            Self::SquareExcess { to } => format!("result = a a - (b b + c c + d d) in {to}; NaN where in doubt"),
            Self::Convert { to } => format!("result = a in {to}, rounded once"),
        }
    }
}

/// The names of inputs. An operator uses the first ones.
pub const INPUTS: [&str; 4] = ["a", "b", "c", "d"];

/// The operator as a combinational module: its [`INPUTS`], and the output `result`. It is made for the values in
/// `domain`: for every word of a format, or fewer.
///
/// If there are several architectures, it has [`Architecture::Recurrence`].
///
/// # Errors
/// Returns the first error that the graph recorded.
pub fn build(operator: Operator, domain: impl Into<Domain>) -> Result<Arc<Module>, BuildErrors> {
    build_as(operator, domain, Architecture::Recurrence)
}

/// As [`build`], in a given architecture if the operator has it for these values.
///
/// # Errors
/// Returns the first error that the graph recorded.
pub fn build_as(
    operator: Operator,
    domain: impl Into<Domain>,
    architecture: Architecture,
) -> Result<Arc<Module>, BuildErrors> {
    let domain = domain.into();
    let by_table = architecture == Architecture::Table && Architecture::Table.is_possible(operator, domain);
    let format = domain.format();
    let graph = Graph::new(operator.module_name(domain));
    let faithful = format.roots() == Roots::Faithful;
    graph.about(operator.about(faithful));
    graph.about(about_format(format));
    about_architecture(operator, domain, architecture).into_iter().for_each(|line| graph.about(line));
    about_values(domain.values()).into_iter().for_each(|line| graph.about(line));
    let inputs: Vec<_> = INPUTS[..operator.operands()].iter().map(|name| graph.input(name, format.width())).collect();
    let [a, b, c, d] = [0, 1, 2, 3].map(|index| inputs[index.min(inputs.len() - 1)]);
    let result = match operator {
        Operator::Add => add::add(a, b, domain, false, domain.rounding()),
        Operator::WideningAdd { to } => widening::sum(a, b, domain, to, false),
        Operator::Sub => add::add(a, b, domain, true, domain.rounding()),
        Operator::WideningSub { to } => widening::sum(a, b, domain, to, true),
        Operator::AddToOdd => add::add(a, b, domain, false, Rounding::Odd),
        Operator::SubToOdd => add::add(a, b, domain, true, Rounding::Odd),
        Operator::Mul => mul::mul(a, b, domain),
        Operator::Square => mul::squared(a, domain),
        Operator::AddMagnitudes if domain.is_normal() => add::add_magnitudes(a, b, domain),
        Operator::AddMagnitudes => add::add(a, b, domain, false, domain.rounding()),
        Operator::Div => div::div(a, b, domain),
        Operator::Recip if faithful => faithful::recip(a, domain),
        Operator::Recip if by_table => corrected::recip(a, domain),
        Operator::Recip => recip::recip(a, domain),
        Operator::Sqrt if faithful => faithful::sqrt(a, domain),
        Operator::Sqrt if by_table => corrected::sqrt(a, domain),
        Operator::Sqrt => sqrt::sqrt(a, domain),
        Operator::Halve => halve::halve(a, domain),
        Operator::Greater => compare::greater(a, b, domain),
        Operator::AtMost => compare::at_most(a, b, domain),
        Operator::RootExceeds => root_exceeds::root_exceeds(a, b, domain),
        Operator::SquareExcess { to } => square_excess::square_excess([a, b, c, d], domain, to),
        Operator::Convert { to } => convert::convert(a, domain, to),
    };
    graph.output("result", result);
    graph.finish()
}

/// a + b, or a − b, of two signals in `format`, as part of a module of the caller's.
pub(crate) fn sum<'g>(a: Signal<'g>, b: Signal<'g>, format: Format, subtract: bool) -> Signal<'g> {
    let domain = Domain::from(format);
    add::add(a, b, domain, subtract, domain.rounding())
}

/// The operator in the architecture for the model's target ([`Architecture::of`]), cut into stages for `clock_mhz`. The
/// module has its latency.
///
/// # Errors
/// Returns the first error that the graph recorded, or an error if the cut cannot meet the clock.
pub fn pipelined(
    operator: Operator,
    domain: impl Into<Domain>,
    model: &DelayModel,
    clock_mhz: f64,
) -> Result<Arc<Module>, BuildErrors> {
    let combinational = build_as(operator, domain, Architecture::of(model))?;
    cut(&combinational, model, clock_mhz)
}

/// The architecture of correct roots, if there are several.
fn about_architecture(operator: Operator, domain: Domain, architecture: Architecture) -> Option<&'static str> {
    if !Architecture::Table.is_possible(operator, domain) {
        return None;
    }
    Some(match architecture {
        Architecture::Table => "a table of parabolas, and the sign of what the middle of two neighbours leaves",
        Architecture::Recurrence => "a digit after the other, each a carry chain",
    })
}

fn about_values(values: Values) -> Option<&'static str> {
    match values {
        Values::Any => None,
        Values::Finite => Some("operands are neither infinite nor NaN"),
        Values::Normal => Some("operands and result are zero or normal, and nothing overflows"),
    }
}

fn about_format(format: Format) -> String {
    format!(
        "{format}: sign, {} exponent bits (bias {}), {} fraction bits; subnormals {}; {}",
        format.exponent_bits(),
        format.bias(),
        format.fraction_bits(),
        if format.keeps_subnormals() { "kept" } else { "flushed to zero" },
        match format.rounding() {
            number::Rounding::Nearest => "nearest, ties to even",
            number::Rounding::TowardZero => "rounded toward zero",
        }
    )
}
