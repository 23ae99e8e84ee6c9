//! The time table of a shared kernel as text, for the header of its Verilog.

use crate::operator::Operator;
use crate::pipeline::kernel::{Kernel, Source, ValueId};
use crate::pipeline::names::Names;

/// An operation in the time table.
pub(super) struct Operation {
    /// The cycle in which its operands are taken, from the arrival of a pair.
    pub cycle: u32,
    pub unit: String,
    pub computes: String,
}

/// One line per operation, by phase, below a heading.
pub(super) fn time_table(interval: u32, mut operations: Vec<Operation>) -> Vec<String> {
    operations.sort_by(|a, b| (a.cycle % interval, &a.unit, a.cycle).cmp(&(b.cycle % interval, &b.unit, b.cycle)));
    const WIDTH: usize = 117;
    // A longer name moves what is behind it.
    const UNIT: usize = 24;
    let widest = operations.iter().map(|of| of.unit.len()).max().unwrap_or(0).clamp("unit".len(), UNIT);
    let heading = format!("phase  cycle  {:widest$}  computes", "unit");
    let mut lines = vec![
        String::new(),
        format!("A unit takes its operands in this cycle of a pair, which is in this phase, cycle mod {interval}:"),
        heading.clone(),
    ];
    for Operation { cycle, unit, computes } in operations {
        let place = format!("{:>5}  {cycle:>5}  {unit:widest$}  ", cycle % interval);
        match computes.split_once(" = ").filter(|_| place.len() + computes.len() > WIDTH) {
            Some((name, value)) => {
                let column = heading.len() - "computes".len() + 2;
                lines.extend([format!("{place}{name}"), format!("{:column$}= {value}", "")]);
            }
            None => lines.push(place + &computes),
        }
    }
    lines.push("operand_0012x: digit k is the operand that a unit takes in phase k, x is any of them".to_owned());
    lines
}

/// What the operation of value `index` computes, as in `nx = dx * inverse_distance`.
pub(super) fn computation(kernel: &Kernel, names: &Names, index: usize) -> String {
    let name = |id: ValueId| match (names.signal(id), kernel.value(id).source) {
        (_, Source::Constant(_)) => names.constant(kernel, id),
        (Some(name), _) => name.to_owned(),
        (None, _) => format!("value_{}", id.index()),
    };
    let value = &kernel.values[index];
    let operand = |position: usize| value.operands.get(position).map_or_else(String::new, |id| name(*id));
    let (a, b) = (operand(0), operand(1));
    let computes = match value.source {
        Source::Operator(operator, _) => match operator {
            Operator::Add | Operator::AddMagnitudes | Operator::WideningAdd { .. } => format!("{a} + {b}"),
            Operator::Sub | Operator::WideningSub { .. } => format!("{a} - {b}"),
            Operator::AddToOdd => format!("{a} + {b}, to odd"),
            Operator::SubToOdd => format!("{a} - {b}, to odd"),
            Operator::Mul => format!("{a} * {b}"),
            Operator::Square => format!("{a} * {a}"),
            Operator::Div => format!("{a} / {b}"),
            Operator::Recip => format!("1 / {a}"),
            Operator::Sqrt => format!("sqrt({a})"),
            Operator::Halve => format!("{a} / 2"),
            Operator::Greater => format!("{a} > {b}"),
            Operator::AtMost => format!("{a} <= {b}"),
            Operator::RootExceeds => format!("sqrt({a}) > {b}"),
            Operator::SquareExcess { .. } => format!("{a}^2 - ({b}^2 + {}^2 + {}^2)", operand(2), operand(3)),
            Operator::Convert { to } => format!("{a} in {to}"),
        },
        // Logic without a unit of its own.
        _ => String::new(),
    };
    format!("{} = {computes}", name(ValueId(index as u32)))
}
