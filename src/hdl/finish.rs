//! From a graph under construction to a module: collects errors, removes dead logic, puts operands before users, and
//! finds loops.

use std::collections::{BTreeSet, HashMap};

use super::error::{BuildErrors, Error};
use super::graph::{Inner, Paths};
use super::instance::Instance;
use super::module::{Memory, Module, Node, NodeId, Op, Start};
use super::share_delays;

pub(super) fn finish(mut inner: Inner) -> Result<Module, BuildErrors> {
    check_connected(&mut inner);
    add_reset_registers(&mut inner);
    if !inner.errors.is_empty() {
        return Err(BuildErrors(inner.errors));
    }
    match order(&mut inner) {
        Ok(order) => Ok(renumber(inner, &order)),
        Err(looped) => {
            let node = &inner.nodes[looped.index()];
            let name = node.name.clone().unwrap_or_else(|| format!("{:?}", node.op));
            let message = format!("combinational loop through `{name}`");
            Err(BuildErrors(vec![Error { module: inner.name, message, place: inner.places[looped.index()] }]))
        }
    }
}

/// The live nodes, operands first; or a node that depends on itself.
fn order(inner: &mut Inner) -> Result<Vec<NodeId>, NodeId> {
    resolve_wires(inner)?;
    let live = Walk::new(inner).order()?;
    if !live.iter().any(|id| matches!(inner.nodes[id.index()].op, Op::Delay { .. })) {
        return Ok(live);
    }
    // Only live delays may lengthen a chain, so each step is followed by another search for live nodes.
    share_delays::collapse(inner, &live);
    let live = Walk::new(inner).order()?;
    share_delays::chain(inner, &live);
    Walk::new(inner).order()
}

fn check_connected(inner: &mut Inner) {
    let mut missing = Vec::new();
    for (node, place) in inner.nodes.iter().zip(&inner.places) {
        if node.operands.is_empty() && matches!(node.op, Op::Wire | Op::Register { .. }) {
            let name = node.name.as_deref().unwrap_or("(unnamed)");
            missing.push((format!("`{name}` is never driven"), *place));
        }
    }
    for (message, place) in missing {
        let module = inner.name.clone();
        inner.errors.push(Error { module, message, place });
    }
}

/// Registers for the resets of a module that resets itself: one for the module's own state and one for each instance,
/// so that each can be placed beside what it resets.
fn add_reset_registers(inner: &mut Inner) {
    let Some(active) = inner.reset else { return };
    let is_reset = inner.nodes.iter().any(Node::is_reset);
    let mut register = |name: String| {
        let op = Op::Register { start: Start::Any, is_copy: true };
        inner.nodes.push(Node { op, width: 1, operands: vec![active], name: Some(name), stage: None });
        inner.places.push(inner.places[active.index()]);
        NodeId(inner.nodes.len() as u32 - 1)
    };
    let own = is_reset.then(|| register("in_reset".to_owned()));
    for instance in inner.instances.iter_mut().filter(|instance| instance.module.has_reset_port()) {
        instance.reset = Some(register(format!("in_reset_{}", instance.name)));
    }
    // All are equal, so any of them says when the module is reset.
    inner.reset = own.or(inner.instances.iter().find_map(|instance| instance.reset)).or(inner.reset);
}

/// Replaces wires by their drivers. An unnamed driver takes the wire's name. Fails with a wire that drives itself.
fn resolve_wires(inner: &mut Inner) -> Result<(), NodeId> {
    let mut target: Vec<NodeId> = (0..inner.nodes.len() as u32).map(NodeId).collect();
    for target in &mut target {
        let wire = *target;
        let (mut end, mut steps) = (wire, 0);
        while inner.nodes[end.index()].op == Op::Wire {
            end = inner.nodes[end.index()].operands[0];
            steps += 1;
            if steps > inner.nodes.len() {
                return Err(end);
            }
        }
        *target = end;
        if end != wire {
            let name = inner.nodes[wire.index()].name.clone();
            let driver = &mut inner.nodes[end.index()];
            if driver.name.is_none() && !matches!(driver.op, Op::Constant(_) | Op::Parameter(_)) {
                driver.name = name;
            }
        }
    }
    inner.redirect(|id| target[id.index()]);
    Ok(())
}

impl Inner {
    /// Replaces every use of a node.
    pub(super) fn redirect(&mut self, to: impl Fn(NodeId) -> NodeId) {
        let operands = self.nodes.iter_mut().flat_map(|node| &mut node.operands);
        let ports = self.ports.iter_mut().filter_map(|port| port.node.as_mut());
        let writes = self.memories.iter_mut().filter_map(|memory| memory.write.as_mut()).flatten();
        let inputs = self.instances.iter_mut().flat_map(Instance::given_mut);
        for id in operands.chain(ports).chain(writes).chain(inputs).chain(&mut self.reset) {
            *id = to(*id);
        }
    }
}

/// Depth-first from the outputs. Registers, delays, memory reads and instances without a combinational path cut it:
/// their inputs are visited later, so that operands come first on every combinational path.
struct Walk<'a> {
    inner: &'a Inner,
    order: Vec<NodeId>,
    state: Vec<State>,
    later: Vec<NodeId>,
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    Open,
    Done,
}

impl<'a> Walk<'a> {
    fn new(inner: &'a Inner) -> Self {
        Self { inner, order: Vec::new(), state: vec![State::New; inner.nodes.len()], later: Vec::new() }
    }

    fn order(mut self) -> Result<Vec<NodeId>, NodeId> {
        let outputs = self.inner.ports.iter().filter(|p| p.output).filter_map(|p| p.node);
        let roots: Vec<_> = outputs.chain(self.inner.reset).collect();
        for root in roots {
            self.visit(root)?;
            while let Some(id) = self.later.pop() {
                self.visit(id)?;
            }
        }
        Ok(self.order)
    }

    /// Iterative, because a digit recurrence is too deep for a thread's stack.
    fn visit(&mut self, root: NodeId) -> Result<(), NodeId> {
        let mut stack = vec![(root, false)];
        while let Some((id, leaving)) = stack.pop() {
            if leaving {
                self.state[id.index()] = State::Done;
                self.order.push(id);
                continue;
            }
            match self.state[id.index()] {
                State::Done => continue,
                State::Open => return Err(id),
                State::New => self.state[id.index()] = State::Open,
            }
            stack.push((id, true));
            let (now, later) = dependencies(self.inner, id);
            self.later.extend(later.into_iter().rev());
            for &operand in now.iter().rev() {
                match self.state[operand.index()] {
                    State::Done => {}
                    State::New => stack.push((operand, false)),
                    State::Open if self.is_ancestor(&stack, operand) => return Err(operand),
                    State::Open => {}
                }
            }
        }
        Ok(())
    }

    fn is_ancestor(&self, stack: &[(NodeId, bool)], id: NodeId) -> bool {
        stack.iter().any(|&(other, leaving)| leaving && other == id)
    }
}

/// The nodes that `id` needs in the same cycle, and the nodes that it needs before the next one.
fn dependencies(inner: &Inner, id: NodeId) -> (Vec<NodeId>, Vec<NodeId>) {
    let node = &inner.nodes[id.index()];
    match node.op {
        Op::Delay { .. } | Op::Register { .. } => (vec![], node.operands.clone()),
        Op::MemoryRead { memory } => {
            let write = inner.memories[memory].write.iter().flatten().copied();
            (vec![], node.operands.iter().copied().chain(write).collect())
        }
        Op::InstanceOutput { instance, port } => {
            let instance = &inner.instances[instance];
            let through = &instance.module.paths[port];
            let (mut now, mut later) = (Vec::new(), Vec::new());
            for (index, input) in instance.inputs.iter().enumerate() {
                if let Some(input) = *input {
                    if through.contains(&index) { now.push(input) } else { later.push(input) }
                }
            }
            later.extend(instance.reset);
            (now, later)
        }
        _ => (node.operands.clone(), vec![]),
    }
}

fn renumber(inner: Inner, order: &[NodeId]) -> Module {
    let new: HashMap<NodeId, NodeId> = order.iter().zip(0..).map(|(&old, index)| (old, NodeId(index))).collect();
    let at = |id: &NodeId| new[id];

    let mut memory_index = HashMap::new();
    let mut instance_index = HashMap::new();
    for id in order {
        match inner.nodes[id.index()].op {
            Op::MemoryRead { memory } => {
                let next = memory_index.len();
                memory_index.entry(memory).or_insert(next);
            }
            Op::InstanceOutput { instance, .. } => {
                let next = instance_index.len();
                instance_index.entry(instance).or_insert(next);
            }
            _ => {}
        }
    }
    let nodes: Vec<Node> = order
        .iter()
        .map(|id| {
            let mut node = inner.nodes[id.index()].clone();
            node.operands = node.operands.iter().map(at).collect();
            match &mut node.op {
                Op::MemoryRead { memory } => *memory = memory_index[memory],
                Op::InstanceOutput { instance, .. } => *instance = instance_index[instance],
                _ => {}
            }
            node
        })
        .collect();

    let mut memories: Vec<(usize, Memory)> = Vec::new();
    for (old, index) in &memory_index {
        let mut memory = inner.memories[*old].clone();
        memory.write = memory.write.map(|write| write.map(|id| at(&id)));
        memories.push((*index, memory));
    }
    memories.sort_by_key(|(index, _)| *index);
    let mut instances: Vec<(usize, Instance)> = Vec::new();
    for (old, index) in &instance_index {
        let mut instance = inner.instances[*old].clone();
        instance.inputs = instance.inputs.iter().map(|input| input.as_ref().map(at)).collect();
        instance.reset = instance.reset.as_ref().map(at);
        instances.push((*index, instance));
    }
    instances.sort_by_key(|(index, _)| *index);

    let mut ports = inner.ports;
    for port in &mut ports {
        port.node = port.node.and_then(|id| new.get(&id).copied());
    }
    let mut module = Module {
        name: inner.name,
        about: inner.about,
        ports,
        parameters: inner.parameters,
        nodes,
        memories: memories.into_iter().map(|(_, memory)| memory).collect(),
        instances: instances.into_iter().map(|(_, instance)| instance).collect(),
        reset: inner.reset.map(|id| new[&id]),
        clock: inner.clock,
        paths: Vec::new(),
        latency: 0,
        primitive: None,
        size: None,
        timing: None,
    };
    module.paths = paths(&module);
    module
}

/// For each output, the inputs it depends on within one cycle.
pub(super) fn paths(module: &Module) -> Paths {
    let mut reach: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); module.nodes.len()];
    let input_of: HashMap<NodeId, usize> = module
        .ports
        .iter()
        .enumerate()
        .filter(|(_, port)| !port.output)
        .filter_map(|(index, port)| port.node.map(|node| (node, index)))
        .collect();
    for id in module.ids() {
        let node = module.node(id);
        let from: Vec<NodeId> = match node.op {
            Op::Delay { .. } | Op::Register { .. } | Op::MemoryRead { .. } => vec![],
            Op::InstanceOutput { instance, port } => {
                let instance = &module.instances[instance];
                instance.module.paths[port].iter().filter_map(|&index| instance.inputs[index]).collect()
            }
            _ => node.operands.clone(),
        };
        let mut all: BTreeSet<usize> = from.iter().flat_map(|id| reach[id.index()].iter().copied()).collect();
        all.extend(input_of.get(&id));
        reach[id.index()] = all;
    }
    let of = |port: &super::module::Port| match port.node {
        Some(node) if port.output => reach[node.index()].clone(),
        _ => BTreeSet::new(),
    };
    module.ports.iter().map(of).collect()
}
