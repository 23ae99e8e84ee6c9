//! Registers whose next value is a case. Those with the same number and notes share one case statement.

use super::super::module::{Module, Node, NodeId, Op};
use super::expression::{Expressions, constant};

/// One case statement.
struct Case<'a> {
    number: NodeId,
    notes: &'a [String],
    /// The name of each register and its values.
    registers: Vec<(&'a str, &'a [NodeId])>,
}

/// The case statements of a module, in the order of their first registers.
pub(super) struct Cases<'a> {
    module: &'a Module,
    text: &'a Expressions<'a>,
    cases: Vec<Case<'a>>,
}

impl<'a> Cases<'a> {
    pub fn new(module: &'a Module, text: &'a Expressions<'a>) -> Self {
        Self { module, text, cases: Vec::new() }
    }

    /// Takes a register without an enable, if its next value is a case that is written nowhere else.
    pub fn take(&mut self, name: &'a str, register: &Node) -> bool {
        let [next] = register.operands[..] else { return false };
        let (Op::Case { notes }, [number, values @ ..]) =
            (&self.module.node(next).op, &self.module.node(next).operands[..])
        else {
            return false;
        };
        if self.text.names.declared[next.index()].is_some() {
            return false;
        }
        let (number, notes) = (*number, &notes[..]);
        match self.cases.iter_mut().find(|case| case.number == number && case.notes == notes) {
            Some(case) => case.registers.push((name, values)),
            None => self.cases.push(Case { number, notes, registers: vec![(name, values)] }),
        }
        true
    }

    /// A clocked block with all of them, or nothing.
    pub fn text(&self) -> String {
        if self.cases.is_empty() {
            return String::new();
        }
        let statements: Vec<String> = self.cases.iter().map(|case| self.statement(case)).collect();
        format!("  always @(posedge clk) begin\n{}  end\n", statements.join("\n"))
    }

    /// Each value is below its note. The last one is for all other numbers, so that the case is complete.
    fn statement(&self, case: &Case<'_>) -> String {
        let width = self.module.node(case.number).width;
        let mut out = format!("    case ({})\n", self.text.value(case.number));
        for (place, note) in case.notes.iter().enumerate() {
            if !note.is_empty() {
                out += &format!("      // {note}\n");
            }
            let is_last = place + 1 == case.notes.len();
            let label = if is_last { "default".to_owned() } else { constant(width, place as u128) };
            let takes = |(name, values): &(&str, &[NodeId])| format!("{name} <= {};\n", self.text.value(values[place]));
            out += &match &case.registers[..] {
                [only] => format!("      {label}: {}", takes(only)),
                all => {
                    let lines: String = all.iter().map(|register| format!("        {}", takes(register))).collect();
                    format!("      {label}: begin\n{lines}      end\n")
                }
            };
        }
        out + "    endcase\n"
    }
}
