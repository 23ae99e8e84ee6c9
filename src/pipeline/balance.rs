//! The cycle of each value of a kernel: as early as possible, with operands delayed so that they meet in the same
//! cycle.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::kernel::{Kernel, Source};
use super::range::{Ranges, Unit};
use crate::hdl::{BuildErrors, Module};
use crate::operator::Operator;

/// The most levels of glue between registers. A level is a two-way selection or a gate. Operators' outputs and inputs
/// are registers.
pub(super) const LONGEST_GLUE: u32 = 3;

/// A time table of a kernel. In cycle 0, the inputs arrive.
pub(super) struct Schedule {
    /// The module of each operator in use.
    pub modules: BTreeMap<Unit, Arc<Module>>,
    /// The unit of each value that is an operator's result.
    pub units: Vec<Option<Unit>>,
    /// The cycle in which each value's operands meet; `None` for dead code and for constants, which are always
    /// available.
    pub start: Vec<Option<u32>>,
    /// The cycle in which each value is available; `None` as above.
    pub ready: Vec<Option<u32>>,
    /// The cycle in which all outputs are available.
    pub latency: u32,
}

impl Schedule {
    /// The times for `kernel`, with operators built by `pipelined`.
    pub fn new(
        kernel: &Kernel,
        mut pipelined: impl FnMut(Unit) -> Result<Arc<Module>, BuildErrors>,
    ) -> Result<Self, BuildErrors> {
        let count = kernel.values.len();
        let mut this = Self {
            modules: BTreeMap::new(),
            units: Ranges::of(kernel).units,
            start: vec![None; count],
            ready: vec![None; count],
            latency: 0,
        };
        // Levels of glue between the last register and the value.
        let mut glue = vec![0_u32; count];
        let live = kernel.live();
        for index in (0..count).filter(|&index| live[index]) {
            let value = &kernel.values[index];
            let arrivals = value.operands.iter().filter_map(|id| Some((this.ready[id.index()]?, glue[id.index()])));
            let registered = arrivals.clone().map(|(ready, glue)| ready + u32::from(glue > 0)).max();
            let at_once = arrivals.clone().map(|(ready, _)| ready).max();
            let (start, latency) = match value.source {
                Source::Constant(_) => continue,
                Source::Input(_) => {
                    let late = kernel.late.iter().find(|(id, _)| id.index() == index);
                    (0, late.map_or(0, |(_, cycles)| *cycles))
                }
                Source::Operator(operator, format) => {
                    let unit = this.units[index].unwrap_or((operator, format.into()));
                    let module = match this.modules.get(&unit) {
                        Some(module) => module,
                        None => {
                            let module = pipelined(unit)?;
                            this.modules.entry(unit).or_insert(module)
                        }
                    };
                    // An operator's inputs come directly from registers.
                    (registered.unwrap_or(0), module.latency)
                }
                Source::Select | Source::And | Source::Or | Source::Not => {
                    let together = at_once.unwrap_or(0);
                    let deepest = arrivals.filter(|(ready, _)| *ready == together).map(|(_, glue)| glue).max();
                    let deepest = deepest.unwrap_or(0);
                    let is_long = deepest >= LONGEST_GLUE;
                    glue[index] = if is_long { 1 } else { deepest + 1 };
                    (together + u32::from(is_long), 0)
                }
            };
            this.start[index] = Some(start);
            this.ready[index] = Some(start + latency);
        }
        this.convert_late(kernel);
        for (_, id) in &kernel.outputs {
            // Outputs are registers.
            let is_register = glue[id.index()] == 0 && matches!(kernel.value(*id).source, Source::Operator(..));
            if let Some(ready) = this.ready[id.index()] {
                this.latency = this.latency.max(ready + u32::from(!is_register));
            }
        }
        Ok(this)
    }

    /// A value that a conversion widens waits unconverted. It is converted when it is first needed.
    fn convert_late(&mut self, kernel: &Kernel) {
        for (index, value) in kernel.values.iter().enumerate() {
            let (Source::Operator(Operator::Convert { to }, from), Some(start), Some(ready)) =
                (value.source, self.start[index], self.ready[index])
            else {
                continue;
            };
            let uses = kernel
                .values
                .iter()
                .zip(&self.start)
                .filter(|(user, _)| user.operands.iter().any(|id| id.index() == index));
            let first = uses.filter_map(|(_, start)| *start).min();
            let is_output = kernel.outputs.iter().any(|(_, id)| id.index() == index);
            if let Some(first) = first.filter(|_| to.width() > from.width() && !is_output) {
                let later = first.saturating_sub(ready);
                self.start[index] = Some(start + later);
                self.ready[index] = Some(ready + later);
            }
        }
    }
}
