//! An SCPU's netlist in Verilator.

use std::fs;

use contact_afu::cosim::{File, Model, Source, Trace};
use contact_afu::query::PairRecord;

use crate::synthesise::Files;

/// What Verilator says of netlists and of Yosys's models of cells, none of which is a fault.
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

/// A contact's words; whether it is one, and whether the pair is invalid.
pub type Outcome = ([u32; 8], (bool, bool));

/// `text` with modules that Verilator compiles once each, instead of at every instance.
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

/// What comes of a pair in every cycle, each `latency` cycles after it went in.
pub fn scpu(name: &str, verilog: &Files, latency: u32, pairs: &[PairRecord]) -> Vec<Outcome> {
    let meant: String = MEANT.iter().map(|warning| format!("// verilator lint_off {warning}\n")).collect();
    let file = |path: &std::path::PathBuf| {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let text = fs::read_to_string(path).expect("written");
        // Cells are small and many: those are best compiled at each instance.
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
        // Behind the last pair comes what nobody looks at.
        pair.set_words(&pairs.get(cycle - 1).map_or([u32::MAX; 8], |pair| pair.0));
        clock.tick(1).expect("it runs");
        if cycle >= latency as usize {
            found.push((record.words(), (contact.is_high(), invalid.is_high())));
        }
    }
    found
}
