//! Decides which nodes are declared, and their names.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::super::instance::Instance;
use super::super::keywords::keywords;
use super::super::module::{Module, Node, NodeId, Op, Start};
use super::derive::Derivation;
use super::print::is_register;

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
            let next = next_of.get(&id).filter(|_| !is_register(module, id)).map(|of| format!("{of}_next"));
            let derive = || Derivation { module, declared: &names.declared }.name(id);
            let wanted = node.name.clone().or(next).unwrap_or_else(derive);
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
}

/// Values that only a named register uses, or its copies.
fn next_values(module: &Module) -> HashMap<NodeId, &str> {
    let registers = module.nodes.iter().filter_map(|node| {
        let Node { op: Op::Register { is_copy, .. }, name: Some(name), .. } = node else { return None };
        let of = name.rsplit_once("_copy_").filter(|_| *is_copy).map_or(name.as_str(), |(of, _)| of);
        Some((node.operands[0], of))
    });
    registers.collect()
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

/// True if a concatenation has one operand beside zeros.
fn is_between_zeros(module: &Module, node: &Node) -> bool {
    let others = node.operands.iter().filter(|id| module.node(**id).op != Op::Constant(0));
    others.count() == 1
}

/// The number of uses of each node, and whether a use needs an identifier.
struct Uses {
    count: Vec<u32>,
    /// How many registers without an enable take the value.
    taken: Vec<u32>,
    sliced: Vec<bool>,
    size: Vec<u32>,
}

/// An expression of more than this many operators gets a name, so that lines stay readable.
const LARGEST_INLINE: u32 = 9;

impl Uses {
    fn count(module: &Module) -> Self {
        let nodes = module.nodes.len();
        let mut uses =
            Self { count: vec![0; nodes], taken: vec![0; nodes], sliced: vec![false; nodes], size: vec![0; nodes] };
        let memory_ports = module.memories.iter().filter_map(|m| m.write).flatten();
        let instance_inputs = module.instances.iter().flat_map(Instance::given);
        let outputs = module.ports.iter().filter(|p| p.output).filter_map(|p| p.node);
        for id in memory_ports.chain(instance_inputs).chain(outputs).chain(module.reset) {
            uses.count[id.index()] += 1;
        }
        for node in &module.nodes {
            if let (Op::Register { start: Start::Any, is_copy: false }, [next]) = (&node.op, &node.operands[..]) {
                uses.taken[next.index()] += 1;
            }
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
        // What is written in place again and again is read as often.
        for id in module.ids().collect::<Vec<_>>().into_iter().rev() {
            let again = uses.count[id.index()].saturating_sub(1);
            if again > 0 && uses.is_transparent(module, id) {
                let operands: BTreeSet<_> = module.node(id).operands.iter().collect();
                operands.into_iter().for_each(|operand| uses.count[operand.index()] += again);
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

    /// True for what is always written in place: a complement, a value between zeros, a bit as a mask.
    fn is_transparent(&self, module: &Module, id: NodeId) -> bool {
        let node = module.node(id);
        if node.name.is_some() || self.sliced[id.index()] {
            return false;
        }
        match node.op {
            Op::Not => true,
            Op::Concat => module.repeated_bit(id).is_some() || is_between_zeros(module, node),
            _ => false,
        }
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
            Op::Case { .. } => self.count[id.index()] > self.taken[id.index()],
            Op::Not | Op::Concat if self.is_transparent(module, id) => false,
            _ => self.count[id.index()] > 1 || self.size[id.index()] > LARGEST_INLINE,
        }
    }
}
