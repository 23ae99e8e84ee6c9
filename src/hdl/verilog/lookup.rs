//! A table of constants as a case statement.

use super::super::module::{Module, Op};
use super::expression::{constant, range};

/// True if the module is only a table between registers, which a block memory can implement.
pub(super) fn is_block_memory(module: &Module) -> bool {
    let is_part = |op: &Op| matches!(op, Op::Input | Op::Delay { .. } | Op::Lookup(_));
    module.nodes.iter().all(|node| is_part(&node.op)) && module.latency == 2
}

/// The declaration of `name` and the statement that gives it the word at `index`.
///
/// Without an attribute Yosys makes a memory of it. The block of this memory is too slow for a fast clock if its
/// registers are not used. The attribute keeps it in look-up tables, unless it `is_block`.
pub(super) fn lookup(name: &str, width: u32, table: &[u128], index: &str, is_block: bool) -> String {
    let style = if is_block { "block" } else { "logic" };
    let index_bits = table.len().ilog2();
    let mut out = format!("  reg {}{name};\n  always @* begin\n", range(width));
    out += &format!("    (* rom_style = \"{style}\" *)\n    case ({index})\n");
    for (number, word) in table.iter().enumerate() {
        let place = constant(index_bits, number as u128);
        // The last one also serves a simulator's unknown index.
        let place = if number + 1 == table.len() { "default" } else { &place };
        out += &format!("      {place}: {name} = {};\n", constant(width, *word));
    }
    out + "    endcase\n  end\n"
}
