//! Jobs at the line port.

use std::ops::Range;

use super::error::DriveError;
use super::ports::Ports;
use crate::link::{LINE_BYTES, Line, Link, Memory, Replies, Requests, Traffic};
use crate::outcome::Outcome;
use crate::patience::{Patience, SearchWork, Work};

/// The default line address of sources.
const SOURCE: u64 = 0x1000;
/// The default line address of results, beyond every source.
const DESTINATION: u64 = 1 << 40;

/// A job for an AFU.
#[derive(Clone, Debug)]
pub struct Job<'a> {
    /// The source lines.
    pub source: &'a [Line],
    /// The number of pairs in them.
    pub pairs: u32,
    /// The number of spheres in the second set, if spheres come in; `pairs` is that of the first.
    pub others: u32,
    /// Lines that the results take. If only contacts come back, the number of lines that there is room for.
    pub destination_lines: u64,
    /// Contacts per destination line, if only contacts come back. The AFU must then write as many lines as its contacts
    /// take. With `None`, it must write every destination line.
    pub hits_per_line: Option<u32>,
    /// Line address of the first source line.
    pub source_address: u64,
    /// Line address of the first destination line.
    pub destination_address: u64,
    /// The AFU's mode: 0.
    pub mode: u8,
    /// Cycles without a response after which the AFU gives up. With 0 it never does.
    pub watchdog: u32,
    /// What a search among spheres takes at most, if the AFU searches.
    pub search: SearchWork,
    /// The number of SCPUs that the AFU must have.
    pub scpus: Option<u32>,
    /// Cycles after which the job has failed even if requests are still answered. `None` leaves it to
    /// [`patience`](crate::patience).
    pub max_cycles: Option<u64>,
}

impl<'a> Job<'a> {
    /// The job of `pairs` pairs in the lines `source`, whose results take `destination_lines`.
    pub fn new(source: &'a [Line], pairs: u32, destination_lines: u64) -> Self {
        Self {
            source,
            pairs,
            others: 0,
            destination_lines,
            hits_per_line: None,
            source_address: SOURCE,
            destination_address: DESTINATION,
            mode: 0,
            watchdog: 0,
            search: SearchWork::default(),
            scpus: None,
            max_cycles: None,
        }
    }

    /// The parts of the job that take time.
    pub(super) fn work(&self) -> Work {
        let (pairs, reads) = (self.pairs.into(), self.source.len() as u64);
        Work { pairs, reads, writes: self.destination_lines, watchdog: self.watchdog, search: self.search }
    }

    fn source_range(&self) -> Range<u64> {
        self.source_address..self.source_address + self.source.len() as u64
    }

    fn destination_range(&self) -> Range<u64> {
        self.destination_address..self.destination_address + self.destination_lines
    }

    /// Checks that source and destination lie in the address space and do not overlap.
    pub(super) fn check(&self) -> Result<(), DriveError> {
        let space = 1 << crate::afu::ADDRESS_BITS;
        let fits = |first: u64, lines: u64| first <= space && lines <= space - first;
        if !fits(self.source_address, self.source.len() as u64) {
            return Err(DriveError::Job("the source ends beyond the last line address"));
        }
        if !fits(self.destination_address, self.destination_lines) {
            return Err(DriveError::Job("the destination ends beyond the last line address"));
        }
        let (source, destination) = (self.source_range(), self.destination_range());
        if source.start < destination.end && destination.start < source.end {
            return Err(DriveError::Job("source and destination overlap"));
        }
        Ok(())
    }

    /// Writes the source to memory, and clears the destination.
    pub(super) fn place(&self, memory: &mut Memory) {
        for (address, line) in self.source_range().zip(self.source) {
            memory.set(address, line);
        }
        memory.forget(self.destination_range());
        memory.guard(self.source_range(), self.destination_range());
    }
}

/// A job that is running.
#[derive(Clone, Debug)]
pub(super) struct Running {
    destination: Range<u64>,
    hits_per_line: Option<u32>,
    patience: Patience,
    pub(super) started: u64,
    /// The link's traffic at the start.
    pub(super) traffic: Traffic,
    /// The last cycle in which a request was accepted or answered.
    last_sign: u64,
    first_data: Option<u64>,
    first_write: Option<u64>,
    write_cycles: Vec<Option<u64>>,
}

impl Running {
    pub(super) fn new(job: &Job, patience: Patience, cycle: u64, traffic: Traffic) -> Self {
        let whole = job.max_cycles.unwrap_or(patience.whole);
        Self {
            destination: job.destination_range(),
            hits_per_line: job.hits_per_line,
            patience: Patience { whole, ..patience },
            started: cycle,
            traffic,
            last_sign: cycle,
            first_data: None,
            first_write: None,
            write_cycles: vec![None; usize::try_from(job.destination_lines).unwrap_or(0)],
        }
    }

    /// True if it has taken longer than a correct AFU would.
    pub(super) fn is_overdue(&self, cycle: u64) -> bool {
        cycle - self.started > self.patience.whole || cycle - self.last_sign > self.patience.quiet
    }

    /// The first line address that a job with this number of contacts must not write.
    pub(super) fn end(&self, contacts: u32) -> u64 {
        match self.hits_per_line {
            None => self.destination.end,
            Some(per_line) => {
                let lines = u64::from(contacts).div_ceil(u64::from(per_line.max(1)));
                self.destination.start.saturating_add(lines).min(self.destination.end)
            }
        }
    }

    /// Takes note of one cycle.
    pub(super) fn note(&mut self, cycle: u64, requests: &Requests, replies: &Replies) {
        if replies.read.is_some() {
            self.first_data.get_or_insert(cycle);
        }
        if requests.write.is_some() {
            self.first_write.get_or_insert(cycle);
        }
        if let Some(write) = requests.write.filter(|_| replies.write_ready) {
            let line = write.address.wrapping_sub(self.destination.start);
            if let Some(written) = usize::try_from(line).ok().and_then(|line| self.write_cycles.get_mut(line)) {
                *written = Some(cycle - self.started);
            }
        }
        let accepted = requests.read.is_some() && replies.read_ready || requests.write.is_some() && replies.write_ready;
        if accepted || replies.read.is_some() || replies.write.is_some() {
            self.last_sign = cycle;
        }
    }

    pub(super) fn outcome(self, cycle: u64, ports: &Ports, link: &Link) -> Outcome {
        let traffic = link.traffic();
        let (reads, writes) = (traffic.reads - self.traffic.reads, traffic.writes - self.traffic.writes);
        let counters = ports.counters();
        let first_invalid = Some(counters.first_invalid).filter(|&pair| pair != u32::MAX);
        Outcome {
            cycles: cycle - self.started,
            error: ports.error(),
            failure: None,
            contacts: counters.contacts,
            candidates: counters.candidates,
            invalid: counters.invalid,
            first_invalid,
            cycles_busy: counters.busy,
            cycles_input: counters.input,
            cycles_output: counters.output,
            latency_cycles: self.first_data.zip(self.first_write).map(|(data, write)| write.saturating_sub(data)),
            bytes_read: reads * LINE_BYTES,
            bytes_written: writes * LINE_BYTES,
            limit_cycles: link.model().limit_cycles(reads, writes),
            lines: self.destination.map(|address| link.memory.get(address).copied()).collect(),
            write_cycles: self.write_cycles,
        }
    }
}
