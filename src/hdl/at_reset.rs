//! Which levels a module's outputs have in reset: what documentation says of them, read off the module itself.

use super::instance::InstanceCount;
use super::module::{Module, NodeId, Op, Start};

/// A register that is only reset through its next value can follow another such; in this many steps, no more.
const LONGEST: u32 = 32;

/// A module where it is instantiated: there its inputs are values of the module around it.
struct Scope<'a> {
    module: &'a Module,
    outer: Option<(&'a Scope<'a>, usize)>,
    /// The top's input that is held, and its level.
    held: Option<(&'a str, u128)>,
}

impl Module {
    /// The level of an output after some cycles of reset, at the parameters' defaults; `None` if nothing resets it.
    /// `held` is an input that is held at a level meanwhile, if the module resets itself.
    pub(crate) fn at_reset(&self, output: &str, held: Option<(&str, u128)>) -> Option<u128> {
        let (_, port) = self.port(output).filter(|(_, port)| port.output)?;
        Scope { module: self, outer: None, held }.value(port.node?, LONGEST)
    }
}

impl Scope<'_> {
    fn value(&self, id: NodeId, left: u32) -> Option<u128> {
        let left = left.checked_sub(1)?;
        let node = self.module.node(id);
        let mask = u128::MAX.checked_shr(128_u32.checked_sub(node.width)?).unwrap_or(0);
        let of = |position: usize| self.value(*node.operands.get(position)?, left);
        let values = || node.operands.iter().map(|operand| self.value(*operand, left));
        Some(
            mask & match &node.op {
                Op::Constant(value) => *value,
                Op::Parameter(index) => self.module.parameters.get(*index)?.default.into(),
                Op::Register { start: Start::Reset(value), .. } => *value,
                // Reset by what it takes.
                Op::Register { .. } | Op::Delay { .. } | Op::Wire if node.operands.len() == 1 => of(0)?,
                Op::Not => !of(0)?,
                Op::And if values().any(|value| value == Some(0)) => 0,
                Op::And => values().try_fold(mask, |all, value| Some(all & value?))?,
                Op::Or => values().try_fold(0, |any, value| Some(any | value?))?,
                Op::Mux => of(if of(0)? == 0 { 2 } else { 1 })?,
                Op::Case { .. } => of((of(0)? as usize).saturating_add(1).min(node.operands.len() - 1))?,
                Op::Slice { low } => of(0)?.checked_shr(*low)?,
                Op::Concat => {
                    let widths = node.operands.iter().map(|operand| self.module.node(*operand).width);
                    widths
                        .zip(values())
                        .try_fold(0, |whole: u128, (width, value)| Some(whole.checked_shl(width)? | value?))?
                }
                Op::Input => self.input(id, left)?,
                Op::InstanceOutput { instance, port } => {
                    let inner =
                        self.module.instances.get(*instance).filter(|inner| inner.count == InstanceCount::One)?;
                    let scope = Scope { module: &inner.module, outer: Some((self, *instance)), held: None };
                    scope.value(inner.module.ports.get(*port)?.node?, left)?
                }
                _ => return None,
            },
        )
    }

    fn input(&self, id: NodeId, left: u32) -> Option<u128> {
        let index = self.module.ports.iter().position(|port| !port.output && port.node == Some(id))?;
        match self.outer {
            Some((outer, instance)) => outer.value((*outer.module.instances[instance].inputs.get(index)?)?, left),
            None => self.held.filter(|(name, _)| *name == self.module.ports[index].name).map(|(_, level)| level),
        }
    }
}
