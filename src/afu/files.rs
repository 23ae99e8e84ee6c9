//! The files beside the Verilog: for simulators, synthesis tools and integrators.

use std::collections::BTreeSet;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::config::{Config, Input, MANIFEST_SCHEMA};
use crate::hdl::Primitive;
use crate::pipeline::KernelReport;

use super::port::connections;
use super::spheres::SPHERE_BITS;
use super::{Afu, Package};
use crate::spheres::ROW;

/// The folder of the test bench, separate from the files to synthesise.
pub(super) const BENCH_FOLDER: &str = "sim";

/// The file name of the list of a configuration's Verilog files, each after the files it needs.
pub fn file_list(config: &Config) -> String {
    config.prefixed("contact_afu.f")
}

impl Afu {
    /// All files of the generated folder as relative path and text. The manifest is last.
    pub fn files(&self) -> Vec<(String, String)> {
        self.files_with(&[])
    }

    /// The same with the files of these packages, which the accelerator's shell must allow ([`Package::check`]).
    pub fn files_with(&self, packages: &[Package]) -> Vec<(String, String)> {
        let verilog = self.verilog();
        let names: Vec<&str> = verilog.iter().map(|(name, _)| name.as_str()).collect();
        let config = &self.spec().config;
        let named = |name: &str, text: String| (config.prefixed(name), text);
        let mut files = verilog.clone();
        files.extend([
            (format!("{BENCH_FOLDER}/{}.v", self.bench_name()), self.bench()),
            (file_list(config), self.list(&names)),
            named("contact_afu.core", self.fusesoc_core(&names)),
            named("contact_afu.sdc", self.sdc()),
            named("contact_afu.xdc", self.xdc()),
            named("contact_afu_instance.vh", self.template()),
            ("PORTS.md".to_owned(), self.ports_page()),
        ]);
        files.extend(self.shell().files(self));
        files.extend(packages.iter().flat_map(|package| package.files(self)));
        let manifest = self.manifest(&files);
        files.push(("manifest.json".to_owned(), manifest));
        files
    }

    /// SHA-256 over the Verilog's names and texts, in order. It identifies a built model (`cosim` computes the same for
    /// the files that it is given).
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
        let (comment, clock, period) = (self.clock_comment(), self.shell().clock(), self.period_ns());
        format!("{comment}\ncreate_clock -name {clock} -period {period:.3} [get_ports {clock}]\n")
    }

    fn xdc(&self) -> String {
        let (comment, clock, period) = (self.clock_comment(), self.shell().clock(), self.period_ns());
        format!("{comment}\ncreate_clock -period {period:.3} -name {clock} [get_ports {clock}]\n")
    }

    /// The list of Verilog files, with the command of each tool.
    fn list(&self, names: &[&str]) -> String {
        let (top, list) = (self.top_name(), file_list(&self.spec().config));
        let files: String = names.iter().map(|name| format!("{name}\n")).collect();
        format!(
            "// The Verilog of {top}, each file after those it needs. Names are relative to this file's folder. From any folder:
//   verilator -F FOLDER/{list}   (Questa, VCS and Xcelium know -F too)
//   yosys -p \"read_verilog FOLDER/{top}.v; hierarchy -libdir FOLDER -check -top {top}\"
//   iverilog -s {top} -y FOLDER FOLDER/{top}.v   (it has no -F; in this folder -f {list} does)
{files}"
        )
    }

    fn template(&self) -> String {
        let ports = self.ports();
        let ports: Vec<_> = ports.inputs.iter().chain(&ports.outputs).map(|port| (port.name, port.name)).collect();
        let config = &self.spec().config;
        let parameters =
            if config.has_deciders() { String::new() } else { format!(" #(\n  .SCPUS(32'd{})\n)", config.scpus) };
        format!(
            "// Instantiation template.\n{top}{parameters} u_{top} (\n{}\n);\n",
            connections("  ", &ports),
            top = self.top_name()
        )
    }

    fn record_sizes(&self) -> Value {
        let layout = self.layout();
        match self.spec().config.input {
            Input::Direct => json!({
                "pair_bits": layout.pair_bits(),
                "pairs_per_line": layout.pairs_per_line(),
                "contact_bits": layout.contact_bits(),
                "contacts_per_line": layout.contacts_per_line(),
            }),
            Input::Spheres => json!({
                "sphere_bits": SPHERE_BITS,
                "spheres_per_line": layout.line_bits() / SPHERE_BITS,
                "spheres_per_row": ROW,
                "contact_bits": layout.contact_bits(),
                "contacts_per_line": layout.contacts_per_line(),
            }),
        }
    }

    fn manifest(&self, files: &[(String, String)]) -> String {
        let spec = self.spec();
        let hashes: serde_json::Map<String, Value> =
            files.iter().map(|(name, text)| (name.clone(), Value::String(sha256(text.as_bytes())))).collect();
        let mut kernel = KernelReport::of(self.kernel());
        for operator in &mut kernel.operators {
            operator.module = spec.config.prefixed(&operator.module);
        }
        let mut manifest = json!({
            "schema": MANIFEST_SCHEMA,
            "version": env!("CARGO_PKG_VERSION"),
            "top": self.top_name(),
            "config": spec.config,
            "format": spec.config.profile.format().to_string(),
            "reset": { "asynchronous": spec.reset.asynchronous, "active_low": spec.reset.active_low },
            "line_bits": spec.line_bits,
            "max_outstanding": spec.max_outstanding,
            "records": self.record_sizes(),
            "latency_cycles": self.kernel().latency,
            "kernel": kernel,
            "rtl_sha256": self.rtl_sha256(),
            "files": hashes,
        });
        if let Some(target) = spec.target {
            manifest["target"] = json!(target);
        }
        // The names of a target's blocks, which another target's flow cannot read.
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
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
