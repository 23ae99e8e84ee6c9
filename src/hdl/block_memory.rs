//! A block memory with registers of its own: a word comes two cycles after its address.

use std::sync::Arc;

use super::error::BuildErrors;
use super::graph::Graph;
use super::module::{Module, Primitive, Size};
use super::state::address_width;

/// True if the written and the read value can be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ports {
    /// A word is written in every cycle, and the word that was read goes to its register in every cycle.
    Free,
    /// A word is written where the input `write` is set, another read where `read` is, and the one that was read before
    /// goes to its register where `advance` is.
    Gated,
}

/// The memory as a module with inputs `write_index`, `write_word`, `read_index` and those of `ports`, and an output
/// `word`: what stood at `read_index` two cycles ago. A word must not be read in the cycle in which it is written. As
/// `primitive`, if there is one; otherwise gated memories of all sizes share one file.
///
/// # Errors
/// Returns the first error that the graph recorded.
pub(crate) fn block_memory(
    depth: u32,
    width: u32,
    ports: Ports,
    primitive: Option<Primitive>,
) -> Result<Arc<Module>, BuildErrors> {
    let kind = if ports == Ports::Gated { "line_memory" } else { "memory" };
    let shares_file = ports == Ports::Gated && primitive.is_none();
    let graph = Graph::new(match shares_file {
        true => kind.to_owned(),
        false => format!("{kind}_{depth}x{width}{}", primitive.map_or("", Primitive::suffix)),
    });
    graph.about("a word is written, another is read two cycles later: one block memory with its registers");
    let bits = address_width(depth);
    let write = match ports {
        Ports::Free => graph.constant(1, 1),
        Ports::Gated => graph.input("write", 1),
    };
    let words = graph.memory("words", depth, width);
    words.write(write, graph.input("write_index", bits), graph.input("write_word", width));
    let index = graph.input("read_index", bits);
    let word = match ports {
        Ports::Free => words.read(index).named("word_read").delay(1).named("word_register"),
        Ports::Gated => {
            let read = words.read_if(graph.input("read", 1), index).named("word_read");
            let register = graph.data_register("word_register", width);
            register.next_if(graph.input("advance", 1), read);
            register.value()
        }
    };
    graph.output("word", word);
    let mut module = graph.finish()?;
    let memory = Arc::make_mut(&mut module);
    memory.latency = 2;
    memory.primitive = primitive;
    memory.size = shares_file.then_some(Size { depth, width });
    Ok(module)
}
