//! No shell: the core's own ports.

mod protocol;

use std::sync::Arc;

use super::{BenchText, ShellDesign};
use crate::afu::port::{self, Ports};
use crate::afu::{Afu, Spec};
use crate::hdl::{BuildErrors, Module};

/// The shell.
#[derive(Debug)]
pub(super) struct Line;

impl ShellDesign for Line {
    fn top_name(&self) -> &'static str {
        "contact_afu"
    }

    fn top(&self, _spec: &Spec, core: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
        Ok(core.clone())
    }

    fn ports(&self, spec: &Spec) -> Ports {
        port::core(spec)
    }

    fn protocol(&self, afu: &Afu) -> String {
        protocol::protocol(afu)
    }

    fn bench(&self, afu: &Afu) -> BenchText {
        let Ports { inputs, outputs } = self.ports(afu.spec());
        // Connections of ports for which the bench has no signal of the same name.
        let value = |name| match name {
            "rst_n" => "~rst",
            "source" => "SOURCE",
            "destination" => "DESTINATION",
            "destination_lines" => "LINES",
            "mode" => "4'd0",
            "others" => "32'd0",
            "epoch" => "4'd1",
            "watchdog" => "32'd10000",
            "abort_job" | "rd_rsp_error" | "wr_rsp_error" => "1'b0",
            name => name,
        };
        let ports: Vec<_> = inputs.iter().chain(&outputs).map(|port| (port.name, value(port.name))).collect();
        let wires: String = outputs.iter().map(|port| port.wire()).collect();
        let text = include_str!("bench.v");
        let text = text.replace("@OUTPUTS@\n", &wires).replace("@PORTS@", &port::connections("    ", &ports));
        BenchText { text, first_line: 0 }
    }
}
