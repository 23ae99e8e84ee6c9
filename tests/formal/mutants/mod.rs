//! Faults of the controller, each a small change of generated Verilog, and the property that it breaks.

mod parts;
mod whole;

use crate::design;
use crate::proofs::{Method, Proof, proof};

/// A change of one file.
#[derive(Clone, Copy, Debug)]
pub struct Mutant {
    /// The fault.
    pub what: &'static str,
    pub file: &'static str,
    /// This text, of which there is one, becomes the other.
    pub old: &'static str,
    pub new: &'static str,
    /// The setting it is tried in.
    pub tried_in: &'static str,
    /// The cycles in which it must show.
    pub cycles: u32,
    /// The property that fails.
    pub breaks: &'static str,
    /// Whether the test command has it.
    pub is_short: bool,
}

impl Mutant {
    /// The proof that it breaks, bounded.
    pub fn proof(&self) -> Proof {
        Proof { method: Method::Bounded(self.cycles), ..*proof(self.tried_in) }
    }

    /// The accelerator with the change in it.
    pub fn files(&self) -> Vec<(String, String)> {
        let mut files = design::files(proof(self.tried_in).latency);
        let (_, text) = files.iter_mut().find(|(name, _)| name == self.file).expect("a file of the accelerator");
        assert_eq!(text.matches(self.old).count(), 1, "{}: one `{}` in\n{text}", self.file, self.old);
        assert_ne!(self.old, self.new);
        *text = text.replacen(self.old, self.new, 1);
        files
    }
}

/// Mutants of a file that are tried in one setting: fault, old text, new text, cycles, property.
type Rows = &'static [(&'static str, &'static str, &'static str, u32, &'static str)];

/// One of the kind in the test command.
const SHORT: [&str; 6] = [
    "lines go out before they came",
    "responses to earlier jobs count",
    "tags are used again",
    "a pair enters without room",
    "the first line is asked for again",
    "ends while a read is out",
];

/// All of them.
pub fn all() -> Vec<Mutant> {
    let tables = parts::TABLES.iter().chain(whole::TABLES);
    let mutants = tables.flat_map(|(tried_in, file, rows)| {
        rows.iter().map(|&(what, old, new, cycles, breaks)| {
            let is_short = SHORT.contains(&what);
            Mutant { what, file, old, new, tried_in, cycles, breaks, is_short }
        })
    });
    mutants.collect()
}
