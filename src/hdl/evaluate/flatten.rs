//! A hierarchy of modules as one flat graph. Ports and instance outputs become links between nodes, chains become
//! copies, and nodes are ordered so that operands come first.

use std::sync::Arc;

use super::EvaluateError;
use crate::hdl::instance::{InstanceCount, next_in_chain};
use crate::hdl::module::{Module, Node, NodeId, Op};

/// A node of one instance: its scope's `base` plus its index in the module.
pub(super) type FlatId = usize;

/// One instance of a module.
#[derive(Debug)]
pub(super) struct Scope {
    pub module: Arc<Module>,
    /// The hierarchical name followed by a dot; empty for the top.
    pub path: String,
    pub base: FlatId,
    /// The values of its parameters.
    pub parameters: Vec<u32>,
    /// Index of its first memory in the list of all memories.
    pub memories: usize,
}

/// The source of a node's value.
#[derive(Clone, Debug)]
pub(super) enum Link {
    /// It is computed from its operands.
    Own,
    /// It is the same value as another node.
    Alias(FlatId),
    /// It is the number of a copy in a chain.
    Number(u32),
    /// It is this port of the top.
    Pin(usize),
}

#[derive(Debug)]
pub(super) struct Flat {
    pub scopes: Vec<Scope>,
    /// For each flat node, its scope.
    pub scope_of: Vec<u32>,
    pub links: Vec<Link>,
    /// Memories in all scopes together.
    pub memories: usize,
}

impl Flat {
    /// Flattens `top` with these parameter values.
    pub(super) fn new(top: &Arc<Module>, parameters: Vec<u32>) -> Self {
        let mut flat = Self { scopes: Vec::new(), scope_of: Vec::new(), links: Vec::new(), memories: 0 };
        let scope = flat.open(top, String::new(), parameters);
        for (index, port) in top.ports.iter().enumerate() {
            if let (false, Some(node)) = (port.output, port.node) {
                flat.links[node.index()] = Link::Pin(index);
            }
        }
        flat.fill(scope);
        flat
    }

    /// The parameters of a module instantiated in a scope: the scope's parameters of the same name, otherwise the
    /// defaults.
    fn inherited(&self, scope: usize, module: &Module) -> Vec<u32> {
        let Scope { module: parent, parameters, .. } = &self.scopes[scope];
        let value = |name: &str| parent.parameters.iter().position(|p| p.name == name).map(|index| parameters[index]);
        let mut values: Vec<u32> = module.parameters.iter().map(|p| value(&p.name).unwrap_or(p.default)).collect();
        super::round_parameters(module, &mut values);
        values
    }

    fn open(&mut self, module: &Arc<Module>, path: String, parameters: Vec<u32>) -> usize {
        let scope = self.scopes.len();
        let base = self.links.len();
        self.scopes.push(Scope { module: module.clone(), path, base, parameters, memories: self.memories });
        self.memories += module.memories.len();
        self.links.resize(base + module.nodes.len(), Link::Own);
        self.scope_of.resize(base + module.nodes.len(), scope as u32);
        scope
    }

    /// Opens the instances in a scope and links them with it. The recursion is as deep as the hierarchy, which is never
    /// deep.
    fn fill(&mut self, scope: usize) {
        let module = self.scopes[scope].module.clone();
        let base = self.scopes[scope].base;
        let mut children = Vec::with_capacity(module.instances.len());
        for instance in &module.instances {
            let (copies, chained) = match instance.count {
                InstanceCount::One => (1, false),
                InstanceCount::Parameter(index) => (self.scopes[scope].parameters[index], true),
            };
            let mut opened = Vec::new();
            for copy in 0..copies {
                let suffix = if chained { format!("[{copy}]") } else { String::new() };
                let path = format!("{}{}{suffix}.", self.scopes[scope].path, instance.name);
                let parameters = self.inherited(scope, &instance.module);
                let child = self.open(&instance.module, path, parameters);
                let child_base = self.scopes[child].base;
                for (port, source) in instance.module.ports.iter().zip(&instance.inputs) {
                    let (Some(node), false) = (port.node, port.output) else { continue };
                    self.links[child_base + node.index()] = match source {
                        Some(source) => Link::Alias(base + source.index()),
                        None => Link::Number(copy),
                    };
                }
                if let Some(before) = opened.last() {
                    let ports = &instance.module.ports;
                    for output in (0..ports.len()).filter(|port| ports[*port].output) {
                        let next = next_in_chain(&instance.module, output).and_then(|next| ports[next].node);
                        if let (Some(from), Some(into)) = (ports[output].node, next) {
                            self.links[child_base + into.index()] = Link::Alias(before + from.index());
                        }
                    }
                }
                self.fill(child);
                opened.push(child_base);
            }
            children.push(opened);
        }
        for id in module.ids() {
            let node = module.node(id);
            match node.op {
                Op::Wire => self.links[base + id.index()] = Link::Alias(base + node.operands[0].index()),
                Op::InstanceOutput { instance, port } => {
                    let Some(source) = module.instances[instance].module.ports[port].node else { continue };
                    if let Some(last) = children[instance].last() {
                        self.links[base + id.index()] = Link::Alias(last + source.index());
                    }
                }
                _ => {}
            }
        }
    }

    pub(super) fn scope(&self, id: FlatId) -> &Scope {
        &self.scopes[self.scope_of[id] as usize]
    }

    pub(super) fn node(&self, id: FlatId) -> &Node {
        let scope = self.scope(id);
        &scope.module.nodes[id - scope.base]
    }

    /// Ids of nodes of the same scope as `id`.
    pub(super) fn beside<'a>(&self, id: FlatId, nodes: &'a [NodeId]) -> impl Iterator<Item = FlatId> + use<'a> {
        let base = self.scope(id).base;
        nodes.iter().map(move |node| base + node.index())
    }

    fn name(&self, id: FlatId) -> String {
        let node = self.node(id);
        let name = node.name.clone().unwrap_or_else(|| format!("{:?}", node.op));
        format!("{}{name}", self.scope(id).path)
    }

    /// The `k`-th value that `id` needs in the same cycle, or `None`.
    fn operand(&self, id: FlatId, k: usize) -> Option<FlatId> {
        match &self.links[id] {
            Link::Own => {
                let node = self.node(id);
                let operands = if is_state(&node.op) { &[][..] } else { &node.operands[..] };
                Some(self.scope(id).base + operands.get(k)?.index())
            }
            Link::Alias(source) => (k == 0).then_some(*source),
            Link::Number(_) | Link::Pin(_) => None,
        }
    }

    /// The nodes that `roots` and the state behind them need, operands first.
    ///
    /// # Errors
    /// A combinational loop, which may run through several modules.
    pub(super) fn order(&self, roots: impl IntoIterator<Item = FlatId>) -> Result<Vec<FlatId>, EvaluateError> {
        #[derive(Clone, Copy, PartialEq)]
        enum Mark {
            New,
            Open,
            Done,
        }
        let mut marks = vec![Mark::New; self.links.len()];
        let mut order = Vec::new();
        let mut roots: Vec<FlatId> = roots.into_iter().collect();
        let mut stack: Vec<(FlatId, usize)> = Vec::new();
        while let Some(root) = roots.pop() {
            if marks[root] == Mark::New {
                marks[root] = Mark::Open;
                stack.push((root, 0));
            }
            while let Some((id, k)) = stack.last_mut() {
                let id = *id;
                match self.operand(id, *k) {
                    Some(operand) => {
                        *k += 1;
                        match marks[operand] {
                            Mark::Done => {}
                            Mark::Open => return Err(self.looped(&stack, operand)),
                            Mark::New => {
                                marks[operand] = Mark::Open;
                                stack.push((operand, 0));
                            }
                        }
                    }
                    None => {
                        marks[id] = Mark::Done;
                        order.push(id);
                        stack.pop();
                        if let (Link::Own, node) = (&self.links[id], self.node(id))
                            && is_state(&node.op)
                        {
                            roots.extend(self.beside(id, &node.operands));
                            if let Op::MemoryRead { memory } = node.op {
                                let write = &self.scope(id).module.memories[memory].write;
                                roots.extend(write.iter().flat_map(|write| self.beside(id, write)));
                            }
                        }
                    }
                }
            }
        }
        Ok(order)
    }

    fn looped(&self, stack: &[(FlatId, usize)], start: FlatId) -> EvaluateError {
        let begin = stack.iter().position(|(id, _)| *id == start).unwrap_or(0);
        let ids: Vec<FlatId> = stack[begin..].iter().map(|(id, _)| *id).collect();
        let named: Vec<_> = ids.iter().copied().filter(|&id| self.node(id).name.is_some()).collect();
        let shown = if named.is_empty() { ids } else { named };
        EvaluateError::Loop(shown.into_iter().map(|id| self.name(id)).collect())
    }
}

/// True if a value is held from one clock edge to the next.
pub(super) fn is_state(op: &Op) -> bool {
    matches!(op, Op::Delay { .. } | Op::Register { .. } | Op::MemoryRead { .. })
}
