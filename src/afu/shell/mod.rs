//! Shells around the core. A shell is a value behind `ShellDesign`; only `of` lists them.

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

    /// The top module's ports.
    fn ports(&self, spec: &Spec) -> Ports;

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

/// The shell of this name; `axi` does not exist yet, and [`crate::config::Config::check`] refuses it.
pub(super) fn of(shell: Shell) -> &'static dyn ShellDesign {
    match shell {
        Shell::Spl2 => &spl2::Spl2,
        Shell::Line | Shell::Axi => &line::Line,
    }
}
