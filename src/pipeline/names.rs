//! Names of values and instances: the given ones, and derived ones for the others.

use std::collections::HashSet;

use super::kernel::{Kernel, Kind, Source, ValueId};
use crate::number::Soft;
use crate::operator::Operator;

/// Above this length, a number is clearer than a derived name.
const LONGEST: usize = 44;

/// The names of one kernel.
pub(super) struct Names {
    signals: Vec<Option<String>>,
    instances: HashSet<String>,
}

impl Names {
    pub fn new(kernel: &Kernel) -> Self {
        let mut signals: Vec<Option<String>> = Vec::with_capacity(kernel.values.len());

        for (index, value) in kernel.values.iter().enumerate() {
            let operand = |position: usize| {
                let id = *value.operands.get(position)?;
                signals[id.index()].clone().or_else(|| constant_name(kernel, id))
            };
            let name = value.name.clone().or_else(|| match value.source {
                Source::Operator(operator, _) => {
                    let derived = derive(operator, operand(0), operand(1));
                    Some(derived.unwrap_or_else(|| format!("{}_{index}", operator.name())))
                }
                _ => None,
            });
            signals.push(name);
        }
        name_choices(kernel, &mut signals);
        name_outputs(kernel, &mut signals);
        Self { signals, instances: HashSet::new() }
    }

    /// The value's name; `None` for unnamed glue.
    pub fn signal(&self, id: ValueId) -> Option<&str> {
        self.signals[id.index()].as_deref()
    }

    /// A constant's number, or its bits.
    pub fn constant(&self, kernel: &Kernel, id: ValueId) -> String {
        let bits = || kernel.as_constant(id).map_or_else(String::new, |bits| format!("0x{bits:x}"));
        constant_name(kernel, id).unwrap_or_else(bits)
    }

    /// A new name for the operator that makes the value.
    pub fn instance(&mut self, id: ValueId, operator: Operator) -> String {
        let base = format!("{}_{}", operator.name(), self.signal(id).unwrap_or("value"));
        let mut name = base.clone();
        let mut copy = 2;
        while !self.instances.insert(name.clone()) {
            name = format!("{base}_{copy}");
            copy += 1;
        }
        name
    }
}

/// An unnamed selection is named after its destination.
fn name_choices(kernel: &Kernel, signals: &mut [Option<String>]) {
    for index in (0..kernel.values.len()).rev() {
        let (user, Some(name)) = (&kernel.values[index], signals[index].clone()) else { continue };
        for &id in &user.operands {
            let value = kernel.value(id);
            if value.source == Source::Select && signals[id.index()].is_none() {
                signals[id.index()] = match (user.source, value.kind) {
                    (Source::Operator(Operator::Convert { .. }, _), Kind::Number(format)) => {
                        Some(format!("{name}_{format}"))
                    }
                    (Source::Select, _) => Some(format!("{name}_chosen")),
                    _ => None,
                };
            }
        }
    }
}

/// The port's name belongs to the value as it leaves. Before that, the value has a suffix.
fn name_outputs(kernel: &Kernel, signals: &mut [Option<String>]) {
    for (port, id) in &kernel.outputs {
        let signal = &mut signals[id.index()];
        if !matches!(kernel.value(*id).source, Source::Input(_)) && signal.as_ref().is_none_or(|name| name == port) {
            *signal = Some(format!("{port}_early"));
        }
    }
}

fn derive(operator: Operator, a: Option<String>, b: Option<String>) -> Option<String> {
    let a = a?;
    let name = match (operator, b) {
        (Operator::Convert { to }, _) => format!("{a}_{to}"),
        (Operator::Halve, _) => format!("half_{a}"),
        (Operator::Recip, _) => format!("inverse_{a}"),
        (Operator::Sqrt, _) => format!("root_{a}"),
        (Operator::Square, _) => format!("{a}_squared"),
        (Operator::Mul, Some(b)) if a == b => format!("{a}_squared"),
        (_, None) => return None,
        (Operator::Mul, Some(b)) => format!("{a}_times_{b}"),
        (Operator::Add | Operator::AddMagnitudes | Operator::WideningAdd { .. }, Some(b)) => format!("{a}_plus_{b}"),
        (Operator::Sub | Operator::WideningSub { .. }, Some(b)) => format!("{a}_minus_{b}"),
        (Operator::AddToOdd, Some(b)) => format!("{a}_plus_{b}_odd"),
        (Operator::SubToOdd, Some(b)) => format!("{a}_minus_{b}_odd"),
        (Operator::SquareExcess { .. }, _) => format!("excess_of_{a}"),
        (Operator::Div, Some(b)) => format!("{a}_over_{b}"),
        (Operator::Greater, Some(b)) => format!("{a}_above_{b}"),
        (Operator::AtMost, Some(b)) => format!("{a}_at_most_{b}"),
        (Operator::RootExceeds, Some(b)) => format!("root_{a}_above_{b}"),
    };
    // The name of a constant is its digits, and a name in Verilog cannot begin with a digit.
    let name = if name.starts_with(|c: char| c.is_ascii_digit()) { format!("number_{name}") } else { name };
    (name.len() <= LONGEST).then_some(name)
}

/// A small whole number's digits.
fn constant_name(kernel: &Kernel, id: ValueId) -> Option<String> {
    let (Source::Constant(bits), Kind::Number(format)) = (kernel.value(id).source, kernel.value(id).kind) else {
        return None;
    };
    let number = Soft::from_bits(format, bits).to_f64();
    (number.fract() == 0.0 && (0.0..=99.0).contains(&number)).then(|| format!("{number:.0}"))
}
