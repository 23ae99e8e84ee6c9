//! Verilog-2005 that a hardware engineer enjoys reading: the generator's names, stage banners, one module a file,
//! every operand sized. Clean under `-Wall` without pragmas, since widths always match.

mod delay;
mod expression;
mod instances;
mod lookup;
mod names;
mod primitive;
mod print;
mod sections;
mod unused;

use super::module::{Module, Reset};

/// How Verilog is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// How registers are reset.
    pub reset: Reset,
    /// Lines every file's header carries, such as the generator and its parameters.
    pub header: Vec<String>,
}

impl Style {
    /// The name of the reset port.
    pub fn reset_port(&self) -> &'static str {
        if self.reset.active_low { "rst_n" } else { "rst" }
    }
}

/// The text of a module's file. The same module and style give the same bytes.
pub fn emit(module: &Module, style: &Style) -> String {
    print::print(module, style)
}
