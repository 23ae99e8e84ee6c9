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
