//! Verilog-2005 that a hardware engineer can read: the generator's names, stage banners, one file per module, every
//! operand sized. It is clean under `-Wall` without pragmas, because widths always match.

mod cases;
mod delay;
mod derive;
mod expression;
mod instances;
mod layout;
mod line_memory;
mod lookup;
mod names;
mod primitive;
mod print;
mod sections;
mod unused;

use super::module::{Module, Reset};

/// Options of the printer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// The reset style of registers.
    pub reset: Reset,
    /// The prefix of the names of this module and of those that it instantiates.
    pub prefix: String,
    /// Lines every file's header carries, such as the generator and its parameters.
    pub header: Vec<String>,
    /// The kinds of memory that the family has.
    pub memories: Memories,
}

/// The memories of an FPGA family, which decide what the attributes of a memory ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Memories {
    /// For any family. No block memory is named, because M20K, M10K and M9K belong to different families of Intel's.
    /// MLAB is named, because Quartus does not place small memories there otherwise. Without MLABs, Quartus warns and
    /// uses other memories.
    #[default]
    Any,
    /// Block memories and memories of look-up tables, for a family that Quartus does not support.
    BlocksAndLuts,
    /// Block memories only. Synthesis decides about small memories.
    Blocks,
}

impl Style {
    /// The name of the reset port.
    pub(crate) fn reset_port(&self) -> &'static str {
        if self.reset.active_low { "rst_n" } else { "rst" }
    }
}

/// The text of a module's file. The same module and style give the same bytes.
pub fn emit(module: &Module, style: &Style) -> String {
    print::print(module, style)
}
