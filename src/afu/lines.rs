//! A memory of lines, whose word comes two cycles after its address: a block memory, or several side by side where the
//! target's are written as primitives.

use crate::hdl::{BuildErrors, Graph, Ports, Signal, block_memory};

use super::Spec;

/// Cycles from an address to its line, if nothing holds the line back.
pub(super) const CYCLES_TO_WORD: u32 = 2;
/// Words and bits of a word that one primitive holds, and the words if it has half as many bits.
const PRIMITIVE_DEPTH: u32 = 512;
const PRIMITIVE_WIDTH: u32 = 36;
const DEEPEST_PRIMITIVE: u32 = 2 * PRIMITIVE_DEPTH;

/// The inputs of a memory of lines.
pub(super) struct Access<'g> {
    pub(super) write: Signal<'g>,
    pub(super) write_index: Signal<'g>,
    pub(super) line: Signal<'g>,
    /// True if a line is read.
    pub(super) read: Signal<'g>,
    pub(super) read_index: Signal<'g>,
    /// True if the line that was read before advances to the output.
    pub(super) advance: Signal<'g>,
}

/// A memory of `depth` lines with this name; returns the line. It is one instance, or as many as the primitives need,
/// each named after the first of its bits.
pub(super) fn line_memory<'g>(
    graph: &'g Graph,
    spec: &Spec,
    name: &str,
    depth: u32,
    access: &Access<'g>,
) -> Result<Signal<'g>, BuildErrors> {
    let bits = access.line.width();
    let primitive = spec.delays.memory_primitive.filter(|_| depth <= DEEPEST_PRIMITIVE);
    // For a deeper memory a block memory has fewer bits of each word, so no word is chosen behind several of them.
    let fits = (PRIMITIVE_DEPTH * PRIMITIVE_WIDTH / depth.max(PRIMITIVE_DEPTH)).max(1);
    let widest = spec.delays.memory_primitive.map_or(bits, |_| fits);
    let mut words = Vec::new();
    for first in (0..bits).step_by(widest as usize) {
        let width = widest.min(bits - first);
        let name = if width == bits { name.to_owned() } else { format!("{name}_{first}") };
        let inputs = [
            ("write", access.write),
            ("write_index", access.write_index),
            ("write_word", access.line.slice(first, width)),
            ("read", access.read),
            ("read_index", access.read_index),
            ("advance", access.advance),
        ];
        let memory = block_memory(depth, width, Ports::Gated, primitive)?;
        words.push(graph.instance(&name, &memory, &inputs).output("word"));
    }
    words.reverse();
    Ok(Signal::join(&words))
}
