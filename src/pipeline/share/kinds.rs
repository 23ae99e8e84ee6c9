//! Kinds of operations that can take turns in one instance, and the number of instances.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Library;
use super::cost::{area, choice, tables};
use crate::hdl::{BuildErrors, Module};
use crate::operator::Operator;
use crate::pipeline::kernel::{Kernel, Source};
use crate::pipeline::range::{Ranges, Unit};

/// Operations that use the same module.
pub(super) struct Kind {
    /// The unit that computes them.
    pub unit: Unit,
    pub module: Arc<Module>,
    /// The operations, by value.
    pub uses: Vec<usize>,
    pub instances: u32,
}

impl Kind {
    /// True if an instance serves several operations, so that its operands are multiplexed and registered.
    pub fn is_shared(&self) -> bool {
        (self.instances as usize) < self.uses.len()
    }

    /// Cycles from the operands to the result.
    pub fn latency(&self) -> u32 {
        u32::from(self.is_shared()) + self.module.latency
    }
}

/// All kinds of a kernel.
pub(super) struct Kinds {
    pub all: Vec<Kind>,
    /// For each value that is an operator's result and is used, its kind.
    pub of: Vec<Option<usize>>,
    /// True for a second operand whose sign is inverted, so that a difference becomes a sum.
    pub negated: Vec<bool>,
}

impl Kinds {
    /// # Errors
    /// Returns an error if the library cannot build a unit.
    pub fn of(kernel: &Kernel, interval: u32, library: &mut Library<'_>) -> Result<Self, BuildErrors> {
        let units = Ranges::of(kernel).units;
        let live = kernel.live();
        let mut negated = vec![false; units.len()];
        let mut uses: BTreeMap<Unit, Vec<usize>> = BTreeMap::new();
        for (index, unit) in units.into_iter().enumerate().filter(|(index, _)| live[*index]) {
            let Source::Operator(operator, format) = kernel.values[index].source else { continue };
            let (operator, domain) = unit.unwrap_or((operator, format.into()));
            let sum = match operator {
                Operator::Sub => Some(Operator::Add),
                Operator::SubToOdd => Some(Operator::AddToOdd),
                _ => None,
            };
            negated[index] = sum.is_some();
            uses.entry((sum.unwrap_or(operator), domain)).or_default().push(index);
        }
        // Operations that a more general operator can also do.
        for (special, general) in [(Operator::AddMagnitudes, Operator::Add), (Operator::Square, Operator::Mul)] {
            merge(&mut uses, special, general, interval, library)?;
        }
        let mut this = Self { all: Vec::new(), of: vec![None; negated.len()], negated };
        for (unit, mut uses) in uses {
            uses.sort_unstable();
            let mut module = library.module(unit)?;
            let count = uses.len() as u32;
            let mut instances = instances(&module, count, interval);
            if let Some(slow) = library.iterative(unit, interval)?
                && count * area(&slow) < instances * area(&module)
            {
                (module, instances) = (slow, count);
            }
            uses.iter().for_each(|&value| this.of[value] = Some(this.all.len()));
            this.all.push(Kind { unit, module, uses, instances });
        }
        Ok(this)
    }
}

/// As few as the interval allows, unless selecting the operands costs more than the saved operators.
fn instances(module: &Module, uses: u32, interval: u32) -> u32 {
    let fewest = uses.div_ceil(interval);
    let choices: u32 = module.ports.iter().filter(|port| !port.output).map(|port| choice(2, port.width)).sum();
    if choices < tables(module) { fewest } else { uses }
}

/// Merges `special` into `general`, for the same values, if the result is smaller.
fn merge(
    uses: &mut BTreeMap<Unit, Vec<usize>>,
    special: Operator,
    general: Operator,
    interval: u32,
    library: &mut Library<'_>,
) -> Result<(), BuildErrors> {
    let domains: Vec<_> = uses.keys().filter(|unit| unit.0 == special).map(|unit| unit.1).collect();
    for domain in domains {
        let (few, many) = ((special, domain), (general, domain));
        let Some(wide) = uses.get(&many).map(|uses| uses.len() as u32) else { continue };
        let narrow = uses.get(&few).map_or(0, |uses| uses.len() as u32);
        let (small, large) = (tables(&*library.module(few)?), tables(&*library.module(many)?));
        let apart = narrow.div_ceil(interval) * small + wide.div_ceil(interval) * large;
        if (narrow + wide).div_ceil(interval) * large < apart {
            let moved = uses.remove(&few).unwrap_or_default();
            uses.entry(many).or_default().extend(moved);
        }
    }
    Ok(())
}
