//! A memory of lines, whose word comes two cycles after its address: a block memory, or several side by side where the
//! target's are written as primitives.

use std::sync::Arc;

use crate::hdl::{Errors, Graph, Module, Ports, Signal, block_memory};

use super::Spec;

/// From an address to its line, where nothing holds the line back.
pub(super) const CYCLES_TO_WORD: u32 = 2;
/// Words and bits of a word that one primitive holds.
const PRIMITIVE_DEPTH: u32 = 512;
const PRIMITIVE_WIDTH: u32 = 36;

/// What a memory of lines is asked.
pub(super) struct Access<'g> {
    pub(super) write: Signal<'g>,
    pub(super) write_index: Signal<'g>,
    pub(super) line: Signal<'g>,
    /// Whether a line is read.
    pub(super) read: Signal<'g>,
    pub(super) read_index: Signal<'g>,
    /// Whether the line that was read before goes on to the output.
    pub(super) advance: Signal<'g>,
}

/// The modules of a memory of `depth` lines.
pub(super) struct LineMemory {
    /// Each with its bits of the line, from the lowest on.
    slices: Vec<(Arc<Module>, u32)>,
}

impl LineMemory {
    pub(super) fn new(spec: &Spec, depth: u32) -> Result<Self, Errors> {
        let primitive = spec.delays.memory_primitive.filter(|_| depth <= PRIMITIVE_DEPTH);
        let widest = primitive.map_or(spec.line_bits, |_| PRIMITIVE_WIDTH);
        let whole = (0..spec.line_bits / widest).map(|_| widest);
        let rest = Some(spec.line_bits % widest).filter(|rest| *rest > 0);
        let slice = |width| Ok((block_memory(depth, width, Ports::Gated, primitive)?, width));
        Ok(Self { slices: whole.chain(rest).map(slice).collect::<Result<_, _>>()? })
    }

    /// Its instances under a name, and the line.
    pub(super) fn instance<'g>(&self, graph: &'g Graph, name: &str, access: &Access<'g>) -> Signal<'g> {
        let mut first = 0;
        let mut words = Vec::new();
        for (module, width) in &self.slices {
            let name = if self.slices.len() == 1 { name.to_owned() } else { format!("{name}_{first}") };
            let inputs = [
                ("write", access.write),
                ("write_index", access.write_index),
                ("write_word", access.line.slice(first, *width)),
                ("read", access.read),
                ("read_index", access.read_index),
                ("advance", access.advance),
            ];
            words.push(graph.instance(&name, module, &inputs).output("word"));
            first += width;
        }
        words.reverse();
        Signal::join(&words)
    }
}
