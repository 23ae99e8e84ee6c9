//! A table of constants as a case statement.

use super::expression::{constant, range};

/// The declaration of `name` and the statement that gives it the word at `index`.
///
/// Left alone Yosys makes a memory of it, whose block is too slow for a fast clock; the attribute keeps it in tables.
pub(super) fn lookup(name: &str, width: u32, table: &[u128], index: &str) -> String {
    let index_bits = table.len().ilog2();
    let mut out = format!("  reg {}{name};\n  always @* begin\n", range(width));
    out += &format!("    (* rom_style = \"logic\" *)\n    case ({index})\n");
    for (number, word) in table.iter().enumerate() {
        let place = constant(index_bits, number as u128);
        // The last one also serves a simulator's unknown index.
        let place = if number + 1 == table.len() { "default" } else { &place };
        out += &format!("      {place}: {name} = {};\n", constant(width, *word));
    }
    out + "    endcase\n  end\n"
}
