//! Simulates an SCPU's netlist in Verilator.

use std::fs;

use contact_afu::cosim::{File, Model, Source, Trace};
use contact_afu::query::PairRecord;

use crate::synthesise::Files;

/// Verilator's warnings about netlists and Yosys's cell models. None of them is a fault.
const MEANT: [&str; 10] = [
    "WIDTH",
    "UNOPTFLAT",
    "PINMISSING",
    "CASEINCOMPLETE",
    "COMBDLY",
    "INITIALDLY",
    "IMPLICIT",
    "SELRANGE",
    "MULTITOP",
    "SPECIFYIGN",
];

/// A contact's words, and the flags for a contact and for an invalid pair.
pub type Outcome = ([u32; 8], (bool, bool));

/// `text` with directives that make Verilator compile each module once instead of inlining every instance.
fn apart(text: &str) -> String {
    let mut header = false;
    let line = |line: &str| {
        header |= line.starts_with("module ");
        let ends = header && line.ends_with(';');
        header &= !ends;
        line.to_owned() + if ends { " /* verilator no_inline_module */\n" } else { "\n" }
    };
    text.lines().map(line).collect()
}

/// The results of one pair per cycle, each `latency` cycles after its input.
pub fn scpu(name: &str, verilog: &Files, latency: u32, pairs: &[PairRecord]) -> Vec<Outcome> {
    let meant: String = MEANT.iter().map(|warning| format!("// verilator lint_off {warning}\n")).collect();
    let file = |path: &std::path::PathBuf| {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let text = fs::read_to_string(path).expect("written");
        // Cells are small and numerous, so inlining them is faster.
        let text = if name == "netlist.v" { apart(&text) } else { text };
        File { name, text: meant.clone() + &text }
    };
    let source = Source::new(name, verilog.files.iter().map(file).collect());
    let folder = tempfile::tempdir().expect("a temporary folder");
    let model = Model::build_in(&source, Trace::Off, folder.path()).expect("Verilator takes it");
    let instance = model.instance(1).expect("an instance");
    let clock = instance.clock("clk").expect("a clock");
    if instance.has_port("rst") {
        let reset = instance.input("rst", 1).expect("a reset");
        reset.set(1);
        clock.tick(4).expect("it runs");
        reset.set(0);
    }
    let pair = instance.input("pair", 256).expect("a pair");
    let record = instance.output("record", 256).expect("a record");
    let [contact, invalid] = ["contact", "invalid_pair"].map(|name| instance.output(name, 1).expect("a flag"));
    let mut found = Vec::with_capacity(pairs.len());
    for cycle in 1..pairs.len() + latency as usize {
        // After the last pair the input does not matter.
        pair.set_words(&pairs.get(cycle - 1).map_or([u32::MAX; 8], |pair| pair.0));
        clock.tick(1).expect("it runs");
        if cycle >= latency as usize {
            found.push((record.words(), (contact.is_high(), invalid.is_high())));
        }
    }
    found
}
