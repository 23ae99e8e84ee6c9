//! A kernel that takes a pair every few cycles: operators of one kind share as few instances as the interval allows.
//!
//! A pair's operations are placed once, by list scheduling modulo the interval. An operation that begins in cycle t
//! takes its instance's place in phase t mod II. Pairs arrive a multiple of II cycles apart, so no other pair ever
//! needs that place. (B. R. Rau, "Iterative modulo scheduling", 1994. There is no recurrence here, so no placement is
//! ever undone.) A value that waits is stored once in II cycles and not shifted in every cycle, which is what saves
//! area.

mod cost;
mod emit;
mod keep;
mod kinds;
#[cfg(test)]
mod legality;
mod mux;
mod schedule;
mod time_table;

use std::collections::BTreeMap;
use std::sync::Arc;

use kinds::Kinds;
use schedule::Plan;

use super::kernel::Kernel;
use super::range::Unit;
use crate::hdl::{BuildErrors, DelayModel, Module};
use crate::operator::{iterative, pipelined};

/// Builds each operator's module once.
struct Library<'a> {
    model: &'a DelayModel,
    clock_mhz: f64,
    modules: BTreeMap<Unit, Arc<Module>>,
}

impl Library<'_> {
    /// The iterative unit that takes one number per interval and is smaller, if there is one.
    fn iterative(&self, unit: Unit, interval: u32) -> Result<Option<Arc<Module>>, BuildErrors> {
        iterative(unit.0, unit.1, self.model, self.clock_mhz, interval, cost::area)
    }

    fn module(&mut self, unit: Unit) -> Result<Arc<Module>, BuildErrors> {
        if let Some(module) = self.modules.get(&unit) {
            return Ok(module.clone());
        }
        let module = pipelined(unit.0, unit.1, self.model, self.clock_mhz)?;
        self.modules.insert(unit, module.clone());
        Ok(module)
    }
}

impl Kernel {
    /// The kernel as a pipeline that takes new inputs every `interval` ≥ 2 cycles, with operators cut for `clock_mhz`.
    ///
    /// It has one more input, `take`, which is set in the cycle before new inputs arrive. They arrive a multiple of
    /// `interval` cycles after the previous ones, since the last reset, and stay for `interval` cycles. Outputs are
    /// valid for one cycle, [`Module::latency`] cycles after the first cycle of the inputs.
    ///
    /// # Errors
    /// Returns the first error that a graph recorded, or an error if an operator cannot be cut for the clock.
    pub fn pipeline_every(
        &self,
        model: &DelayModel,
        clock_mhz: f64,
        interval: u32,
    ) -> Result<Arc<Module>, BuildErrors> {
        let interval = interval.max(2);
        let mut library = Library { model, clock_mhz, modules: BTreeMap::new() };
        let kinds = Kinds::of(self, interval, &mut library)?;
        let plan = Plan::new(self, &kinds, interval);
        emit::emit(self, &kinds, &plan)
    }
}
