//! The accelerator as it is proven: the controller that the generator writes for users, with short lines, few tags,
//! small buffers, and an SCPU that is a delay.

use std::sync::Arc;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::Config;
use contact_afu::hdl::{Graph, Module};

/// Bits of a line, two pairs of eight words in it.
const LINE_BITS: u32 = 32;
const WORD_BITS: u32 = 2;
const TAGS: u32 = 4;

/// An SCPU that gives its pair back: a contact if bit 0 is set, invalid if bit 1 is set and bit 0 is not.
fn scpu(latency: u32) -> Arc<Module> {
    let graph = Graph::new("scpu");
    graph.about(format!("in place of an SCPU: the pair itself, {latency} cycles later"));
    let pair = graph.input("pair", LINE_BITS / 2);
    graph.output("record", pair.delay(latency));
    graph.output("contact", pair.bit(0).delay(latency));
    graph.output("invalid_pair", (pair.bit(1) & !pair.bit(0)).delay(latency));
    let mut module = graph.finish().expect("a sound module");
    Arc::get_mut(&mut module).expect("the only owner").latency = latency;
    module
}

/// Verilog files, name and text, of the accelerator around an SCPU of that latency.
pub fn files(latency: u32) -> Vec<(String, String)> {
    let spec = Spec {
        line_bits: LINE_BITS,
        word_bits: WORD_BITS,
        max_outstanding: TAGS,
        dispatch_cycles: 1,
        ..Spec::from(Config { scpus: 2, ..Config::default() })
    };
    Afu::around_scpu(spec, scpu(latency)).expect("a sound accelerator").verilog()
}
