//! Mutants of the controller: each is a small change of the generated Verilog and names the property that it breaks.

mod axi;
mod others;
mod parts;
mod search;
mod spheres;
mod whole;

use crate::proofs::{Method, Proof, proof};

#[derive(Clone, Copy, Debug)]
pub struct Mutant {
    /// A description of the fault.
    pub what: &'static str,
    pub file: &'static str,
    /// The original text, which occurs exactly once and is replaced by `new`.
    pub old: &'static str,
    pub new: &'static str,
    /// The name of the proof that is run on it.
    pub tried_in: &'static str,
    /// The first cycle after power-up in which the property fails.
    pub cycle: u32,
    pub breaks: &'static str,
    /// True if the test command runs it.
    pub is_short: bool,
}

impl Mutant {
    /// The proof that it breaks, at the cycle in which the property fails.
    pub fn proof(&self) -> Proof {
        Proof { method: Method::At(self.cycle), ..proof(self.tried_in) }
    }

    /// The accelerator with this change.
    pub fn files(&self) -> Vec<(String, String)> {
        let mut files = proof(self.tried_in).files();
        let (_, text) = files.iter_mut().find(|(name, _)| name == self.file).expect("a file of the accelerator");
        assert_eq!(text.matches(self.old).count(), 1, "{}: one `{}` in\n{text}", self.file, self.old);
        assert_ne!(self.old, self.new);
        *text = text.replacen(self.old, self.new, 1);
        files
    }
}

/// Mutants of one file that share a proof: fault, old text, new text, cycle, property.
type Rows = &'static [(&'static str, &'static str, &'static str, u32, &'static str)];

/// One mutant of each kind, for the test command.
const SHORT: [&str; 11] = [
    "lines go out before they came",
    "responses to earlier jobs count",
    "slots are freed by earlier jobs",
    "a pair takes eight places",
    "the first line is asked for again",
    "done at once",
    "bursts of reads cross 4 KB",
    "WLAST at the end of each line",
    "a response without the data",
    "an answer for each candidate",
    "a step does not wait for an answer",
];

pub fn all() -> Vec<Mutant> {
    let tables = parts::TABLES
        .iter()
        .chain(whole::TABLES)
        .chain(others::TABLES)
        .chain(axi::TABLES)
        .chain(spheres::TABLES)
        .chain(search::TABLES);
    let mutants = tables.flat_map(|(tried_in, file, rows)| {
        rows.iter().map(|&(what, old, new, cycle, breaks)| {
            let is_short = SHORT.contains(&what);
            Mutant { what, file, old, new, tried_in, cycle, breaks, is_short }
        })
    });
    mutants.collect()
}
