//! What came of a job, compared.

use super::lines::Contacts;
use crate::afu::Layout;
use crate::cosim::Outcome;
use crate::kernel::{ContactRecord, Fields, Flow, PairRecord};

/// One record that is not what it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// The pair's number in its job, from 0.
    pub number: usize,
    /// The cycle of the job in which its line was last written; none: it never was.
    pub cycle: Option<u64>,
    /// What went in.
    pub pair: PairRecord,
    /// What the reference kernel gives.
    pub expected: ContactRecord,
    /// What lies in destination memory; none: nothing does.
    pub got: Option<ContactRecord>,
}

/// What a job came to.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The contacts, from destination memory; zero words where nothing was written, and for what is not asked for.
    pub contacts: Vec<ContactRecord>,
    /// Records that differ from the reference's.
    pub mismatches: Vec<Mismatch>,
    /// What else is not as it should be: status, counters, unused bits.
    pub unmet: Vec<String>,
    /// The job as the driver saw it.
    pub outcome: Outcome,
    /// Seconds the simulation took, without building the model and without the reference.
    pub seconds: f64,
}

impl Verdict {
    /// Whether everything is as it should be.
    pub fn is_good(&self) -> bool {
        self.mismatches.is_empty() && self.unmet.is_empty()
    }

    /// Contacts of each flow, in the order of [`Flow::ALL`]. One-bit records tell no invalid pairs apart from those
    /// without contact: there the AFU's own count is taken.
    pub fn flows(&self, fields: Fields) -> [u64; 4] {
        let of = |flow| self.contacts.iter().filter(|contact| contact.flow() == Some(flow)).count() as u64;
        let mut flows = Flow::ALL.map(of);
        if fields == Fields::HIT {
            let invalid = u64::from(self.outcome.invalid);
            flows[Flow::Invalid as usize] = invalid;
            flows[Flow::Fake as usize] = flows[Flow::Fake as usize].saturating_sub(invalid);
        }
        flows
    }
}

/// Compares a job's outcome with the reference's records.
pub(super) fn check(
    layout: &Layout,
    pairs: &[PairRecord],
    reference: &[ContactRecord],
    outcome: Outcome,
    seconds: f64,
) -> Verdict {
    let mut verdict = Verdict {
        contacts: Vec::with_capacity(pairs.len()),
        mismatches: Vec::new(),
        unmet: Vec::new(),
        outcome,
        seconds,
    };
    let Verdict { contacts, mismatches, unmet, outcome, .. } = &mut verdict;
    let memory = Contacts::new(layout, &outcome.lines);
    for (number, (&pair, &record)) in pairs.iter().zip(reference).enumerate() {
        let (expected, got) = (memory.seen(record), memory.get(number));
        contacts.push(got.unwrap_or_default());
        if got != Some(expected) {
            let cycle = outcome.write_cycles.get(memory.line(number)).copied().flatten();
            mismatches.push(Mismatch { number, cycle, pair, expected, got });
        }
    }
    if let Some(error) = outcome.job_error() {
        unmet.push(format!("the job ended with error {} ({error:?})", outcome.error));
    }
    if !memory.rest_is_zero(pairs.len()) {
        unmet.push("unused bits of the destination lines are not zero".to_owned());
    }
    let count = |test: fn(&ContactRecord) -> bool| reference.iter().filter(|record| test(record)).count();
    let hits = count(|record| record.is_contact());
    let invalid = count(|record| record.flow() == Some(Flow::Invalid));
    let first = reference.iter().position(|record| record.flow() == Some(Flow::Invalid));
    let mut counter = |what: &str, got: String, expected: String| {
        if got != expected {
            unmet.push(format!("status: {what} is {got}, should be {expected}"));
        }
    };
    counter("contacts", outcome.contacts.to_string(), hits.to_string());
    counter("invalid", outcome.invalid.to_string(), invalid.to_string());
    let number = |pair: Option<usize>| pair.map_or_else(|| "none".to_owned(), |pair| pair.to_string());
    counter("first_invalid", number(outcome.first_invalid.map(|pair| pair as usize)), number(first));
    verdict
}
