//! Turns a kernel with a time table into a module: shared instances, selections before them, and values that wait.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::keep::{Keeper, Phases};
use super::kinds::{Kind, Kinds};
use super::mux::Chooser;
use super::schedule::Plan;
use super::time_table::{Operation, computation, time_table};
use crate::hdl::{BuildErrors, Graph, Module, Register, Signal};
use crate::operator::INPUTS;
use crate::pipeline::emit::chosen;
use crate::pipeline::kernel::{Kernel, Source, ValueId};
use crate::pipeline::names::Names;

/// # Errors
/// Returns the first error that the graph recorded.
pub(super) fn emit(kernel: &Kernel, kinds: &Kinds, plan: &Plan) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new(kernel.name.as_str());
    kernel.about.iter().for_each(|line| graph.about(line.as_str()));
    let Plan { interval, latency, .. } = *plan;
    graph.about(format!("{latency} cycles from inputs to outputs, new inputs every {interval} cycles"));
    graph.about(format!("take comes a cycle before new inputs, which stay for {interval} cycles"));
    graph.about(format!("every later take is a multiple of {interval} cycles after the first"));
    let take = graph.input("take", 1);
    let mut emitter = Emitter {
        kernel,
        kinds,
        plan,
        graph: &graph,
        phases: Phases::new(&graph, interval, take),
        names: Names::new(kernel),
        values: vec![None; kernel.values.len()],
        units: BTreeMap::new(),
    };
    emitter.emit();
    let mut module = graph.finish()?;
    Arc::make_mut(&mut module).latency = latency;
    Ok(module)
}

/// The input of an iterative operator.
const PHASE: &str = "phase";

/// An instance that serves several operations.
struct Shared<'g> {
    instance: usize,
    name: String,
    operands: Vec<Register<'g>>,
    result: Signal<'g>,
}

struct Emitter<'a, 'g> {
    kernel: &'a Kernel,
    kinds: &'a Kinds,
    plan: &'a Plan,
    graph: &'g Graph,
    phases: Phases<'g>,
    names: Names,
    values: Vec<Option<Keeper<'g>>>,
    /// The instances that compute one value each.
    units: BTreeMap<usize, String>,
}

impl<'g> Emitter<'_, 'g> {
    fn emit(&mut self) {
        let inputs = self.kernel.inputs.iter();
        let inputs: Vec<_> =
            inputs.map(|(name, id)| (*id, self.graph.input(name, self.kernel.value(*id).kind.width()))).collect();
        let shared = self.shared();
        for (index, wanted) in self.plan.wanted(self.kernel).iter().enumerate() {
            let Some(ready) = self.plan.ready[index] else { continue };
            let id = ValueId(index as u32);
            let result = || shared.iter().find(|of| Some(of.instance) == self.plan.instance[index]).map(|of| of.result);
            let input = || inputs.iter().find(|(input, _)| *input == id).map(|(_, signal)| *signal);
            let Some(signal) = result().or_else(input).or_else(|| self.compute(id)) else { continue };
            let name = self.names.signal(id).map_or_else(|| format!("value_{index}"), str::to_owned);
            let times = [ready, self.plan.stays(self.kernel, index)];
            self.values[index] = Some(Keeper::new(&mut self.phases, &name, signal, times, wanted));
        }
        let mut chooser = Chooser::new(self.graph);
        shared.iter().for_each(|instance| self.connect(&mut chooser, instance));
        self.describe(&shared);
        for (name, id) in &self.kernel.outputs {
            if let Some(signal) = self.at(*id, self.plan.latency) {
                self.graph.output(name, signal);
            }
        }
    }

    /// Writes the time table into the header.
    fn describe(&self, shared: &[Shared<'g>]) {
        let unit = |index: usize| {
            let shared = shared.iter().find(|of| Some(of.instance) == self.plan.instance[index]);
            shared.map(|of| of.name.clone()).or_else(|| self.units.get(&index).cloned())
        };
        let operations = (0..self.kernel.values.len()).filter_map(|index| {
            let (start, unit) = (self.plan.start[index]?, unit(index)?);
            Some(Operation { cycle: start, unit, computes: computation(self.kernel, &self.names, index) })
        });
        time_table(self.plan.interval, operations.collect()).into_iter().for_each(|line| self.graph.about(line));
    }

    fn kind(&self, instance: usize) -> &Kind {
        &self.kinds.all[self.plan.instances[instance].kind]
    }

    /// Instances with registers before them. They are not connected yet, because results come back as operands.
    fn shared(&self) -> Vec<Shared<'g>> {
        let mut made: Vec<Shared<'g>> = Vec::new();
        for (instance, of) in self.plan.instances.iter().enumerate() {
            let kind = self.kind(instance);
            if !kind.is_shared() || of.places.iter().all(Option::is_none) {
                continue;
            }
            let operator = kind.unit.0.name();
            let alike = self.plan.instances[..instance].iter();
            let number = alike.filter(|other| self.kinds.all[other.kind].unit.0.name() == operator).count();
            let name = format!("{operator}_unit_{number}");
            let ports: Vec<&str> = INPUTS[..kind.unit.0.operands()].to_vec();
            let width = |port: &str| kind.module.port(port).map_or(1, |(_, port)| port.width);
            let operands: Vec<_> =
                ports.iter().map(|port| self.graph.data_register(&format!("{name}_{port}"), width(port))).collect();
            let inputs: Vec<_> = ports.into_iter().zip(operands.iter().map(|register| register.value())).collect();
            let result = self.graph.instance(&name, &kind.module, &inputs).output("result");
            let result = result.named(&format!("{name}_result"));
            made.push(Shared { instance, name, operands, result });
        }
        made
    }

    /// Connects an instance to the operands of each phase.
    fn connect(&self, chooser: &mut Chooser<'g>, shared: &Shared<'g>) {
        let places = &self.plan.instances[shared.instance].places;
        for (position, register) in shared.operands.iter().enumerate() {
            let mut signals: Vec<(Signal<'g>, String)> = Vec::new();
            let mut by_phase = vec![None; places.len()];
            for (phase, index) in places.iter().enumerate() {
                let Some(index) = *index else { continue };
                let Some(start) = self.plan.start[index] else { continue };
                let id = self.operand(index, position);
                let negated = position == 1 && self.kinds.negated[index];
                let Some(signal) = self.at(id, start) else { continue };
                let signal = if negated { self.negate(id, signal) } else { signal };
                let note = format!("phase {phase}: {}", computation(self.kernel, &self.names, index));
                let at = signals.iter().position(|(other, _)| other.is_same(signal));
                match at {
                    Some(at) => signals[at].1 += &format!("; {note}"),
                    None => signals.push((signal, note)),
                }
                by_phase[phase] = Some(at.unwrap_or(signals.len() - 1));
            }
            if let Some(chosen) = chooser.choose(&self.phases, &by_phase, &signals) {
                register.next(chosen);
            }
        }
    }

    /// The single operand of a square is both operands of a product.
    fn operand(&self, index: usize, position: usize) -> ValueId {
        let operands = &self.kernel.values[index].operands;
        operands[position.min(operands.len() - 1)]
    }

    /// The number with the opposite sign. A unit's result is named after the unit, because it is not always this value.
    fn negate(&self, id: ValueId, number: Signal<'g>) -> Signal<'g> {
        let opposite = (!number.msb()).concat(number.low(number.width() - 1));
        match number.name().or_else(|| self.names.signal(id).map(str::to_owned)) {
            Some(name) => opposite.named(&format!("minus_{name}")),
            None => opposite,
        }
    }

    fn at(&self, id: ValueId, cycle: u32) -> Option<Signal<'g>> {
        let value = self.kernel.value(id);
        if let Source::Constant(bits) = value.source {
            return Some(self.graph.constant(value.kind.width(), bits));
        }
        self.values[id.index()].as_ref()?.at(cycle)
    }

    /// A value without a shared instance, from operands that meet when it begins.
    fn compute(&mut self, id: ValueId) -> Option<Signal<'g>> {
        let value = self.kernel.value(id);
        let start = self.plan.start[id.index()]?;
        let operands = value.operands.iter().map(|id| self.at(*id, start)).collect::<Option<Vec<_>>>()?;
        let signal = match (value.source, operands.as_slice()) {
            (Source::Operator(operator, _), _) => {
                let kind = self.kind(self.plan.instance[id.index()]?);
                let ports = &INPUTS[..kind.unit.0.operands()];
                let last = operands.len() - 1;
                let operand = |position: usize| {
                    let signal = operands[position.min(last)];
                    if position == 1 && self.kinds.negated[id.index()] {
                        self.negate(value.operands[position.min(last)], signal)
                    } else {
                        signal
                    }
                };
                let inputs: Vec<_> = ports.iter().enumerate().map(|(index, port)| (*port, operand(index))).collect();
                let mut inputs = inputs;
                let module = kind.module.clone();
                if module.port(PHASE).is_some() {
                    inputs.push((PHASE, self.phases.since(start)));
                }
                let name = self.names.instance(id, operator);
                self.units.insert(id.index(), name.clone());
                self.graph.instance(&name, &module, &inputs).output("result")
            }
            (source, operands) => chosen(source, operands)?,
        };
        Some(match self.names.signal(id) {
            Some(name) => signal.named(name),
            None => signal,
        })
    }
}
