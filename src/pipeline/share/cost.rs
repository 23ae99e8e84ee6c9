//! Estimates what sharing costs and saves, in LUTs of four inputs. The estimate guides choices and is never reported.

use crate::hdl::{Module, Node, NodeId, Op};

/// The cost of a multiplier block in LUTs, because blocks are scarce in the supported devices.
const BLOCK: u32 = 100;
/// The widest operand of a multiplier block.
const BLOCK_BITS: u32 = 18;

/// The LUTs of a module.
pub(super) fn tables(module: &Module) -> u32 {
    let nodes: u32 = module.nodes.iter().map(|node| of(module, node)).sum();
    nodes + module.instances.iter().map(|instance| tables(&instance.module)).sum::<u32>()
}

/// The LUTs of a module plus half its register bits. A LUT comes with a register, and few registers stand alone.
pub(super) fn area(module: &Module) -> u32 {
    tables(module) + registers(module) / 2
}

fn registers(module: &Module) -> u32 {
    let bits = |node: &Node| match node.op {
        // A long delay is a memory of words of 16 bits.
        Op::Delay { cycles } => node.width * cycles.min(2 + cycles / 16),
        Op::Register { .. } | Op::MemoryRead { .. } => node.width,
        _ => 0,
    };
    let own: u32 = module.nodes.iter().map(bits).sum();
    own + module.instances.iter().map(|instance| registers(&instance.module)).sum::<u32>()
}

/// A choice among this number of words of `width` bits: trees of two-way choices, two per LUT.
pub(super) fn choice(words: u32, width: u32) -> u32 {
    words.saturating_sub(1) * width / 2
}

fn of(module: &Module, node: &Node) -> u32 {
    let width = |id: &NodeId| module.node(*id).width;
    let operand = || node.operands.first().map_or(0, width);
    match node.op {
        Op::Add | Op::Sub => node.width,
        // Without a primitive, the complement takes its own LUTs.
        Op::SubAdd => 2 * node.width,
        Op::Less => operand(),
        Op::Equal => operand() * 2 / 3,
        Op::Any | Op::All => operand() / 3,
        Op::And | Op::Or | Op::Xor | Op::Mux => node.width.div_ceil(2),
        Op::Case { .. } => choice(node.operands.len() as u32 - 1, node.width),
        Op::OneHot => node.width,
        Op::Lookup(_) => node.width * (1 << operand().min(10)) / 16,
        Op::Mul => {
            let factors = node.operands.iter().map(|id| width(id).div_ceil(BLOCK_BITS));
            factors.product::<u32>() * BLOCK
        }
        _ => 0,
    }
}
