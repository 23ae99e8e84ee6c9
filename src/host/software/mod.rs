//! The AFU in software: the same registers and the same lines in memory, with the reference kernel between them, or
//! the search among spheres.
//!
//! A job takes no time, so cycle counters and latencies are zero. Everything else is written as the hardware writes it,
//! in the same order.

mod jobs;
mod registers;

use std::collections::HashMap;
use std::ops::Range;

use super::handshake::Protocol;
use super::task::Task;
use super::transport::{Transport, TransportError};
use crate::afu::shell::spl2::map::{self, control, identity, latency, performance, pointers, scratch, status};
use crate::afu::{Afu, BuildError, JobError, Spec};
use crate::config::{Config, Shell};
use crate::link::spl2::{CsrOffset, DeviceWrite, Pages, SPL_ID};
use crate::link::{LINE_BYTES, Line, LinkModel, Memory, Traffic};
use crate::record::Layout;
use jobs::{Counted, Jobs};
use registers::Registers;

/// The content of lines that were never written, as in the simulated link.
const UNWRITTEN: Line = [0xDEAD_BEEF; 16];
const DSM_LINES: u64 = map::DSM_BYTES / LINE_BYTES;

/// An AFU in software, below SPL2 or, with the shell `axi`, behind its registers.
#[derive(Debug)]
pub struct Software {
    capability: u64,
    layout: Layout,
    jobs: Jobs,
    /// The registers of the shell `axi`, if it is that shell's.
    registers: Option<Registers>,
    link: LinkModel,
    memory: Memory,
    cycle: u64,
    /// The last value written to each CSR.
    csrs: HashMap<u32, u32>,
    /// Line addresses that the AFU was given since the last reset: first the DSM's, then the context's.
    dsm: Option<u64>,
    context: Option<u64>,
    pages: Option<Pages>,
    /// The number of the last job since SPL was enabled.
    job: Option<u32>,
    watched: Vec<Range<u64>>,
    log: Vec<DeviceWrite>,
    traffic: Traffic,
}

impl Software {
    /// The AFU of a configuration. The link only contributes the costs that its description states.
    ///
    /// # Errors
    /// Returns an error if there is no such AFU.
    pub fn new(config: &Config, link: LinkModel) -> Result<Self, BuildError> {
        let afu = Afu::generate(Spec::from(config.clone()))?;
        Ok(Self {
            capability: afu.capability(),
            layout: afu.layout(),
            jobs: Jobs::new(config, afu.layout()),
            registers: (config.shell == Shell::Axi).then(|| Registers::new(config.input, afu.capability())),
            link,
            memory: Memory::new(),
            cycle: 0,
            csrs: HashMap::new(),
            dsm: None,
            context: None,
            pages: None,
            job: None,
            watched: Vec::new(),
            log: Vec::new(),
            traffic: Traffic::default(),
        })
    }

    /// Physical memory.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Physical memory, writable.
    pub fn memory_mut(&mut self) -> &mut Memory {
        &mut self.memory
    }

    /// The address whose low half was just written.
    fn address(&self, high: u32, low: u32) -> u64 {
        u64::from(self.csrs.get(&high).copied().unwrap_or(0)) << 32 | u64::from(low)
    }

    fn write_physical(&mut self, address: u64, line: &Line) {
        self.memory.set(address, line);
        self.traffic.writes += 1;
        self.traffic.write_responses += 1;
        if self.watched.iter().any(|lines| lines.contains(&address)) {
            self.log.push(DeviceWrite { address, data: *line, cycle: self.cycle });
        }
    }

    fn write_dsm(&mut self, number: u32, line: &Line) {
        if let Some(first) = self.dsm {
            self.write_physical(first + u64::from(number), line);
        }
    }

    fn physical(&self, what: &'static str, line: u64) -> Result<u64, TransportError> {
        if self.registers.is_some() {
            return Ok(line);
        }
        let page = self.pages.as_ref().and_then(|pages| pages.translate(line));
        page.ok_or(TransportError::PageFault { what, line })
    }

    fn read(&mut self, line: u64) -> Result<Line, TransportError> {
        let at = self.physical("read", line)?;
        self.traffic.reads += 1;
        self.traffic.read_responses += 1;
        Ok(self.memory.get(at).copied().unwrap_or(UNWRITTEN))
    }

    fn write(&mut self, line: u64, data: &Line) -> Result<(), TransportError> {
        let at = self.physical("write", line)?;
        self.write_physical(at, data);
        Ok(())
    }

    fn set_control(&mut self, value: u32) -> Result<(), TransportError> {
        if value & 1 != 0 {
            (self.dsm, self.context) = (None, None);
        }
        if value & 2 == 0 {
            (self.pages, self.job) = (None, None);
        } else if self.pages.is_none() {
            let low = self.csrs.get(&(CsrOffset::ContextLow as u32)).copied().unwrap_or(0);
            let context = self.address(CsrOffset::ContextHigh as u32, low);
            let pages = Pages::read(&self.memory, context);
            self.pages = Some(pages.map_err(|what| TransportError::Protocol { cycle: self.cycle, what })?);
        }
        Ok(())
    }

    /// Looks for a job, and runs it.
    fn poll(&mut self) -> Result<(), TransportError> {
        let Some(context) = self.context.filter(|_| self.pages.is_some()) else { return Ok(()) };
        let pointers = self.read(context + u64::from(map::POINTERS_LINE))?;
        let line_of = |field: map::Field| field.get(&pointers) as u64 / LINE_BYTES;
        let (source, destination) = (line_of(pointers::SOURCE), line_of(pointers::DESTINATION));
        let control = self.read(source + u64::from(map::CONTROL_LINE))?;
        let sequence = control::SEQUENCE.get(&control) as u32;
        if control::START.get(&control) != map::START_WORD.into() || self.job == Some(sequence) {
            return Ok(());
        }
        self.job = Some(sequence);

        let room = pointers::LINES.get(&pointers) as u64;
        let word = |field: map::Field| field.get(&control) as u32;
        let (count, others, mode) = (word(control::COUNT), word(control::OTHERS), word(control::MODE));
        let task = Task { count, others, mode, destination_lines: room, ..Task::default() };
        let fits = self.jobs.lines_below_spl2(&task) + u64::from(map::DATA_LINE) <= room
            && (self.layout.number_bits() > 0 || self.layout.destination_lines(count.into()) <= room);
        let ended = match self.jobs.source_lines(&task) {
            _ if !fits => Counted::failed(JobError::Room),
            Err(error) => Counted::failed(error),
            Ok(_) if control::ABORT.get(&control) != 0 => Counted::failed(JobError::Aborted),
            Ok(_) => self.run(source + u64::from(map::DATA_LINE), destination, &task)?,
        };

        let mut line = [0; 16];
        latency::SEQUENCE.set(&mut line, sequence.into());
        self.write_dsm(map::LATENCY_LINE, &line);
        let mut line = [0; 16];
        performance::SEQUENCE.set(&mut line, sequence.into());
        self.write_dsm(map::PERFORMANCE_LINE, &line);
        let mut line = [0; 16];
        status::DONE.set(&mut line, 1);
        status::ERROR.set(&mut line, ended.error.into());
        status::SEQUENCE.set(&mut line, sequence.into());
        status::CONTACTS.set(&mut line, ended.contacts.into());
        status::INVALID.set(&mut line, ended.invalid.into());
        status::FIRST_INVALID.set(&mut line, ended.first_invalid.into());
        status::CANDIDATES.set(&mut line, ended.candidates.into());
        status::VERSION.set(&mut line, map::VERSION.into());
        status::CAPABILITY.set(&mut line, self.capability.into());
        status::AFU_ID.set(&mut line, map::AFU_ID);
        self.write(context + u64::from(map::STATUS_LINE), &line)
    }

    /// Reads what the job's source holds, and writes its results.
    fn run(&mut self, source: u64, destination: u64, task: &Task) -> Result<Counted, TransportError> {
        let number = match self.jobs.source_lines(task) {
            Ok(number) => number,
            Err(error) => return Ok(Counted::failed(error)),
        };
        let lines: Vec<Line> = (source..source + number).map(|line| self.read(line)).collect::<Result<_, _>>()?;
        let (results, mut ended) = self.jobs.run(task, &lines)?;
        // Without hits there is a record per pair, and the AFU is not told of any room.
        let has_room = self.layout.number_bits() == 0;
        let room = if has_room { usize::MAX } else { task.destination_lines as usize };
        for (number, line) in (destination..).zip(results.iter().take(room)) {
            self.write(number, line)?;
        }
        if results.len() > room {
            ended.error = JobError::Overflow.code();
        }
        Ok(ended)
    }
}

impl Transport for Software {
    fn protocol(&self) -> Protocol {
        if self.registers.is_some() { Protocol::Axi } else { Protocol::Spl2 }
    }

    fn read_csr(&mut self, byte_offset: u32) -> Result<u32, TransportError> {
        let registers = self.registers.as_mut();
        let refused = || TransportError::Device(format!("register {byte_offset:#x} cannot be read"));
        Ok(registers.ok_or_else(refused)?.read(byte_offset))
    }

    fn interrupt(&self) -> bool {
        self.registers.as_ref().is_some_and(Registers::interrupt)
    }

    fn write_csr(&mut self, byte_offset: u32, value: u32) -> Result<(), TransportError> {
        self.cycle += self.link.session.csr_write.max(1);
        if let Some(registers) = &mut self.registers {
            let Some((source, destination, task)) = registers.write(byte_offset, value) else { return Ok(()) };
            let ended = self.run(source, destination, &task)?;
            if let Some(registers) = &mut self.registers {
                registers.end(ended);
            }
            return Ok(());
        }
        self.csrs.insert(byte_offset, value);
        if byte_offset == CsrOffset::Control as u32 {
            self.set_control(value)?;
        } else if byte_offset == CsrOffset::DsmLow as u32 {
            let mut line = [0; 16];
            line[0] = SPL_ID;
            let at = self.address(CsrOffset::DsmHigh as u32, value) / LINE_BYTES;
            self.memory.set(at, &line);
        } else if byte_offset == map::DSM_BASE_LOW.offset {
            // The DSM is a page.
            let line = self.address(map::DSM_BASE_HIGH.offset, value) / LINE_BYTES;
            self.dsm = Some(line - line % DSM_LINES);
            let mut line = [0; 16];
            identity::AFU_ID.set(&mut line, map::AFU_ID);
            identity::VERSION.set(&mut line, map::VERSION.into());
            identity::CAPABILITY.set(&mut line, self.capability.into());
            self.write_dsm(map::IDENTITY_LINE, &line);
        } else if byte_offset == map::CONTEXT_BASE_LOW.offset {
            self.context = Some(self.address(map::CONTEXT_BASE_HIGH.offset, value) / LINE_BYTES);
        } else if byte_offset == map::SCRATCH.offset {
            let mut line = [0; 16];
            scratch::VALUE.set(&mut line, value.into());
            self.write_dsm(map::SCRATCH_LINE, &line);
        }
        Ok(())
    }

    fn line(&self, at: u64) -> Option<Line> {
        self.memory.get(at).copied()
    }

    fn put(&mut self, at: u64, line: &Line) {
        self.memory.set(at, line);
    }

    fn forget(&mut self, lines: Range<u64>) {
        self.memory.forget(lines);
    }

    fn advance(&mut self, cycles: u64) -> Result<(), TransportError> {
        self.cycle += cycles;
        self.poll()
    }

    fn cycle(&self) -> u64 {
        self.cycle
    }

    fn watch(&mut self, lines: Range<u64>) {
        if !self.watched.contains(&lines) {
            self.watched.push(lines);
        }
    }

    fn device_writes(&self) -> &[DeviceWrite] {
        &self.log
    }

    fn link(&self) -> &LinkModel {
        &self.link
    }

    fn traffic(&self) -> Traffic {
        self.traffic
    }
}
