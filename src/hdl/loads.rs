//! Fan-out: a value whose bits select in many places arrives late in all of them.

use super::module::{Module, NodeId, Op};

/// For each node, the number of places in which it selects: bits of the selections, gates, and differences or sums of
/// which it is the condition.
pub(super) fn loads(module: &Module) -> Vec<u32> {
    let mut loads = vec![0; module.nodes.len()];
    for node in &module.nodes {
        let chooses = |position: usize| match node.op {
            Op::Mux | Op::Case { .. } => position == 0,
            Op::SubAdd => position == 2,
            Op::And | Op::Or | Op::Xor => module.repeated_bit(node.operands[position]).is_some(),
            _ => false,
        };
        for position in (0..node.operands.len()).filter(|&position| chooses(position)) {
            loads[chooser(module, node.operands[position]).index()] += node.width;
        }
    }
    // Its complement and its copies have the same fan-out, because a register may be on either side of them.
    for id in module.ids() {
        loads[id.index()] = loads[id.index()].max(loads[chooser(module, id).index()]);
    }
    // A slice also has the load of the busiest bit of the values that it is taken from or goes into.
    for id in module.ids() {
        if let Op::Slice { .. } = module.node(id).op {
            let whole = module.node(id).operands[0].index();
            loads[whole] = loads[whole].max(loads[id.index()]);
        }
    }
    for id in module.ids() {
        if let Op::Concat = module.node(id).op {
            let parts = module.node(id).operands.iter().map(|part| loads[part.index()]).max();
            loads[id.index()] = loads[id.index()].max(parts.unwrap_or_default());
        }
    }
    loads
}

/// The value that drives a line to many places: itself, the value that it complements, or the bit that it repeats.
pub(super) fn chooser(module: &Module, id: NodeId) -> NodeId {
    match module.node(id).op {
        Op::Not => chooser(module, module.node(id).operands[0]),
        _ => module.repeated_bit(id).map_or(id, |bit| chooser(module, bit)),
    }
}

#[cfg(test)]
mod tests {
    use crate::hdl::module::Op;
    use crate::hdl::{DelayModel, Graph};

    /// A comparison of a line that selects takes the same time on either side of the inverter, alone or beside others.
    #[test]
    fn a_complement_is_as_busy_as_its_line() {
        let model = DelayModel::ecp5();
        let compared = |chooses: bool, behind: bool, beside: bool| {
            let g = Graph::new("one");
            let line = g.input("line", 1);
            let condition = if chooses { line } else { g.input("another", 1) };
            g.output("chosen", (!condition).select(g.input("a", 30), g.input("b", 30)));
            let read = if behind { !line } else { line };
            let read = if beside { g.input("high", 1).concat(read) } else { read };
            g.output("less", g.input("other", read.width()).less_than(read));
            let module = g.finish().unwrap();
            let less = module.nodes.iter().position(|node| node.op == Op::Less).unwrap();
            model.delays(&module)[less]
        };
        for beside in [false, true] {
            let busy = compared(true, false, beside);
            assert!(busy > compared(false, false, beside), "beside another: {beside}");
            assert_eq!(compared(true, true, beside), busy, "beside another: {beside}");
        }
    }
}
