//! The resources that a transaction takes from its session. The last step, or a drop, undoes what was begun.

use super::error::HostError;
use super::received::{Begin, Records, Status, outcome};
use super::report::Report;
use super::results::JobResults;
use super::session::Session;
use super::transport::Transport;
use super::workspace::pages_for;
use crate::kernel::settle;
use crate::outcome::Outcome;
use crate::query::PairRecord;

#[derive(Debug)]
pub(super) struct Open<'s, T: Transport> {
    pub(super) session: &'s mut Session<T>,
    is_set_up: bool,
    /// The pairs in the source. The host needs them again if the AFU leaves some unsettled.
    pairs: Vec<PairRecord>,
    report: Report,
}

impl<'s, T: Transport> Open<'s, T> {
    pub(super) fn new(session: &'s mut Session<T>) -> Self {
        let stated = session.transport.link().session;
        let report = Report { stated_set_up: stated.set_up, stated_tear_down: stated.tear_down, ..Report::default() };
        Self { session, is_set_up: false, pairs: Vec::new(), report }
    }

    /// Number of pairs in the source.
    pub(super) fn count(&self) -> u32 {
        // `load` refuses more.
        self.pairs.len() as u32
    }

    /// Replaces the pairs in the source, and clears the memory for their results.
    pub(super) fn load(&mut self, pairs: &[PairRecord]) -> Result<(), HostError> {
        self.session.workspace.layout().check(pairs)?;
        let (layout, capacity) = (*self.session.workspace.layout(), self.session.workspace.capacity());
        let count = pairs.len() as u64;
        if count > capacity {
            return Err(HostError::TooManyPairs { pairs: count, capacity, pages: pages_for(&layout, count) });
        }
        self.free();
        self.pairs = pairs.to_vec();
        self.report.pairs = count;
        self.session.load(pairs)
    }

    pub(super) fn set_up(&mut self) -> Result<(), HostError> {
        let begun = self.session.transport.cycle();
        self.is_set_up = true;
        self.session.set_up()?;
        self.report.set_up = self.session.transport.cycle() - begun;
        Ok(())
    }

    pub(super) fn start(&mut self) -> Result<Begin, HostError> {
        let count = self.count();
        self.session.start(count)
    }

    pub(super) fn abort(&mut self) -> Result<(), HostError> {
        let count = self.count();
        self.session.abort(count)
    }

    pub(super) fn outcome(&self, begin: &Begin, end: &Status) -> Outcome {
        outcome(self.session, begin, self.count(), end)
    }

    /// The records of a job that ended well, and what the job took.
    pub(super) fn results(&mut self, outcome: &Outcome) -> Result<JobResults, HostError> {
        let shell = self.session.transport.protocol().shell();
        HostError::of_outcome(outcome, shell).map_or(Ok(()), Err)?;
        let layout = self.session.workspace.layout();
        let Records { numbers, mut contacts } = Records::read(layout, self.count(), outcome)?;
        // Before anyone reads the records. Only the profile `exact` leaves pairs unsettled, and it has a record for
        // each pair.
        let unsettled = if layout.number_bits() > 0 { 0 } else { settle(&self.pairs, &mut contacts, layout.fields()) };
        let report = &mut self.report;
        report.run = outcome.cycles_busy;
        report.handshake = outcome.cycles.saturating_sub(report.run);
        (report.bytes_read, report.bytes_written) = (outcome.bytes_read, outcome.bytes_written);
        report.link_limit = outcome.limit_cycles;
        Ok(JobResults {
            contacts,
            numbers,
            hits: outcome.contacts,
            invalid: outcome.invalid,
            first_invalid: outcome.first_invalid,
            unsettled,
            layout: *layout,
            report: *report,
        })
    }

    /// Forgets everything that was written into the buffers for the transaction.
    fn free(&mut self) {
        let Session { transport, workspace, .. } = &mut *self.session;
        let (layout, pairs) = (*workspace.layout(), self.pairs.len() as u64);
        let used = [
            (workspace.source(), layout.source_lines(pairs) + workspace.control_lines()),
            (workspace.destination(), layout.destination_lines(pairs)),
        ];
        for (base, lines) in used {
            for line in (0..lines).filter_map(|line| workspace.line(base, line).ok()) {
                transport.forget(line..line + 1);
            }
        }
    }

    /// Stops SPL and frees the part of the workspace that the transaction used. Returns the cycles that it took.
    pub(super) fn finish(&mut self) -> Result<Report, HostError> {
        if std::mem::take(&mut self.is_set_up) {
            let begun = self.session.transport.cycle();
            let stopped = self.session.tear_down();
            self.report.tear_down = self.session.transport.cycle() - begun;
            self.free();
            stopped?;
        }
        Ok(self.report)
    }
}

impl<T: Transport> Drop for Open<'_, T> {
    fn drop(&mut self) {
        // Errors cannot be returned here; the next transaction begins with a reset.
        let _ = self.finish();
    }
}
