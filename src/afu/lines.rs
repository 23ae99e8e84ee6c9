//! A memory of lines, whose word comes two cycles after its address: a block memory, or several side by side where the
//! target's are written as primitives.

use crate::hdl::{BuildErrors, Graph, Ports, Primitive, Signal, block_memory};

use super::{Spec, wide};

/// Cycles from an address to its line, if nothing holds the line back.
pub(super) const CYCLES_TO_WORD: u32 = 2;
/// Words and bits of a word that one primitive holds, and the words if it has half as many bits.
const PRIMITIVE_DEPTH: u32 = 512;
const PRIMITIVE_WIDTH: u32 = 36;
const DEEPEST_PRIMITIVE: u32 = 2 * PRIMITIVE_DEPTH;

/// The inputs of a memory of lines.
pub(super) struct Access<'a, 'g> {
    /// True if a line is written, if one is read, and if the one that was read before advances to the output: one
    /// signal for all primitives, or [one](steering) for each part of the line.
    pub(super) write: &'a [Signal<'g>],
    pub(super) read: &'a [Signal<'g>],
    pub(super) advance: &'a [Signal<'g>],
    pub(super) write_index: Signal<'g>,
    pub(super) line: Signal<'g>,
    pub(super) read_index: Signal<'g>,
}

/// The bits of a line in each instance of a memory of `depth` lines.
fn bits_each(spec: &Spec, depth: u32, bits: u32) -> u32 {
    // For a deeper memory a block memory has fewer bits of each word, so no word is chosen behind several of them.
    let fits = (PRIMITIVE_DEPTH * PRIMITIVE_WIDTH / depth.max(PRIMITIVE_DEPTH)).max(1);
    spec.delays.memory_primitive.map_or(bits, |_| fits)
}

fn primitive(spec: &Spec, depth: u32) -> Option<Primitive> {
    spec.delays.memory_primitive.filter(|_| depth <= DEEPEST_PRIMITIVE)
}

/// What steers a memory of `depth` lines: the register `state`, which takes `next`; or a copy of it for each part of a
/// line, to be placed beside the primitives that it steers.
pub(super) fn steering<'g>(spec: &Spec, depth: u32, name: &str, [state, next]: [Signal<'g>; 2]) -> Vec<Signal<'g>> {
    let bits = spec.line_bits;
    match wide::copies_for(bits).min(bits.div_ceil(bits_each(spec, depth, bits))) {
        1 => vec![state],
        count => next.copies(name, count),
    }
}

/// A memory of `depth` lines with this name; returns the line. It is one instance, or as many as the primitives need,
/// each named after the first of its bits.
pub(super) fn line_memory<'g>(
    graph: &'g Graph,
    spec: &Spec,
    name: &str,
    depth: u32,
    access: &Access<'_, 'g>,
) -> Result<Signal<'g>, BuildErrors> {
    let bits = access.line.width();
    let widest = bits_each(spec, depth, bits);
    let mut words = Vec::new();
    for first in (0..bits).step_by(widest as usize) {
        let width = widest.min(bits - first);
        let name = if width == bits { name.to_owned() } else { format!("{name}_{first}") };
        let part = |signals: &[Signal<'g>]| signals[first as usize * signals.len() / bits as usize];
        let inputs = [
            ("write", part(access.write)),
            ("write_index", access.write_index),
            ("write_word", access.line.slice(first, width)),
            ("read", part(access.read)),
            ("read_index", access.read_index),
            ("advance", part(access.advance)),
        ];
        let memory = block_memory(depth, width, Ports::Gated, primitive(spec, depth))?;
        words.push(graph.instance(&name, &memory, &inputs).output("word"));
    }
    words.reverse();
    Ok(Signal::join(&words))
}
