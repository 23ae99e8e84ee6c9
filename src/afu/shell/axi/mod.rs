//! The shell of AXI4: the core behind an AXI4 master for memory and an AXI4-Lite slave for the host.
//!
//! `control` has the registers and starts jobs. `read` and `write` merge lines into bursts and take bursts apart.
//! [`map`] has the registers, and `document` writes them down.

mod burst;
mod control;
mod document;
pub mod map;
mod port;
mod protocol;
mod read;
mod top;
mod write;

use std::sync::Arc;

use super::{BenchText, ShellDesign};
use crate::afu::port::{Declaration, Ports};
use crate::afu::{Afu, Spec};
use crate::config::Input;
use crate::hdl::{BuildErrors, Module};
pub(in crate::afu) use burst::most_lines;
pub use document::{job, markdown};
pub(crate) use port::{ControlInputs, ControlOutputs, MemoryInputs, MemoryOutputs};

/// The shell.
#[derive(Debug)]
pub(super) struct Axi;

impl ShellDesign for Axi {
    fn top_name(&self) -> &'static str {
        top::NAME
    }

    fn top(&self, spec: &Spec, core: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
        top::top(spec, core)
    }

    fn clock(&self) -> &'static str {
        top::CLOCK
    }

    fn addresses_count(&self) -> &'static str {
        "bytes"
    }

    fn ports(&self, spec: &Spec) -> Ports {
        let system = [
            Declaration::new(top::CLOCK, 1, "clock"),
            Declaration::new(top::RESET, 1, "reset, active low; at least 16 cycles"),
        ];
        let inputs = system.into_iter().chain(ControlInputs::of(spec).list()).chain(MemoryInputs::of(spec).list());
        let outputs = ControlOutputs::of(spec).list().into_iter().chain(MemoryOutputs::of(spec).list());
        Ports { inputs: inputs.collect(), outputs: outputs.collect() }
    }

    fn held(&self) -> Option<(&'static str, u128)> {
        Some((top::RESET, 0))
    }

    fn protocol(&self, afu: &Afu) -> String {
        protocol::protocol(afu)
    }

    fn bench(&self, afu: &Afu) -> BenchText {
        let config = &afu.spec().config;
        // An AFU that takes spheres has two registers more.
        let (others, candidates) = match config.input {
            Input::Direct => (String::new(), String::new()),
            Input::Spheres => (
                format!("      write_register(12'h{:x}, 32'd0);\n", map::OTHERS.offset),
                format!(
                    "        read_register(12'h{:x});\n        if (value != 32'd@CANDIDATES@) fault(\"another number of \
                     candidates\");\n",
                    map::CANDIDATES.offset
                ),
            ),
        };
        let text = include_str!("bench.v").replace("@BUS@", &config.bus.to_string());
        let text = text.replace("@OTHERS@\n", &others).replace("@CHECK_CANDIDATES@\n", &candidates);
        BenchText { text, first_line: 0 }
    }

    fn files(&self, afu: &Afu) -> Vec<(String, String)> {
        let title = format!("# Registers of `{}`", afu.top_name());
        let (input, prefix) = (afu.spec().config.input, afu.spec().config.prefixed("contact_afu"));
        vec![
            (
                "REGISTERS.md".to_owned(),
                format!("{title}\n\n{}\n{}", document::markdown(input), document::job(input, &afu.layout())),
            ),
            (format!("{prefix}_regs.h"), document::header(&prefix, input, &afu.origin())),
        ]
    }
}
