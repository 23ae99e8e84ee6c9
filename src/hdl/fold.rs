//! Simplifies operations with constant operands: less logic, and Verilog without `x & 1'b1`.

use super::module::Op;
use super::signal::Signal;

fn ones(width: u32) -> Option<u128> {
    match width {
        0..=127 => Some((1 << width) - 1),
        128 => Some(u128::MAX),
        _ => None,
    }
}

pub(super) fn not(operand: Signal<'_>) -> Option<Signal<'_>> {
    let node = operand.graph().node(operand.id()?);
    match node.op {
        Op::Constant(value) => Some(operand.same(!value & ones(node.width)?)),
        Op::Not => Some(Signal::new(operand.graph(), node.operands[0])),
        _ => None,
    }
}

pub(super) fn binary<'g>(left: Signal<'g>, right: Signal<'g>, op: &Op) -> Option<Signal<'g>> {
    if matches!(op, Op::Equal | Op::Less)
        && let Some(compared) = compare(left, right, op)
    {
        return Some(compared);
    }
    let width = left.width();
    let full = ones(width);
    match (left.as_constant(), right.as_constant()) {
        (Some(a), Some(b)) => {
            let full = full?;
            let bit = |condition| Some(left.graph().constant(1, u128::from(condition)));
            match op {
                Op::And => Some(left.same(a & b)),
                Op::Or => Some(left.same(a | b)),
                Op::Xor => Some(left.same(a ^ b)),
                Op::Add => Some(left.same(a.wrapping_add(b) & full)),
                Op::Sub => Some(left.same(a.wrapping_sub(b) & full)),
                Op::Equal => bit(a == b),
                Op::Less => bit(a < b),
                _ => None,
            }
        }
        (None, Some(b)) => match op {
            Op::And if b == 0 => Some(right),
            Op::And if Some(b) == full => Some(left),
            Op::Or | Op::Xor | Op::Add | Op::Sub if b == 0 => Some(left),
            Op::Or if Some(b) == full => Some(right),
            Op::Xor if Some(b) == full => Some(!left),
            Op::Equal if width == 1 => Some(if b == 1 { left } else { !left }),
            Op::Less if b == 0 => Some(left.graph().constant(1, 0)),
            _ => None,
        },
        (Some(0), None) if *op == Op::Less => Some(right.any()),
        (Some(a), None) if *op == Op::Less && Some(a) == full => Some(left.graph().constant(1, 0)),
        (Some(_), None) if matches!(op, Op::And | Op::Or | Op::Xor | Op::Add | Op::Equal) => binary(right, left, op),
        (None, None) if left.id() == right.id() => match op {
            Op::And | Op::Or => Some(left),
            _ => None,
        },
        _ => None,
    }
}

/// A comparison that a person would write without the zeros above its operands, or without a sum with a constant.
fn compare<'g>(left: Signal<'g>, right: Signal<'g>, op: &Op) -> Option<Signal<'g>> {
    let is_equal = *op == Op::Equal;
    let known = |condition| Some(left.graph().constant(1, u128::from(condition)));
    let again = |a: Signal<'g>, b: Signal<'g>| Some(if is_equal { a.equals(b) } else { a.less_than(b) });
    match (left.as_constant(), right.as_constant()) {
        (None, Some(b)) => {
            if is_equal && let Some((value, summand)) = sum_with_constant(left) {
                return again(value, value.same(b.wrapping_sub(summand) & ones(value.width())?));
            }
            let value = below_zeros(left)?;
            match b > ones(value.width())? {
                true => known(!is_equal),
                false => again(value, value.same(b)),
            }
        }
        (Some(_), None) if is_equal => compare(right, left, op),
        (Some(a), None) => {
            let value = below_zeros(right)?;
            if a > ones(value.width())? { known(false) } else { again(value.same(a), value) }
        }
        (None, None) => {
            let (a, b) = (below_zeros(left)?, below_zeros(right)?);
            let width = a.width().max(b.width());
            (width < left.width()).then(|| again(a.extend(width), b.extend(width)))?
        }
        (Some(_), Some(_)) => None,
    }
}

/// The value that an unnamed concatenation has below zeros.
pub(super) fn below_zeros(signal: Signal<'_>) -> Option<Signal<'_>> {
    let graph = signal.graph();
    let node = graph.node(signal.id()?);
    let [zeros, value] = node.operands[..] else { return None };
    let is_extension = node.op == Op::Concat && node.name.is_none() && graph.node(zeros).op == Op::Constant(0);
    is_extension.then(|| Signal::new(graph, value))
}

/// The other summand and the constant, modulo 2^width, of an unnamed sum or difference with a constant.
fn sum_with_constant(signal: Signal<'_>) -> Option<(Signal<'_>, u128)> {
    let graph = signal.graph();
    let node = graph.node(signal.id()?);
    let value = || Some(Signal::new(graph, *node.operands.first()?));
    let summand = Signal::new(graph, *node.operands.get(1)?).as_constant()?;
    match node.op {
        Op::Add if node.name.is_none() => Some((value()?, summand)),
        Op::Sub if node.name.is_none() => Some((value()?, summand.wrapping_neg())),
        _ => None,
    }
}

/// Looks through constants, slices and concatenations, so that a field is taken from its origin.
pub(super) fn slice(operand: Signal<'_>, low: u32, width: u32) -> Option<Signal<'_>> {
    if low == 0 && width == operand.width() {
        return Some(operand);
    }
    let graph = operand.graph();
    let node = graph.node(operand.id()?);
    match node.op {
        Op::Constant(value) if width <= 128 => {
            let shifted = if low >= 128 { 0 } else { value >> low };
            Some(graph.constant(width, shifted & ones(width)?))
        }
        // A field that has a name is sliced under that name.
        Op::Slice { low: inner } if node.name.is_none() => {
            Some(Signal::new(graph, node.operands[0]).slice(inner + low, width))
        }
        Op::Concat => {
            let mut end = node.width;
            for part in node.operands.iter().map(|&id| Signal::new(graph, id)) {
                let start = end - part.width();
                if low >= start && low + width <= end {
                    return Some(part.slice(low - start, width));
                }
                end = start;
            }
            None
        }
        _ => None,
    }
}
