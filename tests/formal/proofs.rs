//! The list of proofs: harness, method, depth.

use std::fmt;
use std::fs;
use std::path::Path;

use crate::design::Design;
use crate::search::Part;

#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// Every assertion holds in the first `n` cycles after power-up.
    Bounded(u32),
    /// Every assertion holds for ever: in the first `n` cycles, and in each cycle that follows `n` cycles in which it
    /// held.
    Inductive(u32),
    /// For mutants: if an assertion fails, it fails in this cycle after power-up.
    At(u32),
    /// Every cover is reached within `n` cycles, which shows that the proofs are not vacuous.
    Reached(u32),
}

#[derive(Clone, Copy, Debug)]
pub struct Proof {
    pub name: &'static str,
    pub design: Design,
    /// The file in `tb/formal`, and the name of its module.
    pub harness: &'static str,
    /// Latency of an SCPU in cycles.
    pub latency: u32,
    /// Additional macros of the harness.
    pub defines: &'static [&'static str],
    /// Cycles within which a job must end.
    pub bound: Option<u32>,
    pub method: Method,
    /// True if the test command runs it.
    pub is_short: bool,
}

impl Proof {
    pub fn defines(&self) -> Vec<String> {
        let bound = self.bound.map(|cycles| format!("BOUND={cycles}"));
        let own = self.defines.iter().map(|define| (*define).to_owned()).chain(bound);
        self.design.defines(self.latency).into_iter().chain(own).collect()
    }

    /// Verilog files (name and text) of the accelerator.
    pub fn files(&self) -> Vec<(String, String)> {
        self.design.files(self.latency)
    }

    pub const fn new(name: &'static str, harness: &'static str, latency: u32, method: Method) -> Self {
        Self { name, design: Design::EachCycle, harness, latency, defines: &[], bound: None, method, is_short: false }
    }

    pub const fn with(self, defines: &'static [&'static str]) -> Self {
        Self { defines, ..self }
    }

    const fn of(self, design: Design) -> Self {
        Self { design, ..self }
    }

    const fn ends(self, cycles: u32) -> Self {
        Self { bound: Some(cycles), ..self }
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
        write!(f, "{} (SCPU {}{}, {how} {cycles})", self.name, self.latency, self.design.label())
    }
}

use Method::{Bounded, Inductive, Reached};

/// The proofs that are run for each latency of an SCPU. Their depths grow with the latency of slots, around an SCPU. A
/// job begins once the delay lines are filled, and passes as many slots as there are.
fn around(latency: u32) -> [Proof; 6] {
    let of = |name, harness, method| Proof::new(name, harness, latency, method);
    let one_job = &["PAIRS=3", "ONE_JOB"];
    [
        of("credits", "credits", Inductive(9 + latency)),
        of("any link, any host", "line_port", Bounded(23 + 2 * latency)).with(&["PAIRS=3"]),
        of("a job of one pair", "line_port", Bounded(44 + 2 * latency)).with(&["PAIRS=1", "ONE_JOB"]),
        of("one job", "line_port", Bounded(45 + 2 * latency)).with(one_job),
        of("a job ends", "line_port", Bounded(57 + 2 * latency))
            .with(&["PAIRS=2", "ONE_JOB", "PROMPT=1"])
            .ends(52 + 2 * latency),
        of("jobs are whole", "line_port", Reached(45 + 2 * latency)).with(one_job),
    ]
}

/// The proofs at an interval of 2, where pairs are handed out differently.
fn every_other(latency: u32) -> [Proof; 4] {
    let of = |name, design, harness, method| Proof::new(name, harness, latency, method).of(design);
    let three = Design::ThreeEveryOther;
    let one_job = &["PAIRS=3", "ONE_JOB"];
    [
        of("credits at interval 2", Design::EveryOther, "credits", Inductive(8 + latency)),
        of("credits of three at interval 2", three, "credits", Inductive(8 + latency)),
        of("one job at interval 2", three, "line_port", Bounded(46 + 2 * latency)).with(one_job),
        of("jobs at interval 2 are whole", three, "line_port", Reached(46 + 2 * latency)).with(one_job),
    ]
}

/// The proofs for jobs that return only hits: sieve, backlog, overflow.
fn of_hits(latency: u32) -> [Proof; 6] {
    let of = |name, design, harness, method| Proof::new(name, harness, latency, method).of(design);
    [
        of("credits of hits", Design::Hits, "credits", Inductive(10 + latency)),
        of("credits of records", Design::Records, "credits", Inductive(10 + latency)),
        of("one job of hits", Design::Hits, "hits_job", Bounded(47 + 2 * latency)),
        of("one job of records", Design::Records, "hits_job", Bounded(47 + 2 * latency)),
        of("jobs of hits are whole", Design::Hits, "hits_job", Reached(47 + 2 * latency)),
        of("jobs of records are whole", Design::Records, "hits_job", Reached(47 + 2 * latency)),
    ]
}

/// The proofs of the parts of the search among spheres. The step of an induction is as long as the part.
fn of_search() -> Vec<Proof> {
    let of = |name, harness, part, method| Proof::new(name, harness, 1, method).of(Design::Search(part));
    let short = ["decider", "shares of any step", "shares of a decider", "join of deciders", "begin of a job"];
    let proofs = [
        of("begin of a job", "begins", Part::Control, Inductive(2)),
        of("entry of rows", "entry", Part::Entry, Inductive(13)),
        of("rows enter", "entry", Part::Entry, Reached(70)),
        of("groups", "stage", Part::Groups, Inductive(9)),
        of("rows of groups", "stage", Part::GroupRows, Inductive(9)),
        of("near", "stage", Part::Near, Inductive(9)),
        of("box against box", "stage", Part::BoxPairs, Inductive(12)),
        of("rows pass a level", "stage", Part::GroupRows, Reached(24)),
        of("rows pass box against box", "stage", Part::BoxPairs, Reached(30)),
        of("decider", "decider", Part::Decider, Inductive(18)),
        of("shares are answered", "decider", Part::Decider, Reached(34)),
        of("shares of any step", "undecided", Part::Undecided, Inductive(2)).with(&["CHOSEN"]),
        of("shares of a decider", "undecided", Part::Undecided, Inductive(2)),
        of("a decider has many shares", "undecided", Part::Undecided, Reached(30)),
        of("join of deciders", "joined", Part::Join, Inductive(8)),
        of("steps are joined", "joined", Part::Join, Reached(24)),
    ];
    proofs.map(|proof| Proof { is_short: short.contains(&proof.name), ..proof }).into()
}

/// All proofs. The collector, the dispatcher and the parts of the shell `axi` on their own do not depend on the SCPUs.
pub fn proofs() -> Vec<Proof> {
    let alone = ["collector", "dispatcher"].map(|name| Proof::new(name, name, 1, Inductive(2)).short());
    let short = ["credits", "any link, any host", "a job of one pair", "jobs are whole"];
    let short_others = ["credits at interval 2", "credits of hits", "one job of hits"];
    let each = [1, 3].into_iter();
    let around = each.clone().flat_map(around);
    let around = around.map(|proof| Proof { is_short: proof.latency == 1 && short.contains(&proof.name), ..proof });
    let others = each.flat_map(|latency| every_other(latency).into_iter().chain(of_hits(latency)));
    let others =
        others.map(|proof| Proof { is_short: proof.latency == 1 && short_others.contains(&proof.name), ..proof });
    let axi = ["axi_reads", "axi_writes", "axi_lite"]
        .map(|name| Proof::new(name, name, 1, Inductive(2)).of(Design::Axi).short());
    let whole_ways = [
        Proof::new("a read's whole way", "axi_read_lines", 1, Bounded(20)),
        Proof::new("reads are whole", "axi_read_lines", 1, Reached(20)),
        Proof::new("a write's whole way", "axi_write_lines", 1, Bounded(23)),
        Proof::new("writes are whole", "axi_write_lines", 1, Reached(23)),
    ];
    let axi = axi.into_iter().chain(whole_ways.map(|proof| proof.of(Design::Axi)));
    let queue = [
        Proof::new("queue", "queue", 1, Inductive(2)),
        Proof::new("order in a queue", "queue", 1, Bounded(24)).with(&["ORDER"]),
        Proof::new("a queue is full", "queue", 1, Reached(30)),
    ];
    let queue = queue.map(|proof| proof.of(Design::Queue).short());
    alone.into_iter().chain(queue).chain(of_search()).chain(axi).chain(around).chain(others).collect()
}

/// The proof with this name, at the smallest latency.
pub fn proof(name: &str) -> Proof {
    proofs().into_iter().find(|proof| proof.name == name).unwrap_or_else(|| panic!("no proof is called {name}"))
}

/// Harness and name of every assertion in the proofs.
pub fn properties() -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    let mut harnesses: Vec<_> = proofs().iter().map(|proof| proof.harness).collect();
    harnesses.sort_unstable();
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
