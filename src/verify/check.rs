//! Compares the outcome of a job with the reference.

use std::fmt;

use super::mismatch::Mismatch;
use super::replay::Setup;
use crate::config::{Config, Results};
use crate::cosim::Outcome;
use crate::count::counted;
use crate::host::received::{Records, by_pair};
use crate::kernel::settle;
use crate::query::{ContactRecord, Fields, Flow, PairRecord, Query};
use crate::record::{Contacts, Layout};

/// The number of mismatches that a verdict's text shows in full.
const SHOWN: usize = 3;

/// The verdict on a job. Its text says whether the job is good, and otherwise what is wrong and how to run it again.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The AFU, the link and the seed.
    pub setup: Setup,
    /// The number of pairs in the job.
    pub pairs: usize,
    /// The contacts in destination memory, with unsettled pairs resolved by the host: one per pair, or only those that
    /// touch. Words that were not written or not asked for are zero.
    pub contacts: Vec<ContactRecord>,
    /// For each record in `contacts`, the number of its pair in the job, from 0.
    pub numbers: Vec<u32>,
    /// The number of records that the AFU left to the host, which resolved them.
    pub unsettled: u64,
    /// Records that differ from the reference's.
    pub mismatches: Vec<Mismatch>,
    /// Other checks that failed: status, counters, unused bits.
    pub failed_checks: Vec<String>,
    /// The outcome of the job.
    pub outcome: Outcome,
    /// Seconds of simulation, without building the model and without the reference.
    pub seconds: f64,
}

impl Verdict {
    /// True if no check failed.
    pub fn is_good(&self) -> bool {
        self.mismatches.is_empty() && self.failed_checks.is_empty()
    }

    /// Panics unless the verdict [is good](Self::is_good). This is for tests. The message is the verdict's text: the
    /// first mismatches, the failed checks, the seed and how to run the job again.
    ///
    /// # Panics
    /// If a record differs from the reference's, or another check failed.
    #[track_caller]
    pub fn assert_good(&self) {
        assert!(self.is_good(), "{self}");
    }

    /// The number of pairs of each flow, in the order of [`Flow::ALL`]. One-bit records and contacts alone do not
    /// distinguish invalid pairs from those without a contact, so the AFU's own count is used there.
    pub fn flows(&self, config: &Config) -> [u64; 4] {
        let of = |flow| self.contacts.iter().filter(|contact| contact.flow() == Some(flow)).count() as u64;
        let mut flows = Flow::ALL.map(of);
        if config.contact == Fields::HIT || config.results == Results::Hits {
            let invalid = u64::from(self.outcome.invalid);
            let touching = flows[Flow::Coincident as usize] + flows[Flow::Real as usize];
            flows[Flow::Invalid as usize] = invalid;
            flows[Flow::Fake as usize] = (self.pairs as u64).saturating_sub(touching + invalid);
        }
        flows
    }

    /// A contact for each pair, in their order. If only contacts came back, the other pairs read as no contact.
    pub fn by_pair(&self) -> Vec<ContactRecord> {
        by_pair(self.pairs, &self.numbers, &self.contacts)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { setup, pairs, mismatches, failed_checks, .. } = self;
        if self.is_good() {
            return write!(f, "{}, every bit as in the reference", counted(*pairs as u64, "pair"));
        }
        write!(
            f,
            "{} of {} differ from the reference, {} failed",
            mismatches.len(),
            counted(*pairs as u64, "record"),
            counted(failed_checks.len() as u64, "other check")
        )?;
        for mismatch in mismatches.iter().take(SHOWN) {
            write!(f, "\nmismatch: {mismatch}")?;
        }
        if mismatches.len() > SHOWN {
            write!(f, "\n({} more mismatches)", mismatches.len() - SHOWN)?;
        }
        for check in failed_checks {
            write!(f, "\nfailed check: {check}")?;
        }
        write!(f, "\nreplay: {setup}")
    }
}

/// Compares a job's outcome with the reference's records.
pub(super) fn check(
    layout: &Layout,
    setup: Setup,
    pairs: &[PairRecord],
    reference: &[ContactRecord],
    outcome: Outcome,
    seconds: f64,
) -> Verdict {
    let memory = Contacts::new(layout, &outcome.lines);
    let mut failed_checks = Vec::new();
    if let Some(error) = outcome.job_error() {
        let failure = outcome.failure.map_or_else(String::new, |failure| format!(": {failure}"));
        failed_checks.push(format!("the job ended with error {} ({error:?}){failure}", outcome.error));
    }
    let job = Job { query: layout.query(), pairs, reference, memory: &memory, outcome: &outcome };
    let received = if layout.number_bits() > 0 { job.hits(&mut failed_checks) } else { job.all() };
    if !memory.rest_is_zero(received.records) {
        failed_checks.push("unused bits of the destination lines are not zero".to_owned());
    }
    job.status(&mut failed_checks);
    let Received { numbers, mut contacts, mismatches, .. } = received;
    // With contacts alone as results, nothing is unsettled, because the profile exact refuses this combination.
    let unsettled = if layout.number_bits() > 0 { 0 } else { settle(pairs, &mut contacts, setup.config.contact) };
    Verdict { setup, pairs: pairs.len(), contacts, numbers, unsettled, mismatches, failed_checks, outcome, seconds }
}

/// The parts of a comparison.
struct Job<'a> {
    query: Query,
    pairs: &'a [PairRecord],
    reference: &'a [ContactRecord],
    memory: &'a Contacts<'a>,
    outcome: &'a Outcome,
}

/// The contents of destination memory.
#[derive(Default)]
struct Received {
    /// The number of records that must be in destination memory.
    records: usize,
    numbers: Vec<u32>,
    contacts: Vec<ContactRecord>,
    mismatches: Vec<Mismatch>,
}

impl Job<'_> {
    fn mismatch(
        &self,
        number: usize,
        index: Option<usize>,
        expected: ContactRecord,
        got: Option<ContactRecord>,
    ) -> Mismatch {
        let written = |index| self.outcome.write_cycles.get(self.memory.line(index)).copied().flatten();
        Mismatch { query: self.query, number, cycle: index.and_then(written), pair: self.pairs[number], expected, got }
    }

    /// A record for each pair.
    fn all(&self) -> Received {
        let mut received = Received { records: self.pairs.len(), ..Received::default() };
        for (number, &record) in self.reference.iter().enumerate() {
            let (expected, got) = (self.memory.as_stored(record), self.memory.get(number));
            received.numbers.push(number as u32);
            received.contacts.push(got.unwrap_or_default());
            if got != Some(expected) {
                received.mismatches.push(self.mismatch(number, Some(number), expected, got));
            }
        }
        received
    }

    /// A record for each pair that touches: as many as the AFU counted, in the order of their numbers, and nothing
    /// after them.
    fn hits(&self, failed_checks: &mut Vec<String>) -> Received {
        let (records, error) = Records::hits(self.memory, self.pairs.len(), self.outcome.contacts);
        failed_checks.extend(error.map(|error| error.to_string()));
        let Records { numbers, contacts } = records;
        let mut received =
            Received { records: self.outcome.contacts as usize, numbers, contacts, ..Received::default() };
        // The layout of the pairs' records.
        let mut place = vec![None; self.pairs.len()];
        for (index, &number) in received.numbers.iter().enumerate() {
            place[number as usize] = Some(index);
        }
        let lines = received.records.checked_sub(1).map_or(0, |last| self.memory.line(last) + 1);
        if self.outcome.lines.iter().skip(lines).any(Option::is_some) {
            failed_checks.push("a line behind the last contact's was written".to_owned());
        }
        for (number, (&record, &index)) in self.reference.iter().zip(&place).enumerate() {
            let expected = record.is_contact().then(|| self.memory.as_stored(record));
            let got = index.map(|index| received.contacts[index]);
            if got != expected {
                received.mismatches.push(self.mismatch(number, index, expected.unwrap_or_default(), got));
            }
        }
        received
    }

    /// Checks the AFU's status and counters of the job.
    fn status(&self, failed_checks: &mut Vec<String>) {
        let (reference, outcome) = (self.reference, self.outcome);
        let count = |test: fn(&ContactRecord) -> bool| reference.iter().filter(|record| test(record)).count();
        let hits = count(|record| record.is_contact());
        let invalid = count(|record| record.flow() == Some(Flow::Invalid));
        let first = reference.iter().position(|record| record.flow() == Some(Flow::Invalid));
        let mut counter = |what: &str, got: String, expected: String| {
            if got != expected {
                failed_checks.push(format!("status: {what} is {got}, should be {expected}"));
            }
        };
        counter("contacts", outcome.contacts.to_string(), hits.to_string());
        counter("invalid", outcome.invalid.to_string(), invalid.to_string());
        let number = |pair: Option<usize>| pair.map_or_else(|| "none".to_owned(), |pair| pair.to_string());
        counter("first_invalid", number(outcome.first_invalid.map(|pair| pair as usize)), number(first));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use expect_test::expect;

    use crate::kernel::Reference;
    use crate::link::LinkModel;
    use crate::number::Format;

    /// The outcome of a job whose destination holds only these records, one per line.
    fn outcome(records: &[(u32, ContactRecord)], lines: usize) -> Outcome {
        let line = |(number, contact): &(u32, ContactRecord)| {
            let mut line = [0; 16];
            line[0] = *number;
            line[1..9].copy_from_slice(&contact.0);
            Some(line)
        };
        let mut all: Vec<_> = records.iter().map(line).collect();
        all.resize(lines, None);
        Outcome {
            cycles: 10,
            error: 0,
            failure: None,
            candidates: None,
            contacts: records.len() as u32,
            invalid: 0,
            first_invalid: None,
            cycles_busy: 9,
            cycles_input: 0,
            cycles_output: 0,
            latency_cycles: None,
            bytes_read: 0,
            bytes_written: 0,
            limit_cycles: 1.0,
            write_cycles: vec![Some(5); lines],
            lines: all,
        }
    }

    #[test]
    fn hits_that_are_missing_wrong_twice_or_too_many_are_found() {
        let config = Config { results: Results::Hits, ..Config::default() };
        let layout = Layout::of(512, &config);
        let pair = |x: f32| PairRecord::from_spheres([0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0, 1.0]);
        let pairs = [9.0, 1.0, 8.0, 0.0, 1.5].map(pair);
        let reference = Reference::new(Format::WIDE, config.contact).run_all(&pairs);
        let hit = |number: usize| (number as u32, reference[number]);
        let setup = || Setup { config: config.clone(), folder: None, link: LinkModel::late(), seed: 7 };
        let judge =
            |records: &[(u32, ContactRecord)]| check(&layout, setup(), &pairs, &reference, outcome(records, 5), 0.0);

        let right = judge(&[hit(1), hit(3), hit(4)]);
        assert!(right.is_good(), "{right:?}");
        assert_eq!((right.pairs, right.numbers.as_slice()), (5, [1, 3, 4].as_slice()));
        assert_eq!(right.flows(&config), [0, 2, 1, 2]);
        assert_eq!(right.by_pair(), reference);

        let wrong = |records: &[(u32, ContactRecord)]| {
            let verdict = judge(records);
            let numbers: Vec<_> = verdict.mismatches.iter().map(|mismatch| mismatch.number).collect();
            (numbers, verdict.failed_checks.len())
        };
        let mut flipped = hit(3);
        flipped.1.0[6] ^= 1;
        assert_eq!(wrong(&[hit(1), flipped, hit(4)]), (vec![3], 0));
        // One record too few or too many: the count is wrong too.
        assert_eq!(wrong(&[hit(1), hit(4)]), (vec![3], 1));
        assert_eq!(wrong(&[hit(0), hit(1), hit(3), hit(4)]), (vec![0], 1));
        // Out of order, repeated, or without a pair: the records that follow are not used.
        assert_eq!(wrong(&[hit(3), hit(1), hit(4)]), (vec![1, 4], 1));
        assert_eq!(wrong(&[hit(1), hit(1), hit(4)]), (vec![3, 4], 1));
        assert_eq!(wrong(&[hit(1), hit(3), (5, reference[4])]), (vec![4], 1));
        // A line that should not be there.
        let mut more = outcome(&[hit(1), hit(3), hit(4)], 5);
        more.lines[4] = Some([0; 16]);
        assert_eq!(
            check(&layout, setup(), &pairs, &reference, more, 0.0).failed_checks,
            ["a line behind the last contact's was written"]
        );
    }

    #[test]
    fn a_failed_verdict_names_mismatches_checks_seed_and_the_way_to_run_it_again() {
        let config = Config { scpus: 3, ..Config::default() };
        let pair = PairRecord::from_spheres([0.0, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.5]);
        let expected = Reference::new(Format::WIDE, config.contact).run_all(&[pair])[0];
        let mut got = expected;
        got.0[6] = 1;
        let mismatch =
            |number| Mismatch { query: Query::SphereSphere, number, cycle: Some(99), pair, expected, got: Some(got) };
        let mut verdict = Verdict {
            setup: Setup { config, folder: None, link: LinkModel::hostile(), seed: 7 },
            pairs: 1000,
            contacts: Vec::new(),
            numbers: Vec::new(),
            unsettled: 0,
            mismatches: Vec::new(),
            failed_checks: Vec::new(),
            outcome: outcome(&[], 0),
            seconds: 0.0,
        };
        verdict.assert_good();
        assert_eq!(verdict.to_string(), "1 000 pairs, every bit as in the reference");

        verdict.mismatches = [3, 5, 8, 13, 21].map(mismatch).to_vec();
        verdict.failed_checks = vec!["status: contacts is 5, should be 6".to_owned()];
        let panic = std::panic::catch_unwind(|| verdict.assert_good()).expect_err("it is not good");
        let text = panic.downcast_ref::<String>().expect("a message");
        // The pair's words are the same as in the text of a mismatch.
        let lines: Vec<_> = text.lines().filter(|line| !line.starts_with("  ") || line.contains("got")).collect();
        expect![[r#"
            5 of 1 000 records differ from the reference, 1 other check failed
            mismatch: pair 3, written in cycle 99
              depth     expected 00000000 (0.0), got 00000001 (1e-45)
            mismatch: pair 5, written in cycle 99
              depth     expected 00000000 (0.0), got 00000001 (1e-45)
            mismatch: pair 8, written in cycle 99
              depth     expected 00000000 (0.0), got 00000001 (1e-45)
            (2 more mismatches)
            failed check: status: contacts is 5, should be 6
            replay: the same pairs over the link `hostile` with seed 7; with the pairs in a file (pairs::write_pairs): afu cosim --scpus 3 --interval 1 --pairs PAIRS.csv --link hostile --seed 7"#]].assert_eq(&lines.join("\n"));
    }
}
