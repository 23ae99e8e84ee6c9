//! Transactions whose jobs are spheres: sets go in, the numbers of spheres that touch come out.

use super::error::{HitError, HostError};
use super::open::Open;
use super::report::Report;
use super::session::Session;
use super::task::Task;
use super::transaction::{Done, Loaded, Pointed, Retrieved, Transaction};
use super::transport::Transport;
use crate::config::Input;
use crate::outcome::Outcome;
use crate::patience::SearchWork;
use crate::query::ContactRecord;
use crate::record::{Contacts, Layout, SetTooLarge, numbers_of, pack_spheres, sphere_lines};
use crate::spheres::{Counts, ROW, Sphere, Spheres};

/// Cycles that a row takes besides its comparisons, at most.
const CYCLES_OF_A_ROW: u64 = 64;

/// A job of spheres, as a transaction knows it after step 2.
#[derive(Clone, Copy, Debug)]
pub struct SpheresJob {
    /// Spheres in the table.
    first: u32,
    /// Spheres of the second set; `None` if there is one set.
    second: Option<u32>,
}

/// The spheres that touch, with what the AFU reported at the end of the job.
#[derive(Clone, Debug, PartialEq)]
pub struct SpheresResults {
    /// The numbers of every two spheres that touch, from 0, as [`Hit::spheres`](crate::spheres::Hit::spheres), and in
    /// the order of [`Candidates::pairs`](crate::spheres::Candidates::pairs).
    pub hits: Vec<[u32; 2]>,
    /// The contact of each of them, with the fields of the AFU. Other fields are zero.
    pub contacts: Vec<ContactRecord>,
    /// The number of pairs of spheres whose boxes meet, as the AFU counted them.
    pub candidates: u32,
    /// The number of invalid spheres that the AFU counted.
    pub invalid: u32,
    /// The number of the first invalid sphere, counted through the sets that were sent.
    pub first_invalid: Option<u32>,
    /// The cycles of the transaction's phases.
    pub report: Report,
}

impl SpheresResults {
    /// Succeeds if every sphere that was sent was valid.
    ///
    /// # Errors
    /// Returns [`HostError::InvalidSpheres`], which names the first invalid sphere of `sent` and its field.
    pub fn strict(&self, sent: &Spheres) -> Result<(), HostError> {
        let Some(first) = self.first_invalid else { return Ok(()) };
        let spheres = sent.first.iter().chain(sent.second.iter().flatten());
        let field = spheres.copied().nth(first as usize).and_then(Sphere::broken).unwrap_or("word");
        Err(HostError::InvalidSpheres { count: self.invalid, first, field })
    }
}

impl<'s, T: Transport> Transaction<'s, T, Pointed> {
    /// Step 2 with spheres, for an AFU that takes them: puts the sets into the source and starts SPL. The AFU finds
    /// which spheres of the first set touch each other or, with a second set, which touch which of those.
    ///
    /// ```
    /// use contact_afu::config::{Config, Input, Results, Shell};
    /// use contact_afu::spheres::{Sphere, Spheres};
    /// use contact_afu::{host::*, link::LinkModel};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let config = Config {
    ///     input: Input::Spheres,
    ///     results: Results::Hits,
    ///     contact: "hit".parse()?,
    ///     shell: Shell::Axi,
    ///     ..Config::default()
    /// };
    /// let first = [[0.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0, 1.0], [1.5, 0.0, 0.0, 1.0]].map(Sphere::new).to_vec();
    /// let sets = Spheres { first, second: None };
    ///
    /// let expected = Expected::new(&config)?;
    /// let workspace = Workspace::for_spheres(expected.layout, [3, 0], 100)?; // room for 100 contacts
    /// let mut session = Session::new(Software::new(&config, LinkModel::ideal())?, workspace, expected);
    /// let done = session.transaction().send_spheres(&sets)?.start()?.confirm()?.wait()?;
    /// assert_eq!(done.retrieve()?.end()?.hits, [[0, 2]]);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Returns an error if the AFU takes pairs, if there are more spheres than its table or the source holds, if no
    /// AFU_ID arrives or another one than expected, or if the device breaks its protocol.
    pub fn send_spheres(self, sets: &Spheres) -> Result<Transaction<'s, T, Loaded<SpheresJob>>, HostError> {
        self.send_spheres_within(sets, most_search_work(sets))
    }

    /// The same for a search that is known to take no more than this.
    pub(crate) fn send_spheres_within(
        mut self,
        sets: &Spheres,
        search: SearchWork,
    ) -> Result<Transaction<'s, T, Loaded<SpheresJob>>, HostError> {
        let job = self.open.load_spheres(sets, search)?;
        self.open.set_up()?;
        Ok(self.to(|_| Loaded { job }))
    }
}

impl<'s, T: Transport, J> Transaction<'s, T, Done<J>> {
    /// Step 2 again with spheres, for another job, while SPL and the AFU stay enabled.
    ///
    /// # Errors
    /// Returns an error if the AFU takes pairs, or if there are more spheres than its table or the source holds.
    pub fn send_next_spheres(mut self, sets: &Spheres) -> Result<Transaction<'s, T, Loaded<SpheresJob>>, HostError> {
        let job = self.open.load_spheres(sets, most_search_work(sets))?;
        Ok(self.to(|_| Loaded { job }))
    }
}

impl<'s, T: Transport> Transaction<'s, T, Done<SpheresJob>> {
    /// Step 6: takes the hits from the destination.
    ///
    /// # Errors
    /// Returns [`HostError::Job`] if the AFU ended the job with an error: with error 6 the destination has no room for
    /// all contacts, of which [`outcome`](Self::outcome) has the number. Returns [`HostError::Hit`] if memory does not
    /// hold what the status promises.
    pub fn retrieve(mut self) -> Result<Transaction<'s, T, Retrieved<SpheresResults>>, HostError> {
        let outcome = self.outcome();
        let results = self.open.hits(&self.state.job, &outcome)?;
        Ok(self.to(|_| Retrieved { results }))
    }
}

impl<'s, T: Transport> Transaction<'s, T, Retrieved<SpheresResults>> {
    /// Step 2 again with spheres, for another job, while SPL and the AFU stay enabled.
    ///
    /// # Errors
    /// Returns an error if there are more spheres than the AFU's table or the source holds.
    pub fn send_next_spheres(mut self, sets: &Spheres) -> Result<Transaction<'s, T, Loaded<SpheresJob>>, HostError> {
        let job = self.open.load_spheres(sets, most_search_work(sets))?;
        Ok(self.to(|_| Loaded { job }))
    }

    /// Step 2 again with a second set alone: the first set of the last job is still in the AFU's table.
    ///
    /// # Errors
    /// Returns an error if there are more spheres than a job can have or the source holds.
    pub fn send_against(mut self, others: &[Sphere]) -> Result<Transaction<'s, T, Loaded<SpheresJob>>, HostError> {
        let job = self.open.load_against(others)?;
        Ok(self.to(|_| Loaded { job }))
    }

    /// Step 7: stops SPL and frees the workspace.
    ///
    /// # Errors
    /// Returns the device's protocol errors since then.
    pub fn end(mut self) -> Result<SpheresResults, HostError> {
        let report = self.open.end()?;
        Ok(SpheresResults { report, ..self.state.results })
    }
}

impl<T: Transport> Session<T> {
    /// The spheres that touch, from one transaction with an AFU that takes spheres.
    ///
    /// # Errors
    /// Returns the errors of the steps of [`Transaction`].
    pub fn find(&mut self, sets: &Spheres) -> Result<SpheresResults, HostError> {
        self.transaction().send_spheres(sets)?.start()?.confirm()?.wait()?.retrieve()?.end()
    }
}

impl<T: Transport> Open<'_, T> {
    /// Replaces what is in the source by these sets, whose search takes at most this.
    fn load_spheres(&mut self, sets: &Spheres, search: SearchWork) -> Result<SpheresJob, HostError> {
        let table = self.session.table()?;
        let others = sets.second.as_deref();
        let (first, second) = (sets.first.len(), others.map(<[_]>::len));
        SetTooLarge::check(first, second.unwrap_or(0), table)?;
        // Neither is above what was just checked.
        let job = SpheresJob { first: first as u32, second: second.map(|spheres| spheres as u32) };
        let lines = [pack_spheres(&sets.first), pack_spheres(others.unwrap_or_default())].concat();
        let task = Task {
            count: job.first,
            others: job.second.unwrap_or(0),
            mode: others.is_some().into(),
            search,
            ..Task::default()
        };
        self.load_sets(&lines, task, first + second.unwrap_or(0))?;
        self.table = job.first;
        Ok(job)
    }

    /// Replaces what is in the source by a second set, for the first set that the AFU has in its table.
    fn load_against(&mut self, others: &[Sphere]) -> Result<SpheresJob, HostError> {
        SetTooLarge::check(0, others.len(), self.session.table()?)?;
        let job = SpheresJob { first: self.table, second: Some(others.len() as u32) };
        let search = most_search_work_of(job.first.into(), others.len() as u64);
        let task = Task { others: others.len() as u32, mode: 2, search, ..Task::default() };
        self.load_sets(&pack_spheres(others), task, others.len())?;
        Ok(job)
    }

    fn load_sets(&mut self, lines: &[[u32; 16]], task: Task, spheres: usize) -> Result<(), HostError> {
        let workspace = &self.session.workspace;
        let (source_lines, room) = (lines.len() as u64, workspace.source_room());
        if source_lines > room {
            return Err(HostError::TooManySpheres { lines: source_lines, room });
        }
        let task =
            Task { input: Input::Spheres, source_lines, destination_lines: workspace.destination_room(), ..task };
        self.report.pairs = 0;
        self.report.spheres = spheres as u64;
        self.load(lines.iter().copied(), task)
    }

    /// The hits of a job that ended well, and what the job took.
    fn hits(&mut self, job: &SpheresJob, outcome: &Outcome) -> Result<SpheresResults, HostError> {
        self.check_end(outcome)?;
        let (hits, contacts) = hits(job, self.session.workspace.layout(), outcome)?;
        Ok(SpheresResults {
            hits,
            contacts,
            candidates: outcome.candidates.unwrap_or(0),
            invalid: outcome.invalid,
            first_invalid: outcome.first_invalid,
            report: self.report_job(outcome),
        })
    }
}

/// The hits in the destination, which must be pairs of these sets in the order of the search, and their contacts.
fn hits(job: &SpheresJob, layout: &Layout, outcome: &Outcome) -> Result<(Vec<[u32; 2]>, Vec<ContactRecord>), HitError> {
    let (count, row) = (outcome.contacts, ROW as u32);
    let seconds = job.second.unwrap_or(job.first);
    let stored = Contacts::new(layout, &outcome.lines);
    let (mut hits, mut contacts) = (Vec::new(), Vec::new());
    let mut before = None;
    for index in 0..count as usize {
        let Some((numbers, contact)) = stored.hit(index) else { return Err(HitError::Unwritten { index, count }) };
        let [first, second] = numbers_of(numbers);
        let place = [second / row, first / row, second, first];
        let exists = first < job.first && second < seconds && (job.second.is_some() || first < second);
        if !exists || before >= Some(place) {
            return Err(HitError::Spheres { index, spheres: [first, second], sets: [job.first, seconds] });
        }
        before = Some(place);
        hits.push([first, second]);
        contacts.push(contact);
    }
    Ok((hits, contacts))
}

/// More than a search takes: every comparison and every hit by itself, and what a row takes besides.
pub(crate) fn search_work(counts: &Counts, hits: u64, lines: u64) -> SearchWork {
    let Counts { group_tests, row_tests, sphere_tests, column_tests, candidates, invalid: _ } = *counts;
    let tests = group_tests + row_tests + sphere_tests + column_tests;
    SearchWork { cycles: tests + candidates + hits + CYCLES_OF_A_ROW * (lines + 1), contacts: hits }
}

/// The same if all that is not known yet is as slow as it can be: every sphere touches every other one.
fn most_search_work(sets: &Spheres) -> SearchWork {
    let first = sets.first.len() as u64;
    most_search_work_of(first, sets.second.as_ref().map_or(first, |second| second.len() as u64))
}

fn most_search_work_of(first: u64, second: u64) -> SearchWork {
    let row = ROW as u64;
    let tests = first.div_ceil(row) * second.div_ceil(row);
    let counts = Counts {
        group_tests: tests,
        row_tests: tests,
        sphere_tests: row * tests,
        column_tests: row * tests,
        candidates: row * row * tests,
        invalid: 0,
    };
    search_work(&counts, counts.candidates, sphere_lines(first) + sphere_lines(second))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Config, Profile, Results};
    use crate::query::{Fields, Flow};
    use crate::spheres::{Hit, Search};

    fn layout() -> Layout {
        let config =
            Config { input: Input::Spheres, results: Results::Hits, contact: Fields::HIT, ..Config::default() };
        Layout::of(512, &config)
    }

    fn numbers(job: &SpheresJob, outcome: &Outcome) -> Result<Vec<[u32; 2]>, HitError> {
        hits(job, &layout(), outcome).map(|(hits, _)| hits)
    }

    fn outcome(hits: &[[u32; 2]]) -> Outcome {
        let contact = ContactRecord::of_flags(Flow::Real.flags());
        let all: Vec<_> = hits.iter().map(|&spheres| Hit { spheres, contact }).collect();
        let lines = crate::record::pack_hits(&layout(), &all).into_iter().map(Some).collect();
        Outcome {
            cycles: 0,
            error: 0,
            failure: None,
            contacts: hits.len() as u32,
            candidates: Some(0),
            invalid: 0,
            first_invalid: None,
            cycles_busy: 0,
            cycles_input: 0,
            cycles_output: 0,
            latency_cycles: None,
            bytes_read: 0,
            bytes_written: 0,
            limit_cycles: 0.0,
            lines,
            write_cycles: Vec::new(),
        }
    }

    #[test]
    fn hits_that_cannot_be_right_are_refused() {
        let (one, two) = (SpheresJob { first: 40, second: None }, SpheresJob { first: 40, second: Some(20) });
        let right = [[0, 3], [2, 3], [1, 4], [1, 17], [17, 18]];
        assert_eq!(numbers(&one, &outcome(&right)), Ok(right.to_vec()));
        assert_eq!(numbers(&two, &outcome(&[[39, 0], [3, 19]])), Ok(vec![[39, 0], [3, 19]]));
        // The other way round, twice, a sphere with itself or with one before it, and one that does not exist.
        for (job, wrong) in [
            (one, [[2, 3], [0, 3]]),
            (one, [[2, 3], [2, 3]]),
            (one, [[2, 3], [4, 4]]),
            (one, [[2, 3], [5, 4]]),
            (one, [[2, 3], [2, 40]]),
            (two, [[2, 3], [2, 20]]),
            (two, [[17, 3], [2, 4]]),
        ] {
            let error = numbers(&job, &outcome(&wrong)).expect_err("wrong");
            assert!(matches!(error, HitError::Spheres { index: 1, .. }), "{wrong:?}: {error}");
        }
        let mut lost = outcome(&right);
        lost.lines[0] = None;
        assert_eq!(numbers(&one, &lost), Err(HitError::Unwritten { index: 0, count: 5 }));
    }

    /// No search takes more than what is waited for, not even one in which every sphere touches every other.
    #[test]
    fn a_host_waits_for_the_longest_search() {
        let crowd = vec![Sphere::new([0.0, 0.0, 0.0, 1.0]); 300];
        for sets in [
            Spheres { first: crowd.clone(), second: None },
            Spheres { first: crowd.clone(), second: Some(crowd[..50].to_vec()) },
            Spheres::default(),
        ] {
            let search = Search::new(Profile::WIDE.arithmetic(), 24).expect("a search");
            let mut reference = Profile::WIDE.reference(Fields::HIT);
            let found = search.find(&mut reference, &sets.first, sets.second.as_deref()).expect("found");
            let lines = sphere_lines(sets.first.len() as u64);
            let (work, most) = (search_work(&found.counts, found.hits.len() as u64, lines), most_search_work(&sets));
            assert!(work.cycles <= most.cycles && work.contacts <= most.contacts);
        }
    }
}
