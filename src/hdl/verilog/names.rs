//! Decides which nodes are declared, and their names.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::super::keywords::keywords;
use super::super::module::{Module, Node, NodeId, Op};

/// A derived name longer than this is cut back to its first part.
const LONGEST_DERIVED: usize = 36;

/// Properties of each node before text is made.
pub(super) struct Names {
    /// The declared name, `None` for what is written in place.
    pub declared: Vec<Option<String>>,
    /// True if the name is that of an output port, so that the port is the declaration.
    pub is_port: Vec<bool>,
}

impl Names {
    pub fn of(module: &Module, reserved: &[&str]) -> Self {
        let mut taken: HashSet<String> = reserved.iter().map(|name| (*name).to_owned()).collect();
        taken.extend(keywords().map(str::to_owned));
        taken.extend(module.ports.iter().map(|port| port.name.clone()));
        taken.extend(module.parameters.iter().map(|parameter| parameter.name.clone()));
        taken.extend(module.memories.iter().map(|memory| memory.name.clone()));
        taken.extend(module.instances.iter().map(|instance| instance.name.clone()));
        let mut names = Self { declared: vec![None; module.nodes.len()], is_port: vec![false; module.nodes.len()] };
        names.take_port_names(module);
        let uses = Uses::count(module);
        let next_of = next_values(module);
        for id in module.ids() {
            let index = id.index();
            let node = module.node(id);
            if names.declared[index].is_some() || !uses.needs_name(module, id) {
                continue;
            }
            let next = next_of.get(&id).map(|register| format!("{register}_next"));
            let wanted = node.name.clone().or(next).unwrap_or_else(|| names.derive(module, id));
            let name = unique(&taken, wanted);
            taken.insert(name.clone());
            names.declared[index] = Some(name);
        }
        names
    }

    /// Inputs are their ports; an output port is the declaration of the node that drives it, where that node has no
    /// other name.
    fn take_port_names(&mut self, module: &Module) {
        for port in &module.ports {
            let Some(id) = port.node else { continue };
            let node = module.node(id);
            let constant = matches!(node.op, Op::Input | Op::Constant(_) | Op::Parameter(_) | Op::Lookup(_));
            let free = self.declared[id.index()].is_none();
            let fits = node.name.as_ref().is_none_or(|name| *name == port.name);
            if !port.output {
                self.declared[id.index()] = Some(port.name.clone());
            } else if !constant && free && fits {
                self.declared[id.index()] = Some(port.name.clone());
                self.is_port[id.index()] = true;
            }
        }
    }

    /// A name that says what the value is.
    fn derive(&self, module: &Module, id: NodeId) -> String {
        let node = module.node(id);
        if let Op::Delay { .. } = node.op {
            return self.delayed(module, id);
        }
        let part = |position: usize| self.short(module, node.operands[position]);
        let two = |word: &str| join(&part(0), word, &part(1));
        match &node.op {
            Op::Not => format!("not_{}", part(0)),
            Op::And => two("and"),
            Op::Or => two("or"),
            Op::Xor => two("xor"),
            Op::Add => two("plus"),
            Op::Sub => two("minus"),
            Op::SubAdd => two("minus_or_plus"),
            Op::Mul => two("times"),
            Op::Equal => two("equals"),
            Op::Less => two("below"),
            Op::Mux => match module.node(node.operands[1]).op {
                Op::Constant(_) => join(&part(2), "unless", &part(0)),
                _ => join(&part(1), "if", &part(0)),
            },
            Op::Slice { low } => format!("{}_{}_{low}", part(0), low + node.width - 1),
            Op::OneHot => format!("{}_one_hot", part(0)),
            Op::Lookup(_) => format!("{}_word", part(0)),
            Op::Any => format!("{}_any", part(0)),
            Op::All => format!("{}_all", part(0)),
            Op::Concat => {
                let first = node.operands.iter().find(|id| !matches!(module.node(**id).op, Op::Constant(_)));
                first.map_or_else(|| "constant".to_owned(), |id| format!("{}_wide", self.short(module, *id)))
            }
            Op::MemoryRead { memory } => format!("{}_word", module.memories[*memory].name),
            Op::InstanceOutput { instance, port } => {
                let instance = &module.instances[*instance];
                format!("{}_{}", instance.name, instance.module.ports[*port].name)
            }
            Op::Register { .. } => "state".to_owned(),
            Op::Parameter(index) => format!("{}_value", module.parameters[*index].name.to_lowercase()),
            Op::Input | Op::Constant(_) | Op::Wire | Op::Delay { .. } => "value".to_owned(),
        }
    }

    /// A delayed value is its source's name and the stage it has come to, or the cycles it has waited.
    fn delayed(&self, module: &Module, id: NodeId) -> String {
        let (mut root, mut total) = (id, 0);
        while let Op::Delay { cycles } = module.node(root).op {
            total += cycles;
            root = module.node(root).operands[0];
        }
        let base = self.short(module, root);
        match stage(module, id) {
            Some(stage) => format!("{base}_s{stage}"),
            None => format!("{base}_d{total}"),
        }
    }

    fn short(&self, module: &Module, id: NodeId) -> String {
        let node = module.node(id);
        if let Some(name) = self.declared[id.index()].as_ref().or(node.name.as_ref()) {
            return name.clone();
        }
        match node.op {
            Op::Constant(value) => format!("{value}"),
            _ => self.derive(module, id),
        }
    }
}

/// Values that only a named register uses.
fn next_values(module: &Module) -> HashMap<NodeId, &str> {
    let registers = module.nodes.iter().filter(|node| matches!(node.op, Op::Register { .. }));
    registers.filter_map(|node| Some((node.operands[0], node.name.as_deref()?))).collect()
}

/// The stage in which a value is available. Each rank of registers adds one.
pub(super) fn stage(module: &Module, id: NodeId) -> Option<u32> {
    let node: &Node = module.node(id);
    match node.op {
        Op::Delay { cycles } if node.stage.is_none() => Some(stage(module, node.operands[0])? + cycles),
        Op::Input if module.nodes.iter().any(|n| n.stage.is_some()) => Some(node.stage.unwrap_or(0)),
        _ => node.stage,
    }
}

fn join(left: &str, word: &str, right: &str) -> String {
    let whole = format!("{left}_{word}_{right}");
    if whole.len() <= LONGEST_DERIVED {
        return whole;
    }
    let cut: String = left.chars().take(LONGEST_DERIVED).collect();
    format!("{}_{word}", cut.trim_end_matches('_'))
}

/// Two values of one name are distinguished by a number: the only counter in a name.
fn unique(taken: &HashSet<String>, wanted: String) -> String {
    let wanted = if wanted.starts_with(|c: char| c.is_ascii_digit()) { format!("n{wanted}") } else { wanted };
    if !taken.contains(&wanted) {
        return wanted;
    }
    let mut number = 2;
    loop {
        let name = format!("{wanted}_{number}");
        if !taken.contains(&name) {
            return name;
        }
        number += 1;
    }
}

/// The number of uses of each node, and whether a use needs an identifier.
struct Uses {
    count: Vec<u32>,
    sliced: Vec<bool>,
    size: Vec<u32>,
}

/// An expression of more than this many operators gets a name, so that lines stay readable.
const LARGEST_INLINE: u32 = 9;

impl Uses {
    fn count(module: &Module) -> Self {
        let nodes = module.nodes.len();
        let mut uses = Self { count: vec![0; nodes], sliced: vec![false; nodes], size: vec![0; nodes] };
        let memory_ports = module.memories.iter().filter_map(|m| m.write).flatten();
        let instance_inputs = module.instances.iter().flat_map(|i| i.inputs.iter().flatten().copied());
        let outputs = module.ports.iter().filter(|p| p.output).filter_map(|p| p.node);
        for id in memory_ports.chain(instance_inputs).chain(outputs).chain(module.reset) {
            uses.count[id.index()] += 1;
        }
        for node in &module.nodes {
            let mut seen = HashSet::new();
            for operand in &node.operands {
                // Repetition inside one concatenation is written once.
                if !matches!(node.op, Op::Concat) || seen.insert(*operand) {
                    uses.count[operand.index()] += 1;
                }
                if matches!(node.op, Op::Slice { .. }) {
                    uses.sliced[operand.index()] = true;
                }
            }
        }
        for id in module.ids() {
            let inline =
                |operand: &NodeId| if uses.needs_name(module, *operand) { 0 } else { uses.size[operand.index()] };
            let operands: BTreeSet<_> = module.node(id).operands.iter().collect();
            let below: u32 = operands.into_iter().map(inline).sum();
            uses.size[id.index()] = match module.node(id).op {
                Op::Slice { .. } | Op::Constant(_) | Op::Parameter(_) | Op::Input => 0,
                _ => below + 1,
            };
        }
        uses
    }

    fn needs_name(&self, module: &Module, id: NodeId) -> bool {
        let node = module.node(id);
        match node.op {
            Op::Constant(_) => self.sliced[id.index()],
            Op::Parameter(_) => self.sliced[id.index()],
            Op::Delay { .. } | Op::Register { .. } | Op::MemoryRead { .. } | Op::InstanceOutput { .. } => true,
            Op::Input | Op::Wire | Op::Lookup(_) => true,
            _ if node.name.is_some() || self.sliced[id.index()] => true,
            Op::Slice { .. } => false,
            Op::Not => self.size[id.index()] > 1 && self.count[id.index()] > 1,
            _ => self.count[id.index()] > 1 || self.size[id.index()] > LARGEST_INLINE,
        }
    }
}
