//! Finds wrong results that no output shows, because a selection replaces them.

use std::collections::{BTreeMap, HashMap};

use super::kernel::{Kernel, Kind, Source, ValueId};
use crate::operator::Operator;

/// Booleans with assumed values.
type Supposed = BTreeMap<ValueId, bool>;

/// Says whether outputs hide wrong values.
pub(super) struct Guards {
    /// No output depends on a promised input while the promise's condition is false.
    pub hide_broken_promises: bool,
}

impl Guards {
    pub fn new(kernel: &Kernel) -> Self {
        let wrong: Vec<ValueId> = kernel.promises.iter().map(|promise| promise.value).collect();
        let may_break = kernel.promises.iter().filter(|promise| kernel.as_constant(promise.condition) != Some(1));
        let broken = may_break.map(|promise| Supposed::from([(promise.condition, false)]));
        let hidden = broken.map(|supposed| !shows(kernel, &wrong, &supposed)).reduce(|all, one| all && one);
        Self { hide_broken_promises: hidden.unwrap_or(!kernel.promises.is_empty()) }
    }

    /// True if no output depends on a quotient whose divisor is zero, as far as the kernel tests this by comparing the
    /// divisor with zero.
    pub fn hide_division_by_zero(&self, kernel: &Kernel, quotient: ValueId) -> bool {
        let Some(&divisor) = kernel.value(quotient).operands.last() else { return false };
        let is_zero = |value: &super::kernel::Value| {
            let with_zero = value.operands.len() == 2
                && value.operands[0] == divisor
                && kernel.as_constant(value.operands[1]) == Some(0);
            matches!(value.source, Source::Operator(Operator::AtMost, _)) && with_zero
        };
        let asked = kernel.values.iter().position(is_zero);
        let Some(asked) = asked.map(|index| ValueId(index as u32)) else { return false };
        !shows(kernel, &[quotient], &Supposed::from([(asked, true)]))
    }
}

/// True if some output depends on one of the `wrong` values under the assumed Booleans.
fn shows(kernel: &Kernel, wrong: &[ValueId], supposed: &Supposed) -> bool {
    let mut known = HashMap::new();
    kernel.outputs.iter().any(|(_, id)| depends(kernel, *id, wrong, supposed, &mut known))
}

fn depends(
    kernel: &Kernel,
    id: ValueId,
    wrong: &[ValueId],
    supposed: &Supposed,
    known: &mut HashMap<ValueId, bool>,
) -> bool {
    if let Some(&known) = known.get(&id) {
        return known;
    }
    let value = kernel.value(id);
    let answer = if wrong.contains(&id) {
        true
    } else if value.kind == Kind::Bit && truth(kernel, id, supposed).is_some() {
        false
    } else if let (Source::Select, &[condition, yes, no]) = (value.source, value.operands.as_slice()) {
        match truth(kernel, condition, supposed) {
            Some(true) => depends(kernel, yes, wrong, supposed, known),
            Some(false) => depends(kernel, no, wrong, supposed, known),
            // Both cases, each with its consequences.
            None => {
                depends(kernel, condition, wrong, supposed, known)
                    || [(true, yes), (false, no)].into_iter().any(|(chosen, branch)| {
                        let mut supposed = supposed.clone();
                        supposed.insert(condition, chosen);
                        depends(kernel, branch, wrong, &supposed, &mut HashMap::new())
                    })
            }
        }
    } else {
        value.operands.iter().any(|operand| depends(kernel, *operand, wrong, supposed, known))
    };
    known.insert(id, answer);
    answer
}

/// The value of a Boolean, if it follows from the assumptions.
fn truth(kernel: &Kernel, id: ValueId, supposed: &Supposed) -> Option<bool> {
    if let Some(&truth) = supposed.get(&id) {
        return Some(truth);
    }
    let value = kernel.value(id);
    let operand = |position: usize| truth(kernel, value.operands[position], supposed);
    match value.source {
        Source::Constant(bits) => Some(bits != 0),
        Source::Not => operand(0).map(|truth| !truth),
        Source::And => match (operand(0), operand(1)) {
            (Some(false), _) | (_, Some(false)) => Some(false),
            (Some(true), Some(true)) => Some(true),
            _ => None,
        },
        Source::Or => match (operand(0), operand(1)) {
            (Some(true), _) | (_, Some(true)) => Some(true),
            (Some(false), Some(false)) => Some(false),
            _ => None,
        },
        _ => None,
    }
}
