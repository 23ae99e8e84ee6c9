//! Shells around the core. A shell is a value behind `ShellDesign`; only `of` lists them.

pub mod axi;
mod line;
pub mod spl2;

use std::fmt::Debug;
use std::sync::Arc;

use crate::config::Shell;
use crate::hdl::{BuildErrors, Module};

use super::port::Ports;
use super::{Afu, Spec};

/// The part of an AFU that its shell decides.
pub(super) trait ShellDesign: Debug + Sync {
    /// The name of the top module.
    fn top_name(&self) -> &'static str;

    /// The top module, around `core`.
    fn top(&self, spec: &Spec, core: &Arc<Module>) -> Result<Arc<Module>, BuildErrors>;

    /// The name of the top module's clock.
    fn clock(&self) -> &'static str {
        "clk"
    }

    /// The top module's ports.
    fn ports(&self, spec: &Spec) -> Ports;

    /// What the top module's addresses count.
    fn addresses_count(&self) -> &'static str {
        "lines"
    }

    /// For a top that resets itself: the input that holds it in reset, and its active level.
    fn held(&self) -> Option<(&'static str, u128)> {
        None
    }

    /// The section of PORTS.md about the use of the ports.
    fn protocol(&self, afu: &Afu) -> String;

    /// The test bench.
    fn bench(&self, afu: &Afu) -> BenchText;

    /// Files that no other shell has: path and text.
    fn files(&self, _afu: &Afu) -> Vec<(String, String)> {
        Vec::new()
    }
}

/// A shell's part of the test bench.
pub(super) struct BenchText {
    /// Verilog with names between `@`, for which [`Afu`] has values.
    pub(super) text: String,
    /// The source line of the first pairs.
    pub(super) first_line: usize,
}

/// The shell of this name.
pub(super) fn of(shell: Shell) -> &'static dyn ShellDesign {
    match shell {
        Shell::Spl2 => &spl2::Spl2,
        Shell::Line => &line::Line,
        Shell::Axi => &axi::Axi,
    }
}
