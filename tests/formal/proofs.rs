//! What is proven: harness, method, depth.

use std::fmt;
use std::fs;
use std::path::Path;

/// How a proof is made.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// Every assertion holds in the first so many cycles after power-up.
    Bounded(u32),
    /// Every assertion holds for ever: in the first so many cycles, and in a cycle after any so many in which it held.
    Inductive(u32),
    /// Some assertion fails in that cycle after power-up, if any does: for mutants.
    At(u32),
    /// Every cover is reached in so many cycles: the proofs are about something.
    Reached(u32),
}

/// A proof.
#[derive(Clone, Copy, Debug)]
pub struct Proof {
    pub name: &'static str,
    /// The file in `tb/formal`, and its module.
    pub harness: &'static str,
    /// Cycles of an SCPU.
    pub latency: u32,
    /// Further macros of the harness.
    pub defines: &'static [&'static str],
    pub method: Method,
    /// Whether the test command has it.
    pub is_short: bool,
}

impl Proof {
    /// The macros of the harness. Four lines are what the dispatcher keeps around SCPUs of up to 2 cycles, else eight.
    pub fn defines(&self) -> Vec<String> {
        let lines = if self.latency <= 2 { 4 } else { 8 };
        let own = self.defines.iter().map(|define| (*define).to_owned());
        [format!("LATENCY={}", self.latency), format!("LINES={lines}")].into_iter().chain(own).collect()
    }

    const fn new(name: &'static str, harness: &'static str, latency: u32, method: Method) -> Self {
        Self { name, harness, latency, defines: &[], method, is_short: false }
    }

    const fn with(self, defines: &'static [&'static str]) -> Self {
        Self { defines, ..self }
    }

    const fn short(self) -> Self {
        Self { is_short: true, ..self }
    }
}

impl fmt::Display for Proof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (how, cycles) = match self.method {
            Method::Bounded(cycles) => ("bounded", cycles),
            Method::Inductive(cycles) => ("inductive", cycles),
            Method::At(cycle) => ("in cycle", cycle),
            Method::Reached(cycles) => ("reached", cycles),
        };
        write!(f, "{} (SCPU {}, {how} {cycles})", self.name, self.latency)
    }
}

use Method::{Bounded, Inductive, Reached};

/// All of them.
pub const PROOFS: &[Proof] = &[
    Proof::new("collector", "collector", 1, Inductive(2)).short(),
    Proof::new("dispatcher", "dispatcher", 1, Inductive(2)).short(),
    Proof::new("credits", "credits", 1, Inductive(6)).short(),
    Proof::new("any link, any host", "line_port", 1, Bounded(9)).with(&["PAIRS=3"]).short(),
    Proof::new("one job", "line_port", 1, Bounded(22)).with(&["PAIRS=3", "ONE_JOB"]),
    Proof::new("a job ends", "line_port", 1, Bounded(27)).with(&["PAIRS=2", "ONE_JOB", "PROMPT=1", "BOUND=22"]),
    Proof::new("jobs are whole", "line_port", 1, Reached(22)).with(&["PAIRS=3", "ONE_JOB"]),
];

/// The proof of that name.
pub fn proof(name: &str) -> &'static Proof {
    PROOFS.iter().find(|proof| proof.name == name).unwrap_or_else(|| panic!("no proof is called {name}"))
}

/// Harness and name of every assertion that a proof has.
pub fn properties() -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    let mut harnesses: Vec<_> = PROOFS.iter().map(|proof| proof.harness).collect();
    harnesses.dedup();
    for harness in harnesses {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tb/formal/{harness}.sv"));
        let text = fs::read_to_string(path).expect("the harness");
        let names = text.split(": assert").map(|before| before.rsplit(char::is_whitespace).next().unwrap_or_default());
        let count = text.matches(": assert").count();
        found.extend(names.take(count).map(|name| (harness, name.to_owned())));
    }
    found
}
