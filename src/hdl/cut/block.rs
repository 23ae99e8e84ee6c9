//! Multiplier blocks with registers inside: each is an instance of a module of its own, which synthesis maps to one
//! block with its registers, or which names the target's primitive.

use std::sync::Arc;

use crate::hdl::delay_model::DelayModel;
use crate::hdl::error::Errors;
use crate::hdl::graph::{Graph, Inner};
use crate::hdl::module::{Instance, InstanceCount, Module, NodeId, Op};

/// Puts an instance of a multiplier block in the place of the product `id`, whose operands are those of the block's
/// first rank.
pub(super) fn instantiate(inner: &mut Inner, id: NodeId, model: &DelayModel) -> Result<(), Errors> {
    let node = inner.nodes[id.index()].clone();
    let [a, b] = [0, 1].map(|position| inner.nodes[node.operands[position].index()].width);
    // The wider factor first: so the factors' order makes no second module.
    let (first, second) = if a >= b { (0, 1) } else { (1, 0) };
    let module = multiplier([a.max(b), a.min(b)], model)?;
    let number = inner.instances.len();
    let name = node.name.as_ref().map_or_else(|| format!("product_{number}"), |name| format!("{name}_block"));
    let inputs = module.ports.iter().map(|port| match port.name.as_str() {
        "a" => Some(node.operands[first]),
        "b" => Some(node.operands[second]),
        _ => None,
    });
    let instance = Instance { name, inputs: inputs.collect(), count: InstanceCount::One, module: module.clone() };
    let port = module.ports.iter().position(|port| port.output).unwrap_or_default();
    inner.instances.push(instance);
    inner.nodes[id.index()].op = Op::InstanceOutput { instance: number, port };
    inner.nodes[id.index()].operands.clear();
    Ok(())
}

/// a · b, with registers before and behind the product.
fn multiplier([a_bits, b_bits]: [u32; 2], model: &DelayModel) -> Result<Arc<Module>, Errors> {
    let suffix = model.multiplier_primitive.map_or("", |primitive| primitive.suffix());
    let graph = Graph::new(format!("multiplier_{a_bits}x{b_bits}{suffix}"));
    graph.about("a * b, both unsigned, with registers in and out: one multiplier block");
    let a = graph.input("a", a_bits).delay(1).named("a_register");
    let b = graph.input("b", b_bits).delay(1).named("b_register");
    // A name other than the port's: so the port is a wire, which a primitive can drive.
    graph.output("product", (a * b).delay(1).named("product_register"));
    let mut module = graph.finish()?;
    let inner = Arc::make_mut(&mut module);
    inner.latency = model.multiplier_registers;
    inner.primitive = model.multiplier_primitive;
    Ok(module)
}
