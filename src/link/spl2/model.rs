//! SPL2 in operation: one call per clock cycle.

use std::collections::VecDeque;
use std::ops::Range;

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::error::Spl2Error;
use super::header::{Header, Receive, Receive0, Transmit, read_response, write_response};
use super::monitor::{Direction, Guard, Limits};
use super::pages::Pages;
use super::reads::Reads;
use super::writes::Writes;
use crate::link::regulator::Gate;
use crate::link::{LINE_BYTES, Line, Link, Requests, Stalls};

/// Dword 0 of the SPL DSM's line 0 once SPL has that DSM. Any number but 0 serves a host that polls.
pub const SPL_ID: u32 = 0x5350_4C32;

/// Byte offsets of SPL's own CSRs. Of two halves, the high one is written first, and the low one commits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CsrOffset {
    /// Physical address of the SPL DSM, high half.
    DsmHigh = 0x1000,
    /// Low half.
    DsmLow = 0x1004,
    /// Physical address of the SPL2 context, high half.
    ContextHigh = 0x1008,
    /// Low half.
    ContextLow = 0x100C,
    /// Bit 0 reset, bit 1 enable.
    Control = 0x1010,
}

/// The first offset that belongs to the AFU.
const SPL_END: u32 = 0x2000;

/// Parameters of SPL2 beyond its [`LinkModel`](crate::link::LinkModel).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spl2Model {
    /// Cycles of a CSR write: about 145 (730 ns) according to the driver's platform file.
    pub csr_cycles: u32,
    /// True if reads return in the order of requests, from a window of 64, as with SPL2. Otherwise the AFU sees any
    /// order.
    pub reads_in_order: bool,
    /// Cycles of `spl_reset` after a 1 to the control's bit 0. With 0, as long as the bit is set. (Which one is real is
    /// not known.)
    pub reset_cycles: u32,
    /// The share of cycles in which acknowledgements are held back, so that two can arrive at once.
    pub held: f64,
    /// True if a fence is acknowledged. (The real behaviour is not known.)
    pub fence_answers: bool,
    /// Spans in which almost-full is high for a reason unknown to the AFU.
    pub almostfull: Stalls,
}

impl Default for Spl2Model {
    fn default() -> Self {
        Self {
            csr_cycles: 145,
            reads_in_order: true,
            reset_cycles: 16,
            held: 0.125,
            fence_answers: false,
            almostfull: Stalls::default(),
        }
    }
}

/// A write by the AFU to one of the watched lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceWrite {
    /// Physical line address.
    pub address: u64,
    /// The line.
    pub data: Line,
    /// The cycle.
    pub cycle: u64,
}

/// Events that tests require to have happened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Cycles in which writes were acknowledged on both channels.
    pub on_both: u64,
    /// Cycles in which a request came although almost-full was high.
    pub after_almostfull: u64,
    /// The most requests of one direction after almost-full rose.
    pub most_after: u32,
}

/// SPL2 over a link, with the memory behind it.
#[derive(Clone, Debug)]
pub struct Spl2 {
    model: Spl2Model,
    link: Link,
    random: Xoshiro256PlusPlus,
    cycle: u64,
    /// Offset, value and the cycle in which it arrives.
    csr_writes: VecDeque<(u64, u32, u32)>,
    high: u32,
    context: u64,
    pages: Option<Pages>,
    control: u32,
    reset_until: u64,
    /// The cycle since which the AFU has not been enabled.
    disabled_since: u64,
    reads: Reads,
    writes: Writes,
    read_checks: Direction,
    write_checks: Direction,
    read_gate: Gate,
    write_gate: Gate,
    guard: Guard,
    watched: Vec<Range<u64>>,
    log: Vec<DeviceWrite>,
    seen: Seen,
}

impl Spl2 {
    /// SPL2 like `model` over `link`; the same for the same seed.
    pub fn new(model: Spl2Model, link: Link, seed: u64) -> Self {
        Self {
            model,
            link,
            random: Xoshiro256PlusPlus::seed_from_u64(seed ^ u64::from(SPL_ID)),
            cycle: 0,
            csr_writes: VecDeque::new(),
            high: 0,
            context: 0,
            pages: None,
            control: 0,
            reset_until: 0,
            disabled_since: 0,
            reads: Reads::default(),
            writes: Writes::default(),
            read_checks: Direction::new("read"),
            write_checks: Direction::new("write"),
            read_gate: Gate::new(model.almostfull),
            write_gate: Gate::new(model.almostfull),
            guard: Guard::default(),
            watched: Vec::new(),
            log: Vec::new(),
            seen: Seen::default(),
        }
    }

    /// The model.
    pub fn model(&self) -> &Spl2Model {
        &self.model
    }

    /// The link below, with the memory.
    pub fn link(&self) -> &Link {
        &self.link
    }

    /// The link below, with the memory, for the host's hand and to plant faults.
    pub fn link_mut(&mut self) -> &mut Link {
        &mut self.link
    }

    /// The events so far.
    pub fn seen(&self) -> Seen {
        self.seen
    }

    /// Writes to these physical lines are logged from now on.
    pub fn watch(&mut self, lines: Range<u64>) {
        if !self.watched.contains(&lines) {
            self.watched.push(lines);
        }
    }

    /// The AFU's writes to watched lines, in the order in which they arrived.
    pub fn log(&self) -> &[DeviceWrite] {
        &self.log
    }

    /// From now on the AFU may touch these virtual lines alone, or again all.
    pub fn limit(&mut self, limits: Option<Limits>) {
        self.guard.set(limits);
    }

    /// The cycle in which a line of the limited job's results was sent.
    pub fn written(&self, virtual_line: u64) -> Option<u64> {
        self.guard.written(virtual_line)
    }

    /// Reads, and writes, on their way that were asked for before the last reset or disabling.
    pub fn stale(&self) -> (usize, usize) {
        (self.reads.stale(), self.writes.stale())
    }

    /// The host writes a CSR; it arrives [`Spl2Model::csr_cycles`] later.
    pub fn write_csr(&mut self, byte_offset: u32, value: u32) {
        self.csr_writes.push_back((self.cycle + u64::from(self.model.csr_cycles), byte_offset, value));
    }

    /// The system's reset: nothing that was asked for is answered, no register keeps its value.
    pub fn system_reset(&mut self) {
        self.reads.forget();
        self.writes.forget();
        self.read_checks.forget();
        self.write_checks.forget();
        self.csr_writes.clear();
        self.pages = None;
        (self.control, self.reset_until, self.disabled_since) = (0, 0, self.cycle);
    }

    fn enabled(&self) -> bool {
        self.control & 2 != 0 && !self.in_reset()
    }

    fn in_reset(&self) -> bool {
        match self.model.reset_cycles {
            0 => self.control & 1 != 0,
            _ => self.cycle < self.reset_until,
        }
    }

    /// One clock cycle: takes what the AFU transmits in it, gives what it receives in it.
    ///
    /// # Errors
    /// Returns the violations of the AFU or the host.
    pub fn cycle(&mut self, transmit: &Transmit) -> Result<Receive, Spl2Error> {
        self.cycle += 1;
        let config = self.take_csr()?;
        let read_stalls = !self.read_gate.is_open(&mut self.random);
        let write_stalls = !self.write_gate.is_open(&mut self.random);
        let read_almostfull = self.reads.almostfull() || read_stalls;
        let write_almostfull = self.writes.almostfull() || write_stalls;
        self.accept(transmit, read_almostfull, write_almostfull)?;
        self.run_link()?;

        let channel0 = match config {
            Some(config) => Some(config),
            None => self.reads.deliver(self.model.reads_in_order).map(|(mdata, data)| {
                self.read_checks.answered(mdata);
                Receive0::Read { header: read_response(mdata), data }
            }),
        };
        let (on0, on1) = self.writes.deliver(channel0.is_none(), self.model.held, &mut self.random);
        self.seen.on_both += u64::from(on0.is_some() && on1.is_some());
        for mdata in [on0, on1].into_iter().flatten() {
            self.write_checks.answered(mdata);
        }
        let write = |mdata: u16| Receive0::Write { header: write_response(mdata) };
        Ok(Receive {
            enable: self.enabled(),
            reset: self.in_reset(),
            read_almostfull,
            write_almostfull,
            channel0: channel0.or(on0.map(write)),
            channel1: on1.map(write_response),
        })
    }

    /// What the AFU sends goes into SPL's queues; while it is disabled, only physical writes.
    fn accept(&mut self, transmit: &Transmit, read_full: bool, write_full: bool) -> Result<(), Spl2Error> {
        if transmit.interrupt {
            return Err(Spl2Error::Interrupt);
        }
        let enabled = self.enabled();
        if enabled {
            self.disabled_since = self.cycle;
        }
        let disabled_for = (!enabled).then(|| self.cycle - self.disabled_since);
        let after_reads = self.read_checks.count(read_full, transmit.read.is_some())?;
        let after_writes = self.write_checks.count(write_full, transmit.write.is_some())?;
        let late = read_full && transmit.read.is_some() || write_full && transmit.write.is_some();
        self.seen.after_almostfull += u64::from(late);
        self.seen.most_after = self.seen.most_after.max(after_reads).max(after_writes);
        if let Some(bits) = transmit.read {
            let header = self.read_checks.header(bits, disabled_for)?;
            if enabled {
                self.guard.read(header.line)?;
                self.read_checks.sent(header.mdata)?;
                self.reads.push(header);
            }
        }
        if let Some((bits, data)) = transmit.write {
            let header = self.write_checks.header(bits, disabled_for)?;
            let is_fence = header.kind == Header::WRITE_FENCE;
            if enabled || !header.is_virtual {
                if header.is_virtual && !is_fence {
                    self.guard.write(header.line, self.cycle)?;
                }
                if !is_fence || self.model.fence_answers {
                    self.write_checks.sent(header.mdata)?;
                }
                self.writes.push(header, data);
            }
        }
        Ok(())
    }

    fn physical(&self, header: &Header, what: &'static str) -> Result<u64, Spl2Error> {
        if !header.is_virtual {
            return Ok(header.line);
        }
        let physical = self.pages.as_ref().and_then(|pages| pages.translate(header.line));
        physical.ok_or(Spl2Error::PageFault { what, line: header.line })
    }

    fn run_link(&mut self) -> Result<(), Spl2Error> {
        if let Some(mdata) = self.writes.pass_fence().filter(|_| self.model.fence_answers) {
            self.writes.acknowledge(mdata);
        }
        let read = self.reads.head().map(|header| self.physical(header, "read")).transpose()?;
        let write = self.writes.head().map(|header| self.physical(header, "write")).transpose()?;
        let requests = Requests {
            read: read.map(|address| self.reads.request(address)),
            write: write.and_then(|address| self.writes.request(address)),
        };
        let replies = self.link.cycle(&requests);
        if read.is_some() && replies.read_ready {
            self.reads.sent();
        }
        if let Some(address) = write.filter(|_| replies.write_ready) {
            self.writes.sent(address);
        }
        if let Some(response) = &replies.read {
            self.reads.answered(response);
        }
        if let Some(written) = replies.write.and_then(|response| self.writes.answered(&response))
            && self.watched.iter().any(|lines| lines.contains(&written.address))
        {
            self.log.push(DeviceWrite { address: written.address, data: written.data, cycle: self.cycle });
        }
        Ok(())
    }

    /// The CSR write that arrives in this cycle: SPL's own, or the AFU's.
    fn take_csr(&mut self) -> Result<Option<Receive0>, Spl2Error> {
        let Some(&(_, offset, value)) = self.csr_writes.front().filter(|(due, ..)| *due <= self.cycle) else {
            return Ok(None);
        };
        self.csr_writes.pop_front();
        if offset >= SPL_END {
            return Ok(Some(Receive0::Config { header: (offset / 4) & 0x3fff, value }));
        }
        let address = u64::from(self.high) << 32 | u64::from(value);
        if [CsrOffset::DsmHigh as u32, CsrOffset::ContextHigh as u32].contains(&offset) {
            self.high = value;
        } else if offset == CsrOffset::DsmLow as u32 {
            let mut line = [0; 16];
            line[0] = SPL_ID;
            self.link.memory.set(address / LINE_BYTES, &line);
        } else if offset == CsrOffset::ContextLow as u32 {
            self.context = address;
        } else if offset == CsrOffset::Control as u32 {
            self.set_control(value)?;
        }
        Ok(None)
    }

    fn set_control(&mut self, value: u32) -> Result<(), Spl2Error> {
        let was_enabled = self.control & 2 != 0;
        if value & 1 != 0 && self.model.reset_cycles != 0 {
            self.reset_until = self.cycle + u64::from(self.model.reset_cycles);
        }
        if value & 1 != 0 || was_enabled && value & 2 == 0 {
            self.reads.reset().into_iter().for_each(|mdata| self.read_checks.answered(mdata));
            self.writes.reset().into_iter().for_each(|mdata| self.write_checks.answered(mdata));
        }
        if value & 2 != 0 && !was_enabled {
            self.pages = Some(Pages::read(&self.link.memory, self.context)?);
        }
        self.control = value;
        Ok(())
    }
}
