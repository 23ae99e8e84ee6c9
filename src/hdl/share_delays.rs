//! Delays of one value share their registers: delays of 5 and 3 cycles become a chain of 3 and 2.

use std::collections::{BTreeMap, HashMap};

use super::graph::Inner;
use super::module::{
    DISTRIBUTED_DEPTH, LONGEST_DISTRIBUTED_DELAY, LONGEST_REGISTER_DELAY, Node, NodeId, Op, is_memory_delay,
};

/// Turns every live delay into one of a value that is not itself delayed, so that intermediate delays can be removed.
pub(super) fn collapse(inner: &mut Inner, live: &[NodeId]) {
    let delayed = |nodes: &[Node], id: NodeId| match nodes[id.index()].op {
        Op::Delay { cycles } => Some((nodes[id.index()].operands[0], cycles)),
        _ => None,
    };
    for &id in live {
        let Some((mut source, mut total)) = delayed(&inner.nodes, id) else { continue };
        let mut steps = 0;
        while let Some((further, cycles)) = delayed(&inner.nodes, source) {
            let Some(sum) = total.checked_add(cycles).filter(|_| steps < live.len()) else { break };
            (source, total) = (further, sum);
            steps += 1;
        }
        if steps == live.len() {
            // After a loop of delays, which has no beginning: a value that circulates. It does not change.
            continue;
        }
        let node = &mut inner.nodes[id.index()];
        node.op = Op::Delay { cycles: total };
        node.operands[0] = source;
    }
}

/// Turns the live delays of each value, collapsed before, into one chain.
pub(super) fn chain(inner: &mut Inner, live: &[NodeId]) {
    let mut of: BTreeMap<NodeId, BTreeMap<u32, NodeId>> = BTreeMap::new();
    let mut replaced: HashMap<NodeId, NodeId> = HashMap::new();
    for &id in live {
        let node = &inner.nodes[id.index()];
        let Op::Delay { cycles } = node.op else { continue };
        let named = node.name.is_some();
        let at = of.entry(node.operands[0]).or_default();
        match at.get(&cycles).copied() {
            None => drop(at.insert(cycles, id)),
            Some(other) if named && inner.nodes[other.index()].name.is_none() => {
                at.insert(cycles, id);
                replaced.insert(other, id);
            }
            Some(other) => drop(replaced.insert(id, other)),
        }
    }
    for (source, delays) in of {
        let is_late = !is_registered(&inner.nodes, source);
        let (mut from, mut distance) = (source, 0);
        for (cycles, id) in delays {
            let width = inner.nodes[id.index()].width;
            while let Some(step) = step(cycles - distance, width, is_late && distance == 0) {
                let node = inner.nodes[id.index()].clone();
                let node = Node { op: Op::Delay { cycles: step }, operands: vec![from], name: None, ..node };
                from = NodeId(inner.nodes.len() as u32);
                inner.nodes.push(node);
                inner.places.push(inner.places[id.index()]);
                distance += step;
            }
            let node = &mut inner.nodes[id.index()];
            node.op = Op::Delay { cycles: cycles - distance };
            node.operands[0] = from;
            (from, distance) = (id, cycles);
        }
    }
    if !replaced.is_empty() {
        // A delay replaced by one that was replaced later in turn.
        inner.redirect(|mut id| {
            while let Some(&other) = replaced.get(&id) {
                id = other;
            }
            id
        });
    }
}

/// The length of the first part of a delay. A short delay is a row of named registers, and a long one is several
/// memories, each as deep as one primitive. If `is_late`, the value passes a register before it enters a memory. A
/// register can be close to the logic before it, but the path into a memory is long.
fn step(cycles: u32, width: u32, is_late: bool) -> Option<u32> {
    match (cycles, is_memory_delay(cycles, width)) {
        (0 | 1, _) => None,
        (_, true) if is_late => Some(1),
        (..=LONGEST_DISTRIBUTED_DELAY, true) => Some(DISTRIBUTED_DEPTH).filter(|depth| cycles > *depth),
        (..=LONGEST_REGISTER_DELAY, false) => Some(1),
        _ => None,
    }
}

/// True if a value comes from registers through wiring only. Inputs and outputs of instances do.
fn is_registered(nodes: &[Node], id: NodeId) -> bool {
    let node = &nodes[id.index()];
    match node.op {
        Op::Input | Op::Constant(_) | Op::Parameter(_) | Op::InstanceOutput { .. } => true,
        Op::Delay { .. } | Op::Register { .. } => true,
        Op::Slice { .. } | Op::Concat => node.operands.iter().all(|part| is_registered(nodes, *part)),
        _ => false,
    }
}
