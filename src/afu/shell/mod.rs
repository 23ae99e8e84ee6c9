//! What stands around the core: a shell is a value behind `ShellDesign`, and `of` alone knows which there are.

mod line;
pub mod spl2;

use std::fmt::Debug;
use std::sync::Arc;

use crate::config::Shell;
use crate::hdl::{BuildErrors, Module};

use super::port::Ports;
use super::{Afu, Spec};

/// What is a shell's own of an AFU.
pub(super) trait ShellDesign: Debug + Sync {
    /// The name of the top module.
    fn top_name(&self) -> &'static str;

    /// The top module, around `core`.
    fn top(&self, spec: &Spec, core: &Arc<Module>) -> Result<Arc<Module>, BuildErrors>;

    /// The top module's ports.
    fn ports(&self, spec: &Spec) -> Ports;

    /// The input that holds a top in reset that resets itself, and the level at which it does.
    fn held(&self) -> Option<(&'static str, u128)> {
        None
    }

    /// What PORTS.md says of how the ports are used.
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

/// The shell of that name. There is none of `axi` yet, which [`crate::config::Config::check`] refuses.
pub(super) fn of(shell: Shell) -> &'static dyn ShellDesign {
    match shell {
        Shell::Spl2 => &spl2::Spl2,
        Shell::Line | Shell::Axi => &line::Line,
    }
}
