//! A long delay as a block memory with its own registers, without look-up tables or flip-flops.

use std::ops::RangeInclusive;
use std::sync::Arc;

use super::block_memory::{Ports, block_memory};
use super::delay_model::DelayModel;
use super::error::BuildErrors;
use super::graph::Graph;
use super::module::{Module, Primitive};

/// The cycles of a delay in a block. A shorter one fits in the depth of one primitive of look-up tables, and a longer
/// one does not fit in a block.
const CYCLES: RangeInclusive<u32> = 18..=514;
/// The widths of a delay in a block. A narrower one wastes it, and a wider one does not fit.
const WIDTH: RangeInclusive<u32> = 24..=36;

/// The delay as a module with an input `value` and an output `delayed`. `None` if the target's block memories are not
/// written as primitives, or if the delay does not fit in one.
///
/// # Errors
/// Returns the first error that the graph recorded.
pub fn delay_block(cycles: u32, width: u32, model: &DelayModel) -> Result<Option<Arc<Module>>, BuildErrors> {
    match model.memory_primitive {
        Some(primitive) if CYCLES.contains(&cycles) && WIDTH.contains(&width) => {
            line(cycles, width, primitive).map(Some)
        }
        _ => Ok(None),
    }
}

fn line(cycles: u32, width: u32, primitive: Primitive) -> Result<Arc<Module>, BuildErrors> {
    // A word is read into one register of the block and then waits in another. The block's output is late and comes
    // from afar, so a register in the fabric takes it.
    let depth = cycles - 2;
    let graph = Graph::new(format!("delay_{cycles}x{width}{}", primitive.suffix()));
    graph.about(format!("value, {cycles} cycles ago: a block memory with registers of its own"));
    let bits = 32 - (depth - 1).leading_zeros();
    // The oldest word is where the next one goes. Both places are registers: no sum stands before the block. From any
    // values they come right by themselves, so no reset has to reach them.
    let oldest = graph.configured_register("oldest", bits, 1);
    let is_last = oldest.equals(graph.constant(bits, u128::from(depth - 1))).named("is_last");
    oldest.next(oldest.plus(1).gate(!is_last));
    let newest = graph.configured_register("newest", bits, 0);
    newest.next(oldest.value());
    let value = graph.input("value", width);
    let ports = [("write_index", newest.value()), ("read_index", oldest.value()), ("write_word", value)];
    let memory = block_memory(depth, width, Ports::Free, Some(primitive))?;
    graph.output("delayed", graph.instance("line", &memory, &ports).output("word").delay(1));
    let mut module = graph.finish()?;
    Arc::make_mut(&mut module).latency = cycles;
    Ok(module)
}
