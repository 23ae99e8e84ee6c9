//! Spheres through a simulated AFU, and what it found compared with the search in software.

use std::path::Path;
use std::time::Instant;

use super::Bench;
use super::error::VerifyError;
use crate::cosim::{CosimError, Outcome};
use crate::host::simulated::{Given, Run};
use crate::host::spheres::search_work;
use crate::link::LinkModel;
use crate::query::ContactRecord;
use crate::record::{Contacts, SetTooLarge, numbers_of, sphere_lines};
use crate::spheres::{Counts, Hit, Search, Spheres, join_tiles, tiles};

/// The verdict on a job of spheres.
#[derive(Clone, Debug)]
pub struct SpheresVerdict {
    /// The spheres that touch, as they lie in memory: the number of the first, and of the second.
    pub hits: Vec<[u32; 2]>,
    /// The contact of each of them, with the fields of the configuration. Other fields are zero.
    pub contacts: Vec<ContactRecord>,
    /// Spheres of both sets.
    pub spheres: u64,
    /// The number of jobs that they were cut into, 1 if they were not cut.
    pub jobs: u64,
    /// The comparisons that the same search takes in software.
    pub counts: Counts,
    /// The number of hits that differ from the software's.
    pub mismatches: u64,
    /// What differs, and other checks that failed.
    pub failed_checks: Vec<String>,
    /// The outcome of the job.
    pub outcome: Outcome,
    /// Seconds of simulation.
    pub seconds: f64,
}

impl SpheresVerdict {
    /// True if no check failed.
    pub fn is_good(&self) -> bool {
        self.failed_checks.is_empty()
    }

    /// The verdict on this tile and another one. Hits keep the numbers of their tiles.
    fn and(mut self, other: Self) -> Self {
        let (a, b) = (self.counts, other.counts);
        let both = |of: fn(&Outcome) -> u64| of(&self.outcome) + of(&other.outcome);
        let outcome = Outcome {
            cycles: both(|outcome| outcome.cycles),
            contacts: self.outcome.contacts.saturating_add(other.outcome.contacts),
            candidates: self.outcome.candidates.zip(other.outcome.candidates).map(|(a, b)| a.saturating_add(b)),
            cycles_busy: both(|outcome| outcome.cycles_busy),
            cycles_input: both(|outcome| outcome.cycles_input),
            cycles_output: both(|outcome| outcome.cycles_output),
            bytes_read: both(|outcome| outcome.bytes_read),
            bytes_written: both(|outcome| outcome.bytes_written),
            limit_cycles: self.outcome.limit_cycles + other.outcome.limit_cycles,
            ..self.outcome
        };
        self.failed_checks.extend(other.failed_checks);
        Self {
            jobs: self.jobs + other.jobs,
            counts: Counts {
                group_tests: a.group_tests + b.group_tests,
                row_tests: a.row_tests + b.row_tests,
                sphere_tests: a.sphere_tests + b.sphere_tests,
                column_tests: a.column_tests + b.column_tests,
                candidates: a.candidates + b.candidates,
                invalid: a.invalid,
            },
            mismatches: self.mismatches + other.mismatches,
            seconds: self.seconds + other.seconds,
            outcome,
            ..self
        }
    }

    pub(super) fn hits_with_contacts(&self) -> impl Iterator<Item = Hit> {
        self.hits.iter().zip(&self.contacts).map(|(&spheres, &contact)| Hit { spheres, contact })
    }
}

impl Bench {
    /// Sends spheres through the AFU over a link, and compares the hits and their order with the search in software.
    /// `seed` decides the link's randomness and the initial values of registers without a reset.
    ///
    /// # Errors
    /// Returns an error if there are more spheres than the AFU takes, if the job does not finish, or if the AFU
    /// breaks the protocol of its ports. Differences are not errors.
    pub fn run_spheres(
        &self,
        sets: &Spheres,
        link: &LinkModel,
        seed: u64,
        waveform: Option<&Path>,
    ) -> Result<SpheresVerdict, VerifyError> {
        let config = self.config();
        let (first, second) = (&sets.first, sets.second.as_deref());
        let others = second.unwrap_or_default();
        SetTooLarge::check(first.len(), others.len(), config.search.table)?;
        let search = Search::new(config.profile.arithmetic(), config.search.box_bits)?;
        let mut reference = config.reference();
        let found = search.find(&mut reference, first, second).map_err(VerifyError::Reference)?;
        let expected = &found.hits;

        let contacts = expected.len() as u64;
        let lines = sphere_lines(first.len() as u64) + sphere_lines(others.len() as u64);
        let given = Given::Spheres { sets, contacts, search: search_work(&found.counts, contacts, lines) };
        let run = Run { config, expected: self.expected, given, seed, progress: &mut |_| {} };
        let begun = Instant::now();
        let instance = self.model().instance(seed)?;
        if let Some(path) = waveform {
            let half_period_ps = (500.0 * config.cycle_ns()).round() as u64;
            instance.trace_open(path, half_period_ps).map_err(CosimError::from)?;
        }
        let outcome: Result<_, VerifyError> = run.on(&instance, link.clone());
        // The waveform of a failed job is the most useful one.
        let closed = if waveform.is_some() { instance.trace_close() } else { Ok(()) };
        let outcome = outcome?;
        closed.map_err(CosimError::from)?;
        let seconds = begun.elapsed().as_secs_f64();

        let layout = self.expected.layout;
        let stored = Contacts::new(&layout, &outcome.lines);
        let hit = |index: usize| {
            let (numbers, contact) = stored.hit(index)?;
            Some(Hit { spheres: numbers_of(numbers), contact })
        };
        let hits: Vec<_> = (0..expected.len()).map(hit).collect();
        let mut failed_checks = Vec::new();
        if let Some(error) = outcome.job_error() {
            failed_checks.push(format!("the job ended with error {} ({error:?})", outcome.error));
        }
        let wanted = |hit: &Hit| Hit { contact: stored.as_stored(hit.contact), ..*hit };
        let differing: Vec<_> = (0..expected.len()).filter(|&hit| hits[hit] != Some(wanted(&expected[hit]))).collect();
        if let Some(&hit) = differing.first() {
            let text = |hit: Option<Hit>| {
                hit.map_or("nothing".to_owned(), |Hit { spheres: [i, j], contact }| {
                    format!("{i} and {j} with {:08x?}", contact.0)
                })
            };
            failed_checks.push(format!(
                "{} of {} hits differ; the first is hit {hit}: expected spheres {}, found {}",
                differing.len(),
                expected.len(),
                text(Some(wanted(&expected[hit]))),
                text(hits[hit])
            ));
        }
        if !stored.rest_is_zero(expected.len()) {
            failed_checks.push("unused bits of a line are not zero".to_owned());
        }
        let valid = |sphere: &crate::spheres::Sphere| !sphere.is_valid();
        let first_invalid = first.iter().chain(others).position(valid).map(|place| place as u64);
        let counts = [
            ("contacts", u64::from(outcome.contacts), expected.len() as u64),
            ("candidates", outcome.candidates.unwrap_or_default().into(), found.counts.candidates),
            ("invalid spheres", outcome.invalid.into(), found.counts.invalid),
            (
                "the number of the first invalid sphere",
                outcome.first_invalid.map_or(u64::MAX, u64::from),
                first_invalid.unwrap_or(u64::MAX),
            ),
        ];
        for (what, told, wanted) in counts {
            if told != wanted {
                failed_checks.push(format!("{what}: the AFU counted {told}, the software {wanted}"));
            }
        }
        Ok(SpheresVerdict {
            hits: hits.iter().flatten().map(|hit| hit.spheres).collect(),
            contacts: hits.iter().flatten().map(|hit| hit.contact).collect(),
            spheres: (first.len() + others.len()) as u64,
            jobs: 1,
            counts: found.counts,
            mismatches: differing.len() as u64,
            failed_checks,
            outcome,
            seconds,
        })
    }

    /// The same for sets of any size: a job for every two tiles of at most `size` spheres, one after the other. What
    /// they find together is compared with the search of the whole sets.
    ///
    /// # Errors
    /// Returns an error if no tile has this size, and the errors of [`run_spheres`](Self::run_spheres).
    pub fn run_spheres_in_tiles(
        &self,
        sets: &Spheres,
        size: u32,
        link: &LinkModel,
        seed: u64,
    ) -> Result<SpheresVerdict, VerifyError> {
        let config = self.config();
        let (mut hits, mut joined) = (Vec::new(), None::<SpheresVerdict>);
        for (number, tile) in tiles(sets, size, config.search.table)?.enumerate() {
            let mut verdict = self.run_spheres(&tile.sets, link, seed, None)?;
            verdict.failed_checks.iter_mut().for_each(|check| *check = format!("tile {number}: {check}"));
            hits.extend(tile.translate(verdict.hits_with_contacts()));
            joined = Some(match joined {
                None => verdict,
                Some(before) => before.and(verdict),
            });
        }
        join_tiles(&mut hits);
        let Some(mut joined) = joined else { return self.run_spheres(sets, link, seed, None) };
        let (first, second) = (&sets.first, sets.second.as_deref());
        let search = Search::new(config.profile.arithmetic(), config.search.box_bits)?;
        let found = search.find(&mut config.reference(), first, second).map_err(VerifyError::Reference)?;
        let stored = Contacts::new(&self.expected.layout, &[]);
        let wanted = found.hits.iter().map(|hit| Hit { contact: stored.as_stored(hit.contact), ..*hit });
        if !wanted.eq(hits.iter().copied()) {
            joined.failed_checks.push(format!(
                "the tiles together: {} hits, which are not the {} of the whole search",
                hits.len(),
                found.hits.len()
            ));
        }
        // Tiles count a sphere as often as it is sent.
        let others = second.unwrap_or_default();
        joined.counts.invalid = found.counts.invalid;
        joined.outcome.invalid = found.counts.invalid as u32;
        joined.spheres = (first.len() + others.len()) as u64;
        joined.hits = hits.iter().map(|hit| hit.spheres).collect();
        joined.contacts = hits.iter().map(|hit| hit.contact).collect();
        Ok(joined)
    }
}
