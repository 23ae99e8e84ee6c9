//! What stands beside the Verilog: what simulators, synthesisers and integrators read.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::config::{MANIFEST_SCHEMA, Results};
use crate::hdl::Primitive;
use crate::pipeline::KernelReport;

use super::{Afu, MAX_SCPUS, spl2, timing};
use crate::config::Shell;

/// The list of the Verilog files in a generated folder, each after those it needs.
pub const FILE_LIST: &str = "contact_afu.f";

impl Afu {
    /// All files of the generated folder, the manifest last: relative path and text.
    pub fn files(&self) -> Vec<(String, String)> {
        let verilog = self.verilog();
        let names: Vec<&str> = verilog.iter().map(|(name, _)| name.as_str()).collect();
        let mut beside = vec![
            (FILE_LIST, file_list(&names)),
            ("contact_afu.core", fusesoc_core(&names, &self.top().name)),
            ("contact_afu.sdc", self.sdc()),
            ("contact_afu.xdc", self.xdc()),
            ("contact_afu_instance.vh", self.template()),
            ("PORTS.md", self.ports()),
        ];
        if self.spec().config.shell == Shell::Spl2 {
            beside.push(("REGISTERS.md", format!("# Registers and lines of `afu_top`\n\n{}", spl2::map::markdown())));
        }
        let beside = beside.into_iter().map(|(name, text)| (name.to_owned(), text));
        let mut files: Vec<(String, String)> = verilog.iter().cloned().chain(beside).collect();
        let manifest = self.manifest(&files);
        files.push(("manifest.json".to_owned(), manifest));
        files
    }

    /// SHA-256 over the Verilog's names and texts, in order: what a built model is known by (`cosim` computes the same
    /// of the files it is given).
    pub fn rtl_sha256(&self) -> String {
        rtl_sha256(self.verilog().iter().map(|(name, text)| (name.as_str(), text.as_str())))
    }

    fn period_ns(&self) -> f64 {
        1000.0 / self.spec().config.clock_mhz
    }

    fn clock_comment(&self) -> String {
        match self.spec().config.cut_mhz {
            None => "# The clock that the stages were cut for.".to_owned(),
            Some(cut) => format!("# The clock to run at; the stages were cut for {cut} MHz."),
        }
    }

    fn sdc(&self) -> String {
        format!("{}\ncreate_clock -name clk -period {:.3} [get_ports clk]\n", self.clock_comment(), self.period_ns())
    }

    fn xdc(&self) -> String {
        format!("{}\ncreate_clock -period {:.3} -name clk [get_ports clk]\n", self.clock_comment(), self.period_ns())
    }

    fn all_ports(&self) -> Vec<(bool, u32, String)> {
        let reset = if self.spec().reset.active_low { "rst_n" } else { "rst" };
        let reset = self.top().has_reset_port().then(|| (false, 1, reset.to_owned()));
        let implied = [(false, 1, "clk".to_owned())].into_iter().chain(reset);
        let declared = self.top().ports.iter().map(|port| (port.output, port.width, port.name.clone()));
        implied.chain(declared).collect()
    }

    fn template(&self) -> String {
        let ports = self.all_ports();
        let widest = ports.iter().map(|(_, _, name)| name.len()).max().unwrap_or(0);
        let lines: Vec<_> = ports.iter().map(|(_, _, name)| format!("  .{name:<widest$} ({name})")).collect();
        let scpus = self.spec().config.scpus;
        format!(
            "// Instantiation template.\n{top} #(\n  .SCPUS(32'd{scpus})\n) u_{top} (\n{}\n);\n",
            lines.join(",\n"),
            top = self.top().name
        )
    }

    fn ports(&self) -> String {
        let spec = self.spec();
        let scpus = spec.full_rate().filter(|multiple| *multiple < MAX_SCPUS).map_or_else(String::new, |multiple| {
            format!(
                ": {multiple} SCPUs at interval {} take a full line per cycle, and above {multiple} only a multiple of \
                 {multiple} is built, the next smaller one",
                spec.config.interval
            )
        });
        let mut out = format!(
            "# Ports of `{}`\n\nOne clock. `SCPUS` (1 to 64) is a Verilog parameter{scpus}. All outputs are registered or functions of \
             registers.\nA line is 512 bits; word i of a line is bits 32·i+31 to 32·i; addresses count lines.\n\n| port | direction | bits | meaning |\n|---|---|---|---|\n",
            self.top().name,
        );
        for (output, width, name) in self.all_ports() {
            let direction = if output { "out" } else { "in" };
            let _ = writeln!(out, "| `{name}` | {direction} | {width} | {}{} |", meaning(&name), self.more(&name));
        }
        out
    }

    /// What a port means beyond [`meaning`] in an AFU that differs from the default one.
    fn more(&self, name: &str) -> String {
        let config = &self.spec().config;
        let of_hits = match name {
            "error" => ", 6 more lines of contacts than `destination_lines`",
            "capability" => ", 24 set: only contacts come back",
            "contacts" => ": as many records, each beginning with its pair's number",
            _ => "",
        };
        let hits = Some(of_hits.to_owned()).filter(|_| config.results == Results::Hits);
        let radius = config.radius.map(|radius| format!(", 25 set: every sphere's radius is {radius}"));
        let code = timing::record_code(config.record);
        let record = (code > 0).then(|| format!(", 27:26 are {code}: words of records are {}", config.record));
        let of_capability = [radius, record].into_iter().flatten().filter(|_| name == "capability");
        hits.into_iter().chain(of_capability).collect()
    }

    fn manifest(&self, files: &[(String, String)]) -> String {
        let spec = self.spec();
        let layout = self.layout();
        let hashes: serde_json::Map<String, Value> =
            files.iter().map(|(name, text)| (name.clone(), Value::String(sha256(text.as_bytes())))).collect();
        let mut manifest = json!({
            "schema": MANIFEST_SCHEMA,
            "version": env!("CARGO_PKG_VERSION"),
            "top": self.top().name,
            "config": spec.config,
            "format": spec.config.profile.format().to_string(),
            "reset": { "asynchronous": spec.reset.asynchronous, "active_low": spec.reset.active_low },
            "line_bits": spec.line_bits,
            "max_outstanding": spec.max_outstanding,
            "records": {
                "pair_bits": layout.pair_bits(),
                "pairs_per_line": layout.pairs_per_line(),
                "contact_bits": layout.contact_bits(),
                "contacts_per_line": layout.contacts_per_line(),
            },
            "latency_cycles": self.kernel().latency,
            "kernel": KernelReport::of(self.kernel()),
            "rtl_sha256": self.rtl_sha256(),
            "files": hashes,
        });
        if let Some(target) = spec.target {
            manifest["target"] = json!(target);
        }
        // What a target's blocks are named: another target's flow cannot read these.
        let primitives: BTreeSet<&str> =
            self.top().hierarchy().iter().filter_map(|module| module.primitive).map(Primitive::name).collect();
        if !primitives.is_empty() {
            manifest["primitives"] = json!(primitives);
        }
        // Keys and numbers only: this cannot fail.
        serde_json::to_string_pretty(&manifest).unwrap_or_default() + "\n"
    }
}

/// SHA-256 of files, names, lengths and order included, as 64 hexadecimal digits.
fn rtl_sha256<'a>(files: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    let mut hash = Sha256::new();
    for part in files.flat_map(|(name, text)| [name, text]) {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part.as_bytes());
    }
    hex(&hash.finalize())
}

fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn file_list(names: &[&str]) -> String {
    names.iter().map(|name| format!("{name}\n")).collect()
}

fn fusesoc_core(names: &[&str], top: &str) -> String {
    let files: String = names.iter().map(|name| format!("      - {name}\n")).collect();
    format!(
        "CAPI=2:\nname: ::contact_afu:{version}\ndescription: Collision-detection accelerator\n\nfilesets:\n  rtl:\n    files:\n{files}    \
         file_type: verilogSource\n\ntargets:\n  default: &default\n    filesets: [rtl]\n    toplevel: {top}\n    parameters: [SCPUS]\n  lint:\n    \
         <<: *default\n    default_tool: verilator\n    tools:\n      verilator:\n        mode: lint-only\n        verilator_options: [-Wall]\n  sim:\n    \
         <<: *default\n    default_tool: icarus\n  synth:\n    <<: *default\n    default_tool: yosys\n    tools:\n      yosys:\n        arch: ecp5\n\n\
         parameters:\n  SCPUS:\n    datatype: int\n    paramtype: vlogparam\n    description: Sphere Collision Processing Units, 1 to 64\n",
        version = env!("CARGO_PKG_VERSION")
    )
}

fn meaning(name: &str) -> &'static str {
    match name {
        "clk" => "clock",
        "rst" => "reset, active high; at least one cycle",
        "rst_n" => "reset, active low; at least one cycle",
        "start" => "one cycle high starts a job; ignored while busy",
        "source" => "line address of the first source line",
        "destination" => "line address of the first destination line",
        "destination_lines" => "lines there is room for at the destination; those beyond are not written",
        "count" => "pairs of the job; 0 is a job",
        "mode" => "0; anything else ends the job with error 5",
        "epoch" => "upper part of the job's tags: change it from job to job, so that late responses are known",
        "watchdog" => "cycles without a response, with one owed, that end the job with error 4; 0: never",
        "abort_job" => "high ends the job with error 1, when what is outstanding has been answered",
        "busy" => "a job is running or ending",
        "done" => "the last job has ended; low from the next start on",
        "error" => "how: 0 well, 1 aborted, 2 read error, 3 write error, 4 watchdog, 5 unknown mode",
        "contacts" => "contacts of the job so far",
        "invalid" => "invalid pairs of the job so far",
        "first_invalid" => "number of the first invalid pair, all ones if there is none",
        "cycles_busy" => "cycles of the job so far",
        "cycles_input" => "of these, cycles in which the SCPUs waited for pairs",
        "cycles_output" => "of these, cycles in which pairs waited for room for their results",
        "capability" => {
            "7:0 SCPUS, 15:8 interval, 19:16 fields (hit, depth, normal, position from bit 16 up), 43:32 SCPU latency"
        }
        "rd_req_valid" => "a read request; it stays as it is until ready",
        "rd_req_ready" => "the request is taken at this clock edge",
        "rd_req_address" => "line address to read",
        "rd_req_tag" => "epoch and slot; not used again before its response",
        "rd_rsp_valid" => "a read response, in any order; never refused",
        "rd_rsp_tag" => "the tag of its request",
        "rd_rsp_data" => "the line",
        "rd_rsp_error" => "the line could not be read: the job ends with error 2",
        "wr_req_valid" => "a write request; it stays as it is until ready",
        "wr_req_ready" => "the request is taken at this clock edge",
        "wr_req_address" => "line address to write",
        "wr_req_tag" => "epoch and slot; not used again before its response",
        "wr_req_data" => "the line",
        "wr_rsp_valid" => "a write acknowledgement, in any order; never refused",
        "wr_rsp_tag" => "the tag of its request",
        "wr_rsp_error" => "the line could not be written: the job ends with error 3",
        "reset_n" => "the system's reset, active low; at least one cycle",
        "spl_enable" => "low: everything but the registers rests, as in reset",
        "spl_reset" => "reset, active high: a job that runs is forgotten",
        "spl_tx_rd_almostfull" => "no read is put into the port's register while it is high",
        "spl_tx_wr_almostfull" => "no write is put into the port's register while it is high",
        "afu_tx_rd_valid" => "a read request, taken in this cycle",
        "afu_tx_rd_hdr" => "98:93 lines (1), 92:67 and 45:14 line address, 66 virtual, 55:52 type (4), 13:0 mdata",
        "afu_tx_wr_valid" => "a write request or a fence, taken in this cycle",
        "afu_tx_wr_hdr" => "as `afu_tx_rd_hdr`; type 2 a line, 5 a fence",
        "afu_tx_data" => "the line",
        "afu_tx_intr_valid" => "an interrupt: never",
        "spl_rx_rd_valid" => "a read response, in any order; never refused",
        "spl_rx_wr_valid0" | "spl_rx_wr_valid1" => "a write response, in any order, on both channels if need be",
        "spl_rx_cfg_valid" => "a CSR write: header 13:0 its byte offset / 4, data 31:0 its value",
        "spl_rx_hdr0" | "spl_rx_hdr1" => "17:14 type, 13:0 mdata of the request",
        "spl_rx_data" => "the line, or the register's value",
        "spl_rx_intr_valid0" | "spl_rx_intr_valid1" | "spl_rx_umsg_valid" => "not used",
        _ => "",
    }
}
