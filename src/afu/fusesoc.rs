//! The FuseSoC core beside the Verilog.

use super::Afu;
use super::files::BENCH_FOLDER;

/// The declaration of the parameter.
const SCPUS: &str = "
parameters:
  SCPUS:
    datatype: int
    paramtype: vlogparam
    description: Sphere Collision Processing Units, 1 to 64
";

impl Afu {
    /// The name of the core: vendor, library, name and version, the name from the options that made the AFU.
    pub fn vlnv(&self) -> String {
        let mut name = self.top_name();
        let options = self.spec().flags();
        for option in options.chunks(2).filter(|option| option[0] != "--prefix") {
            let plain = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' };
            let value: String = option[1].replace('.', "_").chars().map(plain).collect();
            name += &format!("-{}-{value}", option[0].trim_start_matches('-'));
        }
        format!("contact-afu:afu:{name}:{}", env!("CARGO_PKG_VERSION"))
    }

    /// The text of the core, for the Verilog files of these names.
    pub(super) fn fusesoc_core(&self, verilog: &[&str]) -> String {
        let (top, bench) = (self.top_name(), self.bench_name());
        let [sdc, xdc] = ["contact_afu.sdc", "contact_afu.xdc"].map(|name| self.spec().config.prefixed(name));
        let files: String = verilog.iter().map(|name| format!("      - {name}\n")).collect();
        // Behind deciders the number of SCPUs is fixed.
        let (uses, parameters) =
            if self.spec().config.has_deciders() { ("", "") } else { ("    parameters: [SCPUS]\n", SCPUS) };
        format!(
            "CAPI=2:
name: {vlnv}
description: Collision-detection accelerator

filesets:
  rtl:
    files:
{files}    file_type: verilogSource
  bench:
    files:
      - {BENCH_FOLDER}/{bench}.v
    file_type: verilogSource
  constraints:
    files:
      - tool_quartus? ({sdc}): {{file_type: SDC}}
      - tool_vivado? ({xdc}): {{file_type: xdc}}

targets:
  default: &default
    filesets: [rtl, constraints]
    toplevel: {top}
{uses}  lint:
    <<: *default
    default_tool: verilator
    tools:
      verilator:
        mode: lint-only
        verilator_options: [-Wall]
  sim:
    filesets: [rtl, bench]
    toplevel: {bench}
{uses}    default_tool: icarus
    tools:
      icarus:
        iverilog_options: [-g2005]
  synth:
    <<: *default
    default_tool: yosys
    tools:
      yosys:
        arch: ecp5
{parameters}",
            vlnv = self.vlnv()
        )
    }
}
