//! Gathers unused bits in one wire whose name says so, so that linters accept them.

use super::super::instance::{Instance, InstanceCount};
use super::super::module::{Module, NodeId, Op};
use super::instances::chained;
use super::names::Names;

/// The text that names every declared bit without a reader; empty if every bit has one.
pub(super) fn unused(module: &Module, names: &Names) -> String {
    let used = used_bits(module);
    let mut parts = Vec::new();
    for port in module.ports.iter().filter(|port| !port.output && port.node.is_none()) {
        parts.push(port.name.clone());
    }
    for id in module.ids() {
        let Some(name) = &names.declared[id.index()] else { continue };
        let bits = &used[id.index()];
        if bits.iter().all(|used| !used) {
            parts.push(name.clone());
            continue;
        }
        let mut low = 0;
        while low < bits.len() {
            if bits[low] {
                low += 1;
                continue;
            }
            let width = bits[low..].iter().take_while(|used| !**used).count();
            parts.push(if width == 1 {
                format!("{name}[{low}]")
            } else {
                format!("{name}[{}:{low}]", low + width - 1)
            });
            low += width;
        }
    }
    for instance in 0..module.instances.len() {
        let of = &module.instances[instance];
        parts.extend(unconnected(module, instance).into_iter().map(|(port, name)| match of.count {
            InstanceCount::One => name,
            InstanceCount::Parameter(count) => {
                let (count, width) = (&module.parameters[count].name, of.module.ports[port].width);
                format!("{}[{count}*{width} +: {width}]", chained(&of.name, &of.module.ports[port].name))
            }
        }));
    }
    if parts.is_empty() {
        return String::new();
    }
    let mut text = String::from("\n  // Bits that nothing needs.\n  wire unused = &{1'b0");
    for part in parts {
        let line = text.len() - text.rfind('\n').unwrap_or(0);
        text += if line + part.len() > 100 { ",\n    " } else { ", " };
        text += &part;
    }
    text + "};\n"
}

/// Unused output ports of an instance, with the name of the wire for each.
pub(super) fn unconnected(module: &Module, instance: usize) -> Vec<(usize, String)> {
    let used = |port: usize| module.nodes.iter().any(|node| node.op == Op::InstanceOutput { instance, port });
    let of = &module.instances[instance];
    let ports = of.module.ports.iter().enumerate().filter(|(index, port)| port.output && !used(*index));
    ports.map(|(index, port)| (index, format!("{}_{}_unused", of.name, port.name))).collect()
}

/// The bits of each declared node that are read. A node that is written in place passes its reads on to its operands.
fn used_bits(module: &Module) -> Vec<Vec<bool>> {
    let mut used: Vec<Vec<bool>> = module.nodes.iter().map(|node| vec![false; node.width as usize]).collect();
    let outputs = module.ports.iter().filter(|port| port.output).filter_map(|port| port.node);
    let memories = module.memories.iter().filter_map(|memory| memory.write).flatten();
    let inputs = module.instances.iter().flat_map(Instance::given);
    let roots: Vec<NodeId> = outputs.chain(memories).chain(inputs).chain(module.reset).collect();
    for root in roots {
        used[root.index()].fill(true);
    }
    for id in module.ids() {
        let node = module.node(id);
        for operand in &node.operands {
            match node.op {
                Op::Slice { low } => used[operand.index()][low as usize..(low + node.width) as usize].fill(true),
                _ => used[operand.index()].fill(true),
            }
        }
    }
    used
}
