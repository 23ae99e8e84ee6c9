//! What the AFU does between the lines that it reads and those that it writes.

use crate::afu::JobError;
use crate::config::{Config, Input};
use crate::host::task::Task;
use crate::host::transport::TransportError;
use crate::kernel::Reference;
use crate::link::Line;
use crate::query::Flow;
use crate::record::{Layout, SetTooLarge, pack_contacts, pack_hits, sphere_lines, unpack_pairs, unpack_spheres};
use crate::spheres::{Search, Sphere};

/// The status of a job that has ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counted {
    pub(super) error: u8,
    pub(super) contacts: u32,
    pub(super) candidates: u32,
    pub(super) invalid: u32,
    /// All ones if there is none.
    pub(super) first_invalid: u32,
}

impl Counted {
    /// A job that counted nothing: it had not begun.
    pub(super) fn failed(error: JobError) -> Self {
        Self { error: error.code(), ..Self::nothing() }
    }

    fn nothing() -> Self {
        Self { error: 0, contacts: 0, candidates: 0, invalid: 0, first_invalid: u32::MAX }
    }
}

/// The core.
#[derive(Debug)]
pub(super) struct Jobs {
    layout: Layout,
    input: Input,
    reference: Reference,
    /// The search, if spheres come in.
    search: Option<Search>,
    /// The spheres that the table can hold, and those in it.
    table_size: u32,
    table: Vec<Sphere>,
}

impl Jobs {
    pub(super) fn new(config: &Config, layout: Layout) -> Self {
        let takes_spheres = config.input == Input::Spheres;
        let search = Search::new(config.profile.arithmetic(), config.search.box_bits).ok();
        Self {
            layout,
            input: config.input,
            reference: config.reference(),
            search: search.filter(|_| takes_spheres),
            table_size: config.search.table,
            table: Vec::new(),
        }
    }

    /// Lines that a job reads, or the error with which it ends before it reads any.
    pub(super) fn source_lines(&self, task: &Task) -> Result<u64, JobError> {
        let [count, others] = [task.count, task.others].map(u64::from);
        let (first, second) = match (self.input, task.mode) {
            (Input::Direct, 0) => return Ok(self.layout.source_lines(count)),
            (Input::Spheres, 0) => (count, 0),
            (Input::Spheres, 1) => (count, others),
            (Input::Spheres, 2) => (0, others),
            _ => return Err(JobError::Mode),
        };
        let is_too_large = SetTooLarge::check(first as usize, second as usize, self.table_size).is_err();
        if is_too_large { Err(JobError::Table) } else { Ok(sphere_lines(first) + sphere_lines(second)) }
    }

    /// The source lines with which SPL2's shell compares the buffers, in modes that do not exist too.
    pub(super) fn lines_below_spl2(&self, task: &Task) -> u64 {
        let [first, second] = [task.count, task.others].map(|spheres| sphere_lines(spheres.into()));
        match (self.input, task.mode) {
            (Input::Direct, _) => self.layout.source_lines(task.count.into()),
            (Input::Spheres, 0) => first,
            (Input::Spheres, 2) => second,
            (Input::Spheres, _) => first + second,
        }
    }

    /// The lines of results of a job with these source lines, and its status.
    pub(super) fn run(&mut self, task: &Task, lines: &[Line]) -> Result<(Vec<Line>, Counted), TransportError> {
        match self.search {
            None => Ok(self.pairs(task, lines)),
            Some(search) => self.spheres(search, task, lines),
        }
    }

    fn pairs(&self, task: &Task, lines: &[Line]) -> (Vec<Line>, Counted) {
        let records = self.reference.run_all(&unpack_pairs(&self.layout, lines, task.count as usize));
        let is_invalid = |record: &crate::query::ContactRecord| record.flow() == Some(Flow::Invalid);
        let ended = Counted {
            contacts: records.iter().filter(|record| record.is_contact()).count() as u32,
            invalid: records.iter().filter(|record| is_invalid(record)).count() as u32,
            first_invalid: records.iter().position(is_invalid).map_or(u32::MAX, |number| number as u32),
            ..Counted::nothing()
        };
        (pack_contacts(&self.layout, &records), ended)
    }

    fn spheres(&mut self, search: Search, task: &Task, lines: &[Line]) -> Result<(Vec<Line>, Counted), TransportError> {
        let keeps_table = task.mode == 2;
        let of_table = if keeps_table { 0 } else { sphere_lines(task.count.into()) as usize };
        let (of_first, of_second) = lines.split_at(of_table.min(lines.len()));
        if !keeps_table {
            self.table = unpack_spheres(of_first, task.count as usize);
        }
        let others = (task.mode != 0).then(|| unpack_spheres(of_second, task.others as usize));
        let found = search.find(&mut self.reference, &self.table, others.as_deref());
        let found = found.map_err(|error| TransportError::Device(error.to_string()))?;
        let read = self.table.iter().filter(|_| !keeps_table).chain(others.iter().flatten());
        let invalid: Vec<usize> = (0..).zip(read).filter(|(_, sphere)| !sphere.is_valid()).map(|(at, _)| at).collect();
        let ended = Counted {
            contacts: found.hits.len() as u32,
            candidates: found.counts.candidates as u32,
            invalid: invalid.len() as u32,
            first_invalid: invalid.first().map_or(u32::MAX, |&number| number as u32),
            ..Counted::nothing()
        };
        Ok((pack_hits(&self.layout, &found.hits), ended))
    }
}
