//! Turns a scheduled kernel into a module: operators are instances, with delays for values that wait.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::balance::Schedule;
use super::kernel::{Kernel, Source, ValueId};
use super::names::Names;
use crate::hdl::{BuildErrors, DelayModel, Graph, Module, Node, NodeId, Op, Signal, delay_block};
use crate::operator::{INPUTS, pipelined};

impl Kernel {
    /// The kernel as a pipeline that takes new inputs in every cycle, with operators cut for `clock_mhz`. All outputs
    /// come from registers, in the same cycle. Values that no output needs are not built, but all inputs remain as
    /// ports.
    ///
    /// # Errors
    /// Returns the first error that a graph recorded, or an error if an operator cannot be cut for the clock.
    pub fn pipeline(&self, model: &DelayModel, clock_mhz: f64) -> Result<Arc<Module>, BuildErrors> {
        let kernel = &self.with_widening_sums();
        let schedule = Schedule::new(kernel, |(operator, domain)| pipelined(operator, domain, model, clock_mhz))?;
        let graph = Graph::new(kernel.name.as_str());
        kernel.about.iter().for_each(|line| graph.about(line.as_str()));
        graph.about(format!("{} cycles from inputs to outputs, new inputs in every cycle", schedule.latency));
        let (names, signals) = (Names::new(kernel), vec![None; kernel.values.len()]);
        let waiting = BTreeMap::new();
        Emitter { kernel, schedule: &schedule, graph: &graph, names, signals, model, waiting }.emit()?;
        let mut module = graph.finish()?;
        let inner = Arc::make_mut(&mut module);
        inner.latency = schedule.latency;
        note_stages(inner);
        Ok(module)
    }
}

struct Emitter<'a, 'g> {
    kernel: &'a Kernel,
    schedule: &'a Schedule,
    graph: &'g Graph,
    names: Names,
    /// Values in the cycle in which they are computed.
    signals: Vec<Option<Signal<'g>>>,
    model: &'a DelayModel,
    /// Values delayed to a cycle by block memories.
    waiting: BTreeMap<(ValueId, u32), Signal<'g>>,
}

impl<'g> Emitter<'_, 'g> {
    fn emit(&mut self) -> Result<(), BuildErrors> {
        for (name, id) in &self.kernel.inputs {
            self.signals[id.index()] = Some(self.graph.input(name, self.kernel.value(*id).kind.width()));
        }
        for (index, value) in self.kernel.values.iter().enumerate() {
            if let Source::Constant(bits) = value.source {
                self.signals[index] = Some(self.graph.constant(value.kind.width(), bits));
            } else if let Some(start) = self.schedule.start[index]
                && self.signals[index].is_none()
            {
                self.signals[index] = self.compute(ValueId(index as u32), start)?;
            }
        }
        for (name, id) in &self.kernel.outputs {
            if let Some(signal) = self.at(*id, self.schedule.latency)? {
                self.graph.output(name, signal);
            }
        }
        Ok(())
    }

    /// The value delayed to `cycle`, at or after the cycle in which it is computed. The graph makes one chain of a
    /// value's delays, except for those that fill a block memory.
    fn at(&mut self, id: ValueId, cycle: u32) -> Result<Option<Signal<'g>>, BuildErrors> {
        let Some(signal) = self.signals[id.index()] else { return Ok(None) };
        if let Some(known) = self.waiting.get(&(id, cycle)) {
            return Ok(Some(*known));
        }
        let waits = cycle - self.schedule.ready[id.index()].unwrap_or(cycle);
        let is_constant = signal.as_constant().is_some();
        let Some(block) = delay_block(waits, signal.width(), self.model)?.filter(|_| !is_constant) else {
            return Ok(Some(signal.delay(waits)));
        };
        let what = self.names.signal(id).map_or_else(|| format!("value_{}", id.index()), str::to_owned);
        let instance = self.graph.instance(&format!("{what}_waits_{waits}"), &block, &[("value", signal)]);
        let waiting = instance.output("delayed");
        self.waiting.insert((id, cycle), waiting);
        Ok(Some(waiting))
    }

    /// The value, from operands that meet in cycle `start`.
    fn compute(&mut self, id: ValueId, start: u32) -> Result<Option<Signal<'g>>, BuildErrors> {
        let value = self.kernel.value(id);
        let operands = value.operands.iter().map(|id| self.at(*id, start)).collect::<Result<Option<Vec<_>>, _>>()?;
        let Some(operands) = operands else { return Ok(None) };
        let name = self.names.signal(id).map(str::to_owned);
        let signal = match (value.source, operands.as_slice()) {
            (Source::Operator(operator, format), _) => {
                let unit = self.schedule.units[id.index()].unwrap_or((operator, format.into()));
                let module = &self.schedule.modules[&unit];
                let ports: Vec<_> = INPUTS.into_iter().zip(operands).collect();
                let instance = self.names.instance(id, operator);
                self.graph.instance(&instance, module, &ports).output("result")
            }
            (source, operands) => match chosen(source, operands) {
                Some(signal) => signal,
                None => return Ok(None),
            },
        };
        Ok(Some(match name {
            Some(name) => signal.named(&name),
            None => signal,
        }))
    }
}

/// A choice between values, or logic.
pub(super) fn chosen<'g>(source: Source, operands: &[Signal<'g>]) -> Option<Signal<'g>> {
    Some(match (source, operands) {
        (Source::Select, &[condition, yes, no]) => match (yes.as_constant(), no.as_constant()) {
            (_, Some(0)) => yes.gate(condition),
            (Some(0), _) => no.gate(!condition),
            _ => condition.select(yes, no),
        },
        (Source::And, &[a, b]) => a & b,
        (Source::Or, &[a, b]) => a | b,
        (Source::Not, &[a]) => !a,
        _ => return None,
    })
}

/// Records the cycle of each node, for the names of delays.
fn note_stages(module: &mut Module) {
    // A node that feeds an instance or a delay may come after it, so this takes as many rounds as there are ranks of
    // them.
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for index in 0..module.nodes.len() {
            let stage = stage(module, &module.nodes[index]);
            changed |= stage != module.nodes[index].stage;
            module.nodes[index].stage = stage;
        }
    }
}

fn stage(module: &Module, node: &Node) -> Option<u32> {
    let latest = |ids: &mut dyn Iterator<Item = NodeId>| ids.filter_map(|id| module.node(id).stage).max();
    match node.op {
        Op::Input => Some(0),
        Op::Delay { cycles } => Some(latest(&mut node.operands.iter().copied())? + cycles),
        Op::InstanceOutput { instance, .. } => {
            let instance = &module.instances[instance];
            Some(latest(&mut instance.inputs.iter().flatten().copied())? + instance.module.latency)
        }
        _ => latest(&mut node.operands.iter().copied()),
    }
}
