//! A small host: lays out a workspace, starts the AFU, runs jobs one after another.

use super::{Machine, MachineError};
use crate::afu::Capability;
use crate::afu::shell::spl2::map::{self, Field, control, identity, latency, performance, pointers, status};
use crate::cosim::drive::Job;
use crate::link::spl2::{CsrOffset, Limits, MAX_PAGES, PAGE_BYTES};
use crate::link::{LINE_BYTES, Line, Traffic};
use crate::outcome::Outcome;
use crate::patience::{self, Patience, Work};

/// Physical byte addresses of what is not in the workspace.
const SPL_DSM: u64 = 0x1000;
const AFU_DSM: u64 = 0x0000_0012_0000_2000;
const SPL_CONTEXT: u64 = 0x3000;
const PAGE_TABLE: u64 = 0x4000;
/// The physical page of the workspace's last page; those before lie behind it, so that a carry over a page shows.
const FIRST_PAGE: u64 = 0x0000_0040_0000_0000;
/// The workspace's virtual byte address.
const WORKSPACE: u64 = 0x0000_7F12_3460_0000;
const PAGE_LINES: u64 = PAGE_BYTES / LINE_BYTES;
/// Lines of the context at the beginning of the workspace.
const CONTEXT_LINES: u64 = 2;
/// Cycles between two calls for progress.
const PROGRESS_CYCLES: u64 = 4096;

/// Where the buffers of a session lie in its workspace, in lines from its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Pages of the workspace.
    pub pages: u64,
    /// The control memory; the pairs follow it.
    pub source: u64,
    /// The results.
    pub destination: u64,
    /// How long both may be.
    pub lines: u32,
}

impl Place {
    /// Two halves behind the context, as long as a job of so many lines needs; as the platform's driver lays them out.
    pub fn for_lines(source_lines: u64, destination_lines: u64) -> Self {
        let half = (source_lines + u64::from(map::DATA_LINE)).max(destination_lines).max(1);
        let (source, destination) = (CONTEXT_LINES, CONTEXT_LINES + half);
        let pages = (destination + half).div_ceil(PAGE_LINES);
        Self { pages, source, destination, lines: u32::try_from(half).unwrap_or(u32::MAX) }
    }

    fn check(&self) -> Result<(), MachineError> {
        let all = self.pages * PAGE_LINES;
        let lines = u64::from(self.lines);
        let ends = self.source.max(self.destination).checked_add(lines).is_some_and(|end| end <= all);
        if !(1..=MAX_PAGES).contains(&self.pages) || !ends || self.source.min(self.destination) < CONTEXT_LINES {
            return Err(MachineError::Workspace(
                "its buffers do not fit in 1 to 1024 pages of 2 MB behind the context",
            ));
        }
        if self.source.abs_diff(self.destination) < lines {
            return Err(MachineError::Workspace("source and destination overlap"));
        }
        Ok(())
    }
}

/// What the AFU said at the end of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// The line.
    pub line: Line,
    /// The cycle in which it arrived.
    pub cycle: u64,
}

/// A started AFU with its workspace.
#[derive(Debug)]
pub struct Session<'m, 'a> {
    machine: &'m mut Machine<'a>,
    afu: Capability,
    place: Place,
    sequence: u32,
    /// Of the running job: the cycle of the start word, the link's traffic then, device writes then.
    started: u64,
    reads: u64,
    writes: u64,
    logged: usize,
    results: u64,
    /// The control memory as it stands.
    control: Line,
}

impl<'m, 'a> Session<'m, 'a> {
    /// Resets the AFU, gives it its DSM, waits for its AFU_ID, gives it context and pages, enables it.
    ///
    /// # Errors
    /// When it is not the AFU that was expected, or breaks the protocol.
    pub fn open(machine: &'m mut Machine<'a>, place: Place, scpus: Option<u32>) -> Result<Self, MachineError> {
        place.check()?;
        let control_offset = CsrOffset::Control as u32;
        machine.spl_mut().limit(None);
        machine.write_csr(control_offset, 1)?;
        zero(machine, SPL_DSM, 1);
        pointer(machine, CsrOffset::DsmHigh as u32, CsrOffset::DsmLow as u32, SPL_DSM)?;
        zero(machine, AFU_DSM, map::DSM_BYTES / LINE_BYTES);
        pointer(machine, map::DSM_BASE_HIGH.offset, map::DSM_BASE_LOW.offset, AFU_DSM)?;
        let afu = wait_for_identity(machine, scpus)?;

        let machine_cycle = machine.cycle() as u32;
        let mut session = Self {
            machine,
            afu,
            place,
            // Late writes of an earlier session's job must not look like this one's.
            sequence: machine_cycle,
            started: 0,
            reads: 0,
            writes: 0,
            logged: 0,
            results: 0,
            control: [0; 16],
        };
        session.write_pages();
        session.set_control([0; 16]);
        let status = session.physical(u64::from(map::STATUS_LINE));
        session.machine.memory_mut().set(status, &[0; 16]);
        session.machine.spl_mut().watch(status..status + 1);
        let mut context = [0; 16];
        let address = |line: u64| u128::from(WORKSPACE + line * LINE_BYTES);
        pointers::SOURCE.set(&mut context, address(place.source));
        pointers::DESTINATION.set(&mut context, address(place.destination));
        pointers::LINES.set(&mut context, place.lines.into());
        let line = session.physical(u64::from(map::POINTERS_LINE));
        session.machine.memory_mut().set(line, &context);
        pointer(session.machine, CsrOffset::ContextHigh as u32, CsrOffset::ContextLow as u32, SPL_CONTEXT)?;
        let csrs = (map::CONTEXT_BASE_HIGH.offset, map::CONTEXT_BASE_LOW.offset);
        pointer(session.machine, csrs.0, csrs.1, WORKSPACE)?;
        session.machine.write_csr(control_offset, 2)?;
        Ok(session)
    }

    /// The machine.
    pub fn machine(&mut self) -> &mut Machine<'a> {
        self.machine
    }

    /// SPL2's context and page table: the workspace's pages, the last one first.
    fn write_pages(&mut self) {
        let Place { pages, .. } = self.place;
        let low = |value: u64| value as u32;
        let high = |value: u64| (value >> 32) as u32;
        let mut context = [0; 16];
        (context[0], context[1]) = (low(PAGE_TABLE), high(PAGE_TABLE));
        (context[2], context[3]) = (low(WORKSPACE), high(WORKSPACE));
        (context[4], context[5]) = (1, low(pages));
        self.machine.memory_mut().set(SPL_CONTEXT / LINE_BYTES, &context);
        for first in (0..pages).step_by(8) {
            let mut line = [0; 16];
            for page in first..pages.min(first + 8) {
                let address = FIRST_PAGE + (pages - 1 - page) * PAGE_BYTES;
                let index = (page - first) as usize;
                (line[2 * index], line[2 * index + 1]) = (low(address), high(address));
            }
            self.machine.memory_mut().set(PAGE_TABLE / LINE_BYTES + first / 8, &line);
        }
    }

    /// The physical line of a line of the workspace.
    pub fn physical(&self, line: u64) -> u64 {
        let page = self.place.pages - 1 - line / PAGE_LINES;
        FIRST_PAGE / LINE_BYTES + page * PAGE_LINES + line % PAGE_LINES
    }

    fn set_control(&mut self, line: Line) {
        self.control = line;
        let at = self.physical(self.place.source + u64::from(map::CONTROL_LINE));
        self.machine.memory_mut().set(at, &line);
    }

    /// Puts a job's pairs into the workspace, and the start word. (Its addresses are not the job's to say here.)
    pub fn start(&mut self, job: &Job) {
        for (number, line) in (u64::from(map::DATA_LINE)..).zip(job.source) {
            let at = self.physical(self.place.source + number);
            self.machine.memory_mut().set(at, line);
        }
        for line in 0..job.destination_lines {
            let at = self.physical(self.place.destination + line);
            self.machine.memory_mut().forget(at..at + 1);
        }
        self.results = job.destination_lines;
        let first = WORKSPACE / LINE_BYTES;
        let (source, destination) = (first + self.place.source, first + self.place.destination);
        self.machine.spl_mut().limit(Some(Limits {
            reads: vec![first..first + 1, source..source + 1 + job.source.len() as u64],
            status: first + u64::from(map::STATUS_LINE)..first + CONTEXT_LINES,
            results: destination..destination + job.destination_lines,
        }));
        self.sequence = self.sequence.wrapping_add(1);
        let mut line = [0; 16];
        control::COUNT.set(&mut line, job.pairs.into());
        control::MODE.set(&mut line, job.mode.into());
        control::SEQUENCE.set(&mut line, self.sequence.into());
        control::WATCHDOG.set(&mut line, job.watchdog.into());
        control::START.set(&mut line, map::START_WORD.into());
        self.set_control(line);
        let traffic = self.machine.spl().link().traffic();
        (self.reads, self.writes) = (traffic.read_responses, traffic.writes);
        self.started = self.machine.cycle();
        self.logged = self.machine.device_writes().len();
    }

    /// Asks the AFU to end the job that runs.
    pub fn abort(&mut self) {
        let mut line = self.control;
        control::ABORT.set(&mut line, 1);
        self.set_control(line);
    }

    /// The status of the job, once it is there.
    pub fn status(&self) -> Option<Status> {
        let at = self.physical(u64::from(map::STATUS_LINE));
        let new = &self.machine.device_writes()[self.logged..];
        let of_job = |line: &Line| status::SEQUENCE.get(line) == self.sequence.into() && status::DONE.get(line) == 1;
        let found = new.iter().rev().find(|write| write.address == at && of_job(&write.data))?;
        Some(Status { line: found.data, cycle: found.cycle })
    }

    /// Waits for the status.
    ///
    /// # Errors
    /// When it does not come within `cycles`, or the AFU breaks the protocol.
    pub fn wait(&mut self, cycles: u64) -> Result<Status, MachineError> {
        for _ in 0..=cycles {
            if let Some(status) = self.status() {
                return Ok(status);
            }
            self.machine.advance(1)?;
        }
        Err(MachineError::NoStatus { cycles, in_flight: self.machine.spl().in_flight() })
    }

    /// How long a job may take.
    pub fn patience(&self, job: &Job) -> Patience {
        let spl = self.machine.spl();
        let patience = patience::spl2(&self.afu, spl.link().model(), spl.model(), &job.work());
        Patience { whole: job.max_cycles.unwrap_or(patience.whole), ..patience }
    }

    /// Runs a job to its end.
    ///
    /// # Errors
    /// When its status does not come in time ([`patience`]), or the AFU breaks the protocol.
    pub fn run(&mut self, job: &Job) -> Result<Outcome, MachineError> {
        self.run_with(job, &mut |_| {})
    }

    /// [`Session::run`] that tells, now and then, what went over the link since the machine began.
    ///
    /// # Errors
    /// As `run`.
    pub fn run_with(&mut self, job: &Job, progress: &mut dyn FnMut(Traffic)) -> Result<Outcome, MachineError> {
        self.start(job);
        let patience = self.patience(job);
        loop {
            if let Some(status) = self.status() {
                return Ok(self.outcome(&status));
            }
            let cycles = self.machine.cycle() - self.started;
            let quiet = self.machine.cycle() - self.machine.last_work().max(self.started);
            if cycles > patience.whole || quiet > patience.quiet {
                return Err(MachineError::NoStatus { cycles, in_flight: self.machine.spl().in_flight() });
            }
            self.machine.advance(1)?;
            if self.machine.cycle().is_multiple_of(PROGRESS_CYCLES) {
                progress(self.machine.spl().link().traffic());
            }
        }
    }

    /// What came of the job whose status this is. Bytes count all that went over the link since the start word.
    pub fn outcome(&self, end: &Status) -> Outcome {
        let memory = self.machine.memory();
        let dsm = |line: u32| memory.get(AFU_DSM / LINE_BYTES + u64::from(line)).copied().unwrap_or_default();
        let (latencies, figures) = (dsm(map::LATENCY_LINE), dsm(map::PERFORMANCE_LINE));
        let word = |field: Field, line: &Line| field.get(line) as u64;
        let of_status = |field: Field| word(field, &end.line) as u32;
        let link = self.machine.spl().link();
        let (reads, writes) = (link.traffic().read_responses - self.reads, link.traffic().writes - self.writes);
        let (first_read, first_write) = (word(latency::FIRST_READ, &latencies), word(latency::FIRST_WRITE, &latencies));
        let results = 0..self.results;
        let virtual_line = |line: u64| WORKSPACE / LINE_BYTES + self.place.destination + line;
        let written = |line| Some(self.machine.spl().written(virtual_line(line))?.saturating_sub(self.started));
        Outcome {
            cycles: end.cycle - self.started,
            error: of_status(status::ERROR) as u8,
            contacts: of_status(status::CONTACTS),
            invalid: of_status(status::INVALID),
            first_invalid: Some(of_status(status::FIRST_INVALID)).filter(|&pair| pair != u32::MAX),
            cycles_busy: word(performance::BUSY, &figures),
            cycles_input: word(performance::INPUT, &figures),
            cycles_output: word(performance::OUTPUT, &figures),
            latency_cycles: (first_read > 0 && first_write > 0).then(|| first_write.saturating_sub(first_read)),
            bytes_read: reads * LINE_BYTES,
            bytes_written: writes * LINE_BYTES,
            limit_cycles: link.model().limit_cycles(reads, writes),
            lines: results
                .clone()
                .map(|line| memory.get(self.physical(self.place.destination + line)).copied())
                .collect(),
            write_cycles: results.map(written).collect(),
        }
    }
}

fn zero(machine: &mut Machine, address: u64, lines: u64) {
    for line in 0..lines {
        machine.memory_mut().set(address / LINE_BYTES + line, &[0; 16]);
    }
}

/// Writes both halves of a 64-bit CSR.
fn pointer(machine: &mut Machine, high: u32, low: u32, address: u64) -> Result<(), MachineError> {
    machine.write_csr(high, (address >> 32) as u32)?;
    machine.write_csr(low, address as u32)
}

fn wait_for_identity(machine: &mut Machine, scpus: Option<u32>) -> Result<Capability, MachineError> {
    let spl = machine.spl();
    let cycles = patience::spl2(&Capability::from_bits(0), spl.link().model(), spl.model(), &Work::default()).whole;
    let line_at = AFU_DSM / LINE_BYTES + u64::from(map::IDENTITY_LINE);
    for _ in 0..cycles {
        let line = machine.memory().get(line_at).copied().unwrap_or_default();
        let (afu_id, version) = (identity::AFU_ID.get(&line), identity::VERSION.get(&line) as u32);
        if afu_id != 0 {
            if (afu_id, version) != (map::AFU_ID, map::VERSION) {
                return Err(MachineError::Identity { afu_id, version });
            }
            let afu = Capability::from_bits(identity::CAPABILITY.get(&line) as u64);
            return match scpus.filter(|&expected| expected != afu.scpus) {
                Some(expected) => Err(MachineError::Scpus { expected, found: afu.scpus }),
                None => Ok(afu),
            };
        }
        machine.advance(1)?;
    }
    Err(MachineError::Silent(cycles))
}
