//! The accelerators that are proven: the controller that the generator writes for users, but with short lines, few
//! tags, small buffers, and a plain delay as SCPU.

use std::sync::Arc;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Input, Results, Shell};
use contact_afu::hdl::{Graph, Module};
use contact_afu::query::Fields;

use crate::search::Part;

const TAGS: u32 = 4;

/// A proven accelerator, except for the delay of its SCPUs. A line holds two pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Design {
    /// Two SCPUs that each take one pair per cycle. Every pair has a record, two per line.
    EachCycle,
    /// Two SCPUs that each take one pair every two cycles.
    EveryOther,
    /// Three such SCPUs, whose turns do not fit in one cycle.
    ThreeEveryOther,
    /// Only the numbers of pairs that touch come back, two per line.
    Hits,
    /// Only pairs that touch come back, one per line: the number and two words.
    Records,
    /// A queue of the AFU that takes spheres, 16 words deep.
    Queue,
    /// A part of that AFU.
    Search(Part),
    /// The shell `axi` with a bus of 256 bits and 16 lines outstanding; its core does not matter.
    Axi,
}

use Design::{Axi, EachCycle, EveryOther, Hits, Queue, Records, Search, ThreeEveryOther};

impl Design {
    /// The suffix in reports that distinguishes it from [`EachCycle`].
    pub fn label(self) -> &'static str {
        match self {
            EachCycle => "",
            EveryOther => ", interval 2",
            ThreeEveryOther => ", three at interval 2",
            Hits => ", hits",
            Records => ", hits with records",
            Axi => ", axi",
            Queue | Search(_) => ", spheres",
        }
    }

    fn only_hits(self) -> bool {
        matches!(self, Hits | Records)
    }

    /// Macros that describe it to a harness, with SCPUs of this delay.
    pub fn defines(self, latency: u32) -> Vec<String> {
        // The lines that the dispatcher stores and the results there is room for, as computed by
        // `afu::results::Room`.
        let lines = 16;
        let capacity = 32;
        let own: &[&str] = match self {
            EachCycle => &["SCPUS=32'd2"],
            EveryOther => &["SCPUS=32'd2", "EVERY_OTHER"],
            ThreeEveryOther => &["SCPUS=32'd3", "EVERY_OTHER", "THREE"],
            Hits => &["SCPUS=32'd2", "PER_LINE=2", "GATHERS"],
            Records => &["SCPUS=32'd2", "PER_LINE=1"],
            Axi => &[],
            Search(part) => part.defines(),
            Queue => &["QUEUE=queue_16x29_slack_8", "QUEUE_BITS=29"],
        };
        let own = own.iter().map(|define| (*define).to_owned());
        own.chain([format!("LATENCY={latency}"), format!("LINES={lines}"), format!("CAPACITY={capacity}")]).collect()
    }

    /// Commands of Yosys that make free what does not matter to a proof.
    pub fn frees(self) -> String {
        match self {
            Search(part) => part.frees(),
            _ => String::new(),
        }
    }

    /// The number of a pair's words that come back.
    fn record_bits(self) -> u32 {
        match self {
            EachCycle | EveryOther | ThreeEveryOther | Axi | Queue | Search(_) => 16,
            Hits => 0,
            Records => 8,
        }
    }

    fn spec(self) -> Spec {
        let base = Config { scpus: 2, ..Config::default() };
        let of_hits = |contact: &str| Config {
            results: Results::Hits,
            contact: contact.parse().expect("fields of a contact"),
            ..base.clone()
        };
        let config = match self {
            EachCycle | Axi | Queue | Search(_) => base,
            EveryOther => Config { interval: 2, ..base },
            ThreeEveryOther => Config { scpus: 3, interval: 2, ..base },
            Hits => of_hits("hit"),
            Records => of_hits("depth"),
        };
        // A pair has eight words. A hit's number has 32 bits.
        let word_bits = if self.only_hits() { 4 } else { 2 };
        let scpus = config.scpus;
        Spec {
            line_bits: 16 * word_bits,
            word_bits,
            max_outstanding: TAGS,
            max_hops: scpus,
            dispatch_cycles: 1,
            ..Spec::from(config)
        }
    }

    /// Verilog files (name and text) of the accelerator with SCPUs of this delay, and of what harnesses include.
    pub fn files(self, latency: u32) -> Vec<(String, String)> {
        match self {
            Axi => return axi(),
            Queue => return queue(),
            Search(part) => return part.files(),
            _ => {}
        }
        let spec = self.spec();
        let scpu = scpu(&spec, latency, self.record_bits());
        let afu = Afu::around_scpu(spec, scpu).expect("a sound accelerator");
        let top = format!("{} #(.SCPUS(`SCPUS))", afu.top_name());
        let includes = [
            ("inputs.svh".to_owned(), inputs(afu.top(), "  input wire clk,\n  input wire rst")),
            ("dut.svh".to_owned(), instance(afu.top(), &top)),
        ];
        afu.verilog().into_iter().chain(includes).collect()
    }
}

/// The parts of the shell `axi`, and an instance of its registers.
fn axi() -> Vec<(String, String)> {
    let config = Config {
        shell: Shell::Axi,
        bus: 256,
        outstanding: 16,
        profile: "e5f2z".parse().expect("a profile"),
        ..Config::default()
    };
    let afu = Afu::generate(Spec::from(config)).expect("a sound accelerator");
    let parts = afu.top().hierarchy();
    let control = parts.iter().find(|module| module.name == "axi_control").expect("the registers");
    let includes =
        [("inputs.svh".to_owned(), inputs(control, "")), ("dut.svh".to_owned(), instance(control, "axi_control"))];
    let verilog = afu.verilog().into_iter().filter(|(name, _)| name.starts_with("axi_"));
    verilog.chain(includes).collect()
}

/// The queue in front of the level of groups' rows.
fn queue() -> Vec<(String, String)> {
    let config = Config {
        input: Input::Spheres,
        results: Results::Hits,
        contact: Fields::HIT,
        shell: Shell::Line,
        ..Config::default()
    };
    let afu = Afu::generate(Spec::from(config)).expect("a sound accelerator");
    afu.verilog().into_iter().filter(|(name, _)| name == "queue_16x29_slack_8.v").collect()
}

/// The accelerator's inputs, declared as inputs of a harness.
pub fn inputs(module: &Module, system: &str) -> String {
    let inputs = module.ports.iter().filter(|port| !port.output);
    let inputs: String = inputs.map(|port| format!(",\n  input wire [{}:0] {}", port.width - 1, port.name)).collect();
    format!("{system}{inputs}\n")
}

/// Instantiates the accelerator as `dut` and declares wires for its outputs. Its inputs are the harness's signals of
/// the same names. Those may be narrower; the upper bits are then zero.
pub fn instance(module: &Module, name: &str) -> String {
    let ports = &module.ports;
    let outputs = ports.iter().filter(|port| port.output);
    let wires: String = outputs.map(|port| format!("  wire [{}:0] {};\n", port.width - 1, port.name)).collect();
    let names = ["clk", "rst"].into_iter().chain(ports.iter().map(|port| port.name.as_str()));
    let connections: Vec<String> = names.map(|name| format!("    .{name}({name})")).collect();
    format!("{wires}  {name} dut (\n{}\n  );\n", connections.join(",\n"))
}

/// An SCPU that returns as many bits of its pair as a record holds: a contact if bit 0 is set, invalid if bit 1 is
/// set and bit 0 is not. At an interval of 2 it reads the upper half one cycle later.
fn scpu(spec: &Spec, latency: u32, record_bits: u32) -> Arc<Module> {
    let graph = Graph::new("scpu");
    graph.about(format!("in place of an SCPU: the pair itself, {latency} cycles later"));
    if spec.config.interval > 1 {
        graph.input("take", 1);
    }
    let pair_bits = spec.layout().pair_bits();
    let pair = graph.input("pair", pair_bits);
    if record_bits > 0 {
        let half = pair_bits / 2;
        let record = match spec.config.interval {
            1 => pair.delay(latency),
            _ => pair.high(half).delay(latency - 1).concat(pair.low(half).delay(latency)),
        };
        graph.output("record", record.low(record_bits));
    }
    graph.output("contact", pair.bit(0).delay(latency));
    graph.output("invalid_pair", (pair.bit(1) & !pair.bit(0)).delay(latency));
    let mut module = graph.finish().expect("a sound module");
    Arc::get_mut(&mut module).expect("the only owner").latency = latency;
    module
}
