//! Expressions. Every operand has the width of its context, so nothing is ever extended or truncated silently.

use super::super::module::{Module, Node, NodeId, Op};
use super::names::Names;

/// Makes the text of values.
pub(super) struct Expressions<'a> {
    pub module: &'a Module,
    pub names: &'a Names,
}

impl Expressions<'_> {
    /// A value as it is used: its name, or its expression in place.
    pub fn value(&self, id: NodeId) -> String {
        match &self.names.declared[id.index()] {
            Some(name) => name.clone(),
            None => self.definition(id),
        }
    }

    /// A value as an operand: in parentheses unless it is a single term.
    pub fn term(&self, id: NodeId) -> String {
        let text = self.value(id);
        let node = self.module.node(id);
        let in_place = |id: NodeId| self.names.declared[id.index()].is_none();
        let compares = |id: NodeId| in_place(id) && matches!(self.module.node(id).op, Op::Less | Op::Equal);
        let compound = match node.op {
            Op::And | Op::Or | Op::Xor | Op::Add | Op::Sub | Op::SubAdd | Op::Mul => true,
            Op::Equal | Op::Less | Op::Mux | Op::Case { .. } | Op::OneHot => true,
            Op::Not => compares(node.operands[0]),
            _ => false,
        };
        let single = !(in_place(id) && compound);
        if single { text } else { format!("({text})") }
    }

    /// The expression of a node, in terms of its operands.
    pub fn definition(&self, id: NodeId) -> String {
        let node = self.module.node(id);
        let term = |position: usize| self.term(node.operands[position]);
        let infix = |operator: &str| format!("{} {operator} {}", term(0), term(1));
        match &node.op {
            Op::Constant(value) => constant(node.width, *value),
            Op::Parameter(index) => {
                let name = &self.module.parameters[*index].name;
                if node.width == 32 { name.clone() } else { format!("{name}[{}:0]", node.width - 1) }
            }
            Op::Not => self.negation(node.operands[0]),
            Op::And => self.gated(node).unwrap_or_else(|| self.chain(node, "&")),
            Op::Or => self.chain(node, "|"),
            Op::Xor => self.chain(node, "^"),
            Op::Add => infix("+"),
            Op::Sub => infix("-"),
            Op::SubAdd => self.sub_add(node),
            Op::Mul => self.product(node),
            Op::Equal => infix("=="),
            Op::Less => infix("<"),
            Op::Mux => {
                let [condition, yes, no] = [0, 1, 2].map(|position| node.operands[position]);
                match self.complemented(condition).filter(|_| !self.is_choice(no)) {
                    Some(condition) => {
                        format!("{} ? {} : {}", self.term(condition), self.term(no), self.otherwise(yes))
                    }
                    None => format!("{} ? {} : {}", term(0), term(1), self.otherwise(no)),
                }
            }
            Op::Case { .. } => self.cases(node),
            Op::Concat => self.concatenation(node),
            Op::Slice { low } => self.slice(node, *low),
            Op::OneHot => format!("{} << {}", constant(node.width, 1), term(0)),
            Op::Any => format!("|{}", term(0)),
            Op::All => format!("&{}", term(0)),
            Op::Wire => self.value(node.operands[0]),
            // Tables, state and instance outputs are declared, never written in place.
            Op::Lookup(_)
            | Op::Input
            | Op::Delay { .. }
            | Op::Register { .. }
            | Op::MemoryRead { .. }
            | Op::InstanceOutput { .. } => String::new(),
        }
    }

    /// `a & b & c`: the first operand needs no parentheses where it is the same operation.
    fn chain(&self, node: &Node, operator: &str) -> String {
        let [left, right] = node.operands[..] else { return String::new() };
        let same = self.names.declared[left.index()].is_none()
            && self.module.node(left).op == node.op
            && self.gated(self.module.node(left)).is_none();
        let first = if same { self.definition(left) } else { self.term(left) };
        format!("{first} {operator} {}", self.term(right))
    }

    /// The last operand of a choice: another choice needs no parentheses there.
    fn otherwise(&self, id: NodeId) -> String {
        if self.is_choice(id) { self.definition(id) } else { self.term(id) }
    }

    /// True for a choice that is written in place.
    fn is_choice(&self, id: NodeId) -> bool {
        let node = self.module.node(id);
        let is_open = self.names.declared[id.index()].is_none();
        is_open && (node.op == Op::Mux || node.op == Op::And && self.gated(node).is_some())
    }

    /// The operand of a complement that is written in place and has no sign of its own.
    fn complemented(&self, id: NodeId) -> Option<NodeId> {
        let node = self.module.node(id);
        let operand = *node.operands.first().filter(|_| node.op == Op::Not)?;
        let in_place = |id: NodeId| self.names.declared[id.index()].is_none();
        let has_sign = in_place(operand) && matches!(self.module.node(operand).op, Op::Less | Op::Equal);
        (in_place(id) && !has_sign).then_some(operand)
    }

    /// Not less is at least; not equal has a sign of its own; otherwise the complement.
    fn negation(&self, operand: NodeId) -> String {
        let node = self.module.node(operand);
        let pair =
            |operator: &str| format!("{} {operator} {}", self.term(node.operands[0]), self.term(node.operands[1]));
        match node.op {
            Op::Less if self.names.declared[operand.index()].is_none() => pair(">="),
            Op::Equal if self.names.declared[operand.index()].is_none() => pair("!="),
            _ => format!("~{}", self.term(operand)),
        }
    }

    /// A case as an expression, where it is not the next value of a register.
    fn cases(&self, node: &Node) -> String {
        let (number, values) = (node.operands[0], &node.operands[1..]);
        let width = self.module.node(number).width;
        let mut out = String::new();
        for (place, value) in values.iter().enumerate() {
            out += &match place + 1 == values.len() {
                true => self.term(*value),
                false => {
                    let place = constant(width, place as u128);
                    format!("({} == {place}) ? {} : ", self.term(number), self.term(*value))
                }
            };
        }
        out
    }

    /// `x & {8{c}}` reads better as a choice.
    fn gated(&self, node: &Node) -> Option<String> {
        let [value, mask] = node.operands[..] else { return None };
        let condition = self.module.repeated_bit(mask).filter(|_| self.names.declared[mask.index()].is_none())?;
        let zero = constant(node.width, 0);
        Some(match self.complemented(condition) {
            Some(condition) => format!("{} ? {zero} : {}", self.term(condition), self.otherwise(value)),
            None => format!("{} ? {} : {zero}", self.term(condition), self.term(value)),
        })
    }

    /// Adds the complement with a carry in, as carry chains do. So no tool builds two chains and a multiplexer.
    fn sub_add(&self, node: &Node) -> String {
        let [left, right] = [0, 1].map(|position| self.term(node.operands[position]));
        let add = node.operands[2];
        let subtract = match self.module.node(add).op {
            Op::Not if self.names.declared[add.index()].is_none() => self.term(self.module.node(add).operands[0]),
            _ => format!("~{}", self.term(add)),
        };
        let complement = format!("{right} ^ {{{}{{{subtract}}}}}", node.width);
        match node.width {
            1 => format!("{left} + ({complement}) + {subtract}"),
            width => format!("{left} + ({complement}) + {{{}, {subtract}}}", constant(width - 1, 0)),
        }
    }

    fn product(&self, node: &Node) -> String {
        let [left, right] = [0, 1].map(|position| {
            let id = node.operands[position];
            let missing = node.width - self.module.node(id).width;
            format!("{{{}, {}}}", constant(missing, 0), self.value(id))
        });
        format!("{left} * {right}")
    }

    /// Concatenations within a concatenation are one with it, and so are zeros that meet.
    fn concatenation(&self, node: &Node) -> String {
        let mut operands = Vec::new();
        self.flatten(node, &mut operands);
        let mut parts = Vec::new();
        let mut rest = &operands[..];
        while let [first, ..] = rest {
            let zeros = rest.iter().map_while(|id| self.zeros(*id)).collect::<Vec<_>>();
            let (run, text) = match zeros.len() {
                0 => (rest.iter().take_while(|id| *id == first).count(), self.value(*first)),
                run => (run, constant(zeros.iter().sum(), 0)),
            };
            parts.push(if run > 1 && zeros.is_empty() { format!("{{{run}{{{text}}}}}") } else { text });
            rest = &rest[run..];
        }
        match &parts[..] {
            [only] if only.starts_with('{') => only.clone(),
            _ => format!("{{{}}}", parts.join(", ")),
        }
    }

    fn flatten(&self, node: &Node, operands: &mut Vec<NodeId>) {
        for &id in &node.operands {
            let part = self.module.node(id);
            let is_open = part.op == Op::Concat && self.names.declared[id.index()].is_none();
            if is_open && self.module.repeated_bit(id).is_none() {
                self.flatten(part, operands);
            } else {
                operands.push(id);
            }
        }
    }

    /// The number of bits of a constant zero that is written in place.
    fn zeros(&self, id: NodeId) -> Option<u32> {
        let node = self.module.node(id);
        (node.op == Op::Constant(0) && self.names.declared[id.index()].is_none()).then_some(node.width)
    }

    fn slice(&self, node: &Node, low: u32) -> String {
        let base = self.value(node.operands[0]);
        if node.width == 1 { format!("{base}[{low}]") } else { format!("{base}[{}:{low}]", low + node.width - 1) }
    }
}

/// A sized literal: decimal where that is short, else hexadecimal.
pub(super) fn constant(width: u32, value: u128) -> String {
    match width {
        1 => format!("1'b{value}"),
        _ if value < 1024 => format!("{width}'d{value}"),
        _ => format!("{width}'h{value:x}"),
    }
}

/// `[7:0] `, or an empty text for one bit.
pub(super) fn range(width: u32) -> String {
    if width == 1 { String::new() } else { format!("[{}:0] ", width - 1) }
}
