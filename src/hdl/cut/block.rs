//! What a target has blocks for: each is an instance of a module of its own. A multiplier block with registers inside
//! is one that synthesis maps to, or the target's primitive by name, and so is a block memory with a table; differences
//! that may be sums are only ever the latter.

use std::sync::Arc;

use crate::hdl::delay_model::DelayModel;
use crate::hdl::error::BuildErrors;
use crate::hdl::graph::{Graph, Inner};
use crate::hdl::instance::{Instance, InstanceCount};
use crate::hdl::module::{Module, NodeId, Op, Primitive};

/// Puts an instance of a multiplier block in the place of the product `id`, whose operands are those of the block's
/// first rank.
pub(super) fn instantiate_multiplier(inner: &mut Inner, id: NodeId, model: &DelayModel) -> Result<(), BuildErrors> {
    let operands = inner.nodes[id.index()].operands.clone();
    let [a, b] = [0, 1].map(|position: usize| inner.nodes[operands[position].index()].width);
    // The wider factor first: so the factors' order makes no second module.
    let (first, second) = if a >= b { (0, 1) } else { (1, 0) };
    let module = multiplier([a.max(b), a.min(b)], model)?;
    replace(inner, id, &module, &[("a", operands[first]), ("b", operands[second])], "product");
    Ok(())
}

/// Replaces the table `id` by an instance of a block memory, whose address is the operand of the table's first rank.
/// The memory's module is only for this table, in the module of this name.
pub(super) fn instantiate_table(
    inner: &mut Inner,
    id: NodeId,
    owner: &str,
    model: &DelayModel,
) -> Result<(), BuildErrors> {
    let node = &inner.nodes[id.index()];
    let Op::Lookup(table) = node.op.clone() else { return Ok(()) };
    let (width, index) = (node.width, node.operands[0]);
    let what = node.name.clone().unwrap_or_else(|| format!("table_{}", id.index()));
    let suffix = model.memory_primitive.map_or("", |primitive| primitive.suffix());
    let graph = Graph::new(format!("{owner}_{what}{suffix}"));
    graph.about("a table of constants in a block memory, with registers of its index and its word");
    let index_bits = inner.nodes[index.index()].width;
    let registered = graph.input("index", index_bits).delay(1).named("index_register");
    // A name other than the port's, as in a multiplier block.
    graph.output("word", registered.lookup(&table, width).named("entry").delay(1).named("word_register"));
    let mut module = graph.finish()?;
    let block = Arc::make_mut(&mut module);
    block.latency = model.table_registers;
    block.primitive = model.memory_primitive;
    replace(inner, id, &module, &[("index", index)], "table");
    Ok(())
}

/// Puts an instance of the target's carry chain in the place of the difference or sum `id`.
pub(super) fn instantiate_sub_add(inner: &mut Inner, id: NodeId, primitive: Primitive) -> Result<(), BuildErrors> {
    let node = &inner.nodes[id.index()];
    let (operands, module) = (node.operands.clone(), sub_add(node.width, primitive)?);
    let inputs: Vec<_> = ["a", "b", "add"].into_iter().zip(operands).collect();
    replace(inner, id, &module, &inputs, "sum");
    Ok(())
}

/// Puts an instance of `module`, which has one output, in the place of node `id`.
fn replace(inner: &mut Inner, id: NodeId, module: &Arc<Module>, inputs: &[(&str, NodeId)], what: &str) {
    let number = inner.instances.len();
    let node = &inner.nodes[id.index()];
    let mut name = node.name.as_ref().map_or_else(|| format!("{what}_{number}"), |name| format!("{name}_block"));
    // Values may share a name, instances may not.
    if inner.instances.iter().any(|instance| instance.name == name) {
        name = format!("{name}_{number}");
    }
    let value = |port: &str| inputs.iter().find(|(name, _)| *name == port).map(|(_, value)| *value);
    let inputs = module.ports.iter().map(|port| value(&port.name)).collect();
    inner.instances.push(Instance { name, inputs, count: InstanceCount::One, module: module.clone(), reset: None });
    let port = module.ports.iter().position(|port| port.output).unwrap_or_default();
    inner.nodes[id.index()].op = Op::InstanceOutput { instance: number, port };
    inner.nodes[id.index()].operands.clear();
}

/// a − b, or a + b.
fn sub_add(width: u32, primitive: Primitive) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new(format!("sub_add_{width}{}", primitive.suffix()));
    graph.about("a - b, or a + b where add is set: one carry chain, the complement in its own look-up tables");
    let (a, b) = (graph.input("a", width), graph.input("b", width));
    graph.output("result", a.minus_or_plus(b, graph.input("add", 1)));
    let mut module = graph.finish()?;
    Arc::make_mut(&mut module).primitive = Some(primitive);
    Ok(module)
}

/// a · b, with registers before and behind the product.
fn multiplier([a_bits, b_bits]: [u32; 2], model: &DelayModel) -> Result<Arc<Module>, BuildErrors> {
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
