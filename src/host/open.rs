//! The resources that a transaction takes from its session. The last step, or a drop, undoes what was begun.

use super::error::HostError;
use super::received::{Begin, Records, Status, outcome};
use super::report::Report;
use super::results::JobResults;
use super::session::Session;
use super::task::Task;
use super::transaction::PairsJob;
use super::transport::Transport;
use super::workspace::pages_for;
use crate::config::Input;
use crate::kernel::settle;
use crate::link::Line;
use crate::outcome::Outcome;
use crate::query::PairRecord;
use crate::record::pack;

#[derive(Debug)]
pub(super) struct Open<'s, T: Transport> {
    pub(super) session: &'s mut Session<T>,
    is_set_up: bool,
    /// The job that is in the source.
    pub(super) task: Task,
    /// Spheres in the AFU's table, if it takes spheres.
    pub(super) table: u32,
    pub(super) report: Report,
}

impl<'s, T: Transport> Open<'s, T> {
    pub(super) fn new(session: &'s mut Session<T>) -> Self {
        let stated = session.transport.link().session;
        let report = Report { stated_set_up: stated.set_up, stated_tear_down: stated.tear_down, ..Report::default() };
        Self { session, is_set_up: false, task: Task::default(), table: 0, report }
    }

    /// Replaces what is in the source by pairs, and clears the memory for their results.
    pub(super) fn load_pairs(&mut self, pairs: &[PairRecord]) -> Result<PairsJob, HostError> {
        if self.session.input() == Input::Spheres {
            return Err(HostError::Input { taken: "spheres", sent: "pairs", option: Input::Direct });
        }
        self.session.workspace.layout().check(pairs)?;
        let (layout, capacity) = (*self.session.workspace.layout(), self.session.workspace.capacity());
        let count = pairs.len() as u64;
        if count > capacity {
            return Err(HostError::TooManyPairs { pairs: count, capacity, pages: pages_for(&layout, count) });
        }
        self.report.pairs = count;
        // No more than the capacity.
        self.load(pack(&layout, pairs), Task::of_pairs(&layout, count as u32))?;
        Ok(PairsJob { pairs: pairs.to_vec() })
    }

    /// Replaces what is in the source by these lines, and clears the memory for their results.
    pub(super) fn load(&mut self, lines: impl IntoIterator<Item = Line>, task: Task) -> Result<(), HostError> {
        self.free();
        self.task = task;
        self.session.load(lines, &task)
    }

    pub(super) fn set_up(&mut self) -> Result<(), HostError> {
        let begun = self.session.transport.cycle();
        self.is_set_up = true;
        self.session.set_up()?;
        self.report.set_up = self.session.transport.cycle() - begun;
        Ok(())
    }

    pub(super) fn start(&mut self) -> Result<Begin, HostError> {
        let task = self.task;
        self.session.start(&task)
    }

    pub(super) fn abort(&mut self) -> Result<(), HostError> {
        let task = self.task;
        self.session.abort(&task)
    }

    pub(super) fn outcome(&self, begin: &Begin, end: &Status) -> Outcome {
        outcome(self.session, begin, &self.task, end)
    }

    /// Succeeds if the job ended well.
    pub(super) fn check_end(&self, outcome: &Outcome) -> Result<(), HostError> {
        let shell = self.session.transport.protocol().shell();
        HostError::of_outcome(outcome, shell, self.task.input).map_or(Ok(()), Err)
    }

    /// The records of a job that ended well, and what the job took.
    pub(super) fn results(&mut self, job: &PairsJob, outcome: &Outcome) -> Result<JobResults, HostError> {
        self.check_end(outcome)?;
        let layout = *self.session.workspace.layout();
        let Records { numbers, mut contacts } = Records::read(&layout, self.task.count, outcome)?;
        // Before anyone reads the records. Only the profile `exact` leaves pairs unsettled, and it has a record for
        // each pair.
        let unsettled = if layout.number_bits() > 0 { 0 } else { settle(&job.pairs, &mut contacts, layout.fields()) };
        Ok(JobResults {
            contacts,
            numbers,
            hits: outcome.contacts,
            invalid: outcome.invalid,
            first_invalid: outcome.first_invalid,
            unsettled,
            layout,
            report: self.report_job(outcome),
        })
    }

    /// The report so far, with what the job took.
    pub(super) fn report_job(&mut self, outcome: &Outcome) -> Report {
        let report = &mut self.report;
        report.run = outcome.cycles_busy;
        report.handshake = outcome.cycles.saturating_sub(report.run);
        (report.bytes_read, report.bytes_written) = (outcome.bytes_read, outcome.bytes_written);
        report.link_limit = outcome.limit_cycles;
        *report
    }

    /// Forgets everything that was written into the buffers for the transaction.
    fn free(&mut self) {
        let Session { transport, workspace, .. } = &mut *self.session;
        let used = [
            (workspace.source(), self.task.source_lines + workspace.control_lines()),
            (workspace.destination(), self.task.destination_lines),
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

    /// The same for a transaction of which all steps were taken: the session keeps the report.
    pub(super) fn end(&mut self) -> Result<Report, HostError> {
        let report = self.finish()?;
        self.session.reports.push(report);
        Ok(report)
    }
}

impl<T: Transport> Drop for Open<'_, T> {
    fn drop(&mut self) {
        // Errors cannot be returned here; the next transaction begins with a reset.
        let _ = self.finish();
    }
}
