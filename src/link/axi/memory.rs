//! The memory: queues of bursts in front of a link.

use std::collections::{HashMap, VecDeque};
use std::ops::Range;

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::error::AxiError;
use super::monitor::Monitor;
use super::signals::{Address, DECERR, FromMemory, OKAY, ReadBeat, SLVERR, ToMemory, WriteBeat};
use crate::link::regulator::Gate;
use crate::link::{LINE_BYTES, Line, Link, LinkError, LinkModel, ReadRequest, Replies, Requests, Stalls, WriteRequest};

/// Bits of a line.
const LINE_BITS: u32 = 512;
/// Lines that wait for the link before no more addresses are taken.
const QUEUED_LINES: usize = 64;
/// Write addresses that wait for their data.
const QUEUED_ADDRESSES: usize = 4;

/// When a memory takes an address and data of a write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Handshake {
    /// Each as soon as there is room.
    #[default]
    Free,
    /// Data only when their address was taken.
    AddressFirst,
    /// An address only when data wait.
    DataFirst,
}

/// The slave in front of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxiModel {
    /// Bits of the data: 128, 256 or 512.
    pub bus: u32,
    /// When addresses and data are taken.
    pub handshake: Handshake,
}

impl AxiModel {
    /// A slave on a bus of this many bits that takes what comes.
    pub fn new(bus: u32) -> Self {
        Self { bus, handshake: Handshake::Free }
    }
}

/// A line that was asked for.
#[derive(Clone, Copy, Debug)]
struct Read {
    tag: u16,
    /// The last line of its burst.
    last: bool,
    /// Its data, and the response of each of its beats.
    received: Option<(Line, u8)>,
}

/// A write burst whose address was taken.
#[derive(Clone, Copy, Debug)]
struct Write {
    /// The line that its next beats are part of.
    line: u64,
    /// Lines that have not gone to the link.
    left: u64,
    /// Lines that the link has not acknowledged, those that have not gone included.
    unacknowledged: u64,
    response: u8,
}

/// Memory behind an AXI4 slave.
#[derive(Clone, Debug)]
pub struct AxiMemory {
    model: AxiModel,
    link: Link,
    monitor: Monitor,
    random: Xoshiro256PlusPlus,
    gates: [Gate; 5],
    cycle: u64,
    /// The tag of the next line on the link, for reads and writes.
    next_tag: u16,
    /// Lines to be read, with the mark of their burst's last.
    to_read: VecDeque<(u64, bool)>,
    reads: VecDeque<Read>,
    /// Beats of the oldest line that were given.
    beat: u32,
    beats: VecDeque<WriteBeat>,
    writes: VecDeque<Write>,
    /// The burst of each write on the link, counted from the first.
    burst_of: HashMap<u16, u64>,
    /// Bursts that were answered.
    answered: u64,
    sent: HashMap<u64, u64>,
    violations: u64,
    /// Responses that nobody asked for, of channels R and B, still to be given.
    unasked: [bool; 2],
    /// The lines where there is no memory.
    absent: Range<u64>,
}

impl AxiMemory {
    /// An empty memory behind a link and a slave.
    ///
    /// # Errors
    /// Returns an error if the link's model holds a value outside its range.
    pub fn new(model: AxiModel, link: LinkModel, seed: u64) -> Result<Self, LinkError> {
        let link = Link::new(link.on_bus(model.bus), seed)?;
        let LinkModel { read, write, .. } = link.model();
        let [ar, r, aw, w, b] = [read.stalls, read.stalls, write.stalls, write.stalls, write.stalls].map(Gate::new);
        Ok(Self {
            model,
            monitor: Monitor::new(u64::from(model.bus / 8)),
            random: Xoshiro256PlusPlus::seed_from_u64(seed ^ 0xA814),
            gates: [ar, r, aw, w, b],
            cycle: 0,
            next_tag: 0,
            to_read: VecDeque::new(),
            reads: VecDeque::new(),
            beat: 0,
            beats: VecDeque::new(),
            writes: VecDeque::new(),
            burst_of: HashMap::new(),
            answered: 0,
            sent: HashMap::new(),
            violations: 0,
            unasked: [false; 2],
            absent: 0..0,
            link,
        })
    }

    /// The link below, with the memory.
    pub fn link(&self) -> &Link {
        &self.link
    }

    /// The link below, to plant faults.
    pub fn link_mut(&mut self) -> &mut Link {
        &mut self.link
    }

    /// The slave's model.
    pub fn model(&self) -> &AxiModel {
        &self.model
    }

    /// Plants a fault: the memory gives a beat on channel R, and a response on channel B, as soon as the channel is
    /// free, although nobody asked for it.
    pub fn give_unasked(&mut self, read: bool, write: bool) {
        self.unasked = [read, write];
    }

    /// Plants a fault: from now on there is no memory at these lines, and the interconnect answers with DECERR there.
    pub fn lacks(&mut self, lines: Range<u64>) {
        self.absent = lines;
    }

    /// The stalls of the slave's channels, beside the link's own: of reads, and of writes.
    pub(crate) fn stalls(&self) -> ([Stalls; 2], [Stalls; 3]) {
        let LinkModel { read, write, .. } = self.link.model();
        ([read.stalls; 2], [write.stalls; 3])
    }

    /// From now on the AFU may read `source`, and write each line of `destination` once. Forgets when lines were sent.
    pub(crate) fn guard(&mut self, source: Range<u64>, destination: Range<u64>) {
        self.link.memory.guard(source, destination);
        self.violations = 0;
        self.sent.clear();
    }

    /// The cycle in which the last beat of a line was taken.
    pub(crate) fn sent(&self, line: u64) -> Option<u64> {
        self.sent.get(&line).copied()
    }

    /// The interconnect is in reset, with the AFU. What was asked for is forgotten; memory keeps its content.
    ///
    /// # Errors
    /// Returns an error if a VALID of the AFU is high although the reset has `settled`.
    pub(crate) fn reset(&mut self, afu: &ToMemory, settled: bool) -> Result<(), AxiError> {
        self.monitor.reset(afu, settled)?;
        self.cycle += 1;
        self.link.cycle(&Requests::default());
        self.to_read.clear();
        self.reads.clear();
        self.beats.clear();
        self.writes.clear();
        self.burst_of.clear();
        (self.beat, self.answered) = (0, 0);
        Ok(())
    }

    /// Advances one cycle: takes the AFU's outputs in it, and returns its inputs in the same cycle.
    ///
    /// # Errors
    /// Returns an error if the AFU breaks a rule of AXI4, or reads or writes a line that it must not.
    pub(crate) fn cycle(&mut self, afu: &ToMemory) -> Result<FromMemory, AxiError> {
        self.cycle += 1;
        self.move_lines();
        let open: [bool; 5] = std::array::from_fn(|index| self.gates[index].is_open(&mut self.random));
        let [ar, r, aw, w, b] = open;
        let room = self.beats.len() < 2 * self.beats_per_line();
        let handshake = self.model.handshake;
        let may_address = handshake != Handshake::DataFirst || !self.beats.is_empty();
        // Data of a burst whose address is not there: only those behind the bursts that are.
        let owed: u64 = self.writes.iter().map(|write| write.left).sum::<u64>() * self.beats_per_line() as u64;
        let may_send = handshake != Handshake::AddressFirst || owed > self.beats.len() as u64;
        let from = FromMemory {
            ar_ready: ar && self.to_read.len() < QUEUED_LINES,
            aw_ready: aw && may_address && self.waiting_addresses() < QUEUED_ADDRESSES,
            w_ready: w && may_send && room,
            r: if r { self.read_beat() } else { None },
            b: if b { self.write_response() } else { None },
        };
        self.monitor.check(afu, &from)?;
        if let Some(burst) = afu.ar.filter(|_| from.ar_ready) {
            let lines = self.lines(&burst);
            let first = burst.address / LINE_BYTES;
            self.to_read.extend((0..lines).map(|line| (first + line, line + 1 == lines)));
        }
        if let Some(burst) = afu.aw.filter(|_| from.aw_ready) {
            let lines = self.lines(&burst);
            let line = burst.address / LINE_BYTES;
            self.writes.push_back(Write { line, left: lines, unacknowledged: lines, response: OKAY });
        }
        if let Some(beat) = afu.w.filter(|_| from.w_ready) {
            self.beats.push_back(beat);
        }
        let count = self.link.memory.violation_count();
        if std::mem::replace(&mut self.violations, count) < count
            && let Some(&violation) = self.link.memory.violations().last()
        {
            return Err(violation.into());
        }
        Ok(self.with_unasked(from))
    }

    /// The outputs with what a planted fault adds to them, which the monitor does not see.
    fn with_unasked(&mut self, mut from: FromMemory) -> FromMemory {
        let [read, write] = &mut self.unasked;
        if from.r.is_none() && std::mem::take(read) {
            from.r = Some(ReadBeat { data: [0; 16], response: OKAY, last: true });
        }
        if from.b.is_none() && std::mem::take(write) {
            from.b = Some(OKAY);
        }
        from
    }

    fn lines(&self, burst: &Address) -> u64 {
        burst.beats() / self.beats_per_line() as u64
    }

    fn beats_per_line(&self) -> usize {
        (LINE_BITS / self.model.bus) as usize
    }

    fn waiting_addresses(&self) -> usize {
        self.writes.iter().filter(|write| write.left > 0).count()
    }

    /// Answers the next accesses of lines where there is no memory, in their turn and without the link.
    fn refuse_lines(&mut self) {
        while let Some((_, last)) = self.to_read.front().copied().filter(|(line, _)| self.absent.contains(line)) {
            self.to_read.pop_front();
            self.reads.push_back(Read { tag: 0, last, received: Some(([0; 16], DECERR)) });
        }
        if self.next_line().is_some_and(|(line, _)| self.absent.contains(&line))
            && let Some(write) = self.writes.iter_mut().find(|write| write.left > 0)
        {
            (write.line, write.left) = (write.line + 1, write.left - 1);
            write.unacknowledged -= 1;
            write.response = DECERR;
            self.beats.drain(..self.beats_per_line());
        }
    }

    /// One cycle of the link.
    fn move_lines(&mut self) {
        self.refuse_lines();
        let tag = self.next_tag;
        let read = self.to_read.front().map(|&(address, _)| ReadRequest { address, tag });
        let write = self.next_line().map(|(address, data)| WriteRequest { address, tag, data });
        let Replies { read_ready, write_ready, read: received, write: acknowledged } =
            self.link.cycle(&Requests { read, write });
        let write = write.filter(|_| write_ready);
        if let Some((_, last)) = self.to_read.front().copied().filter(|_| read_ready) {
            self.next_tag = tag.wrapping_add(1);
            self.to_read.pop_front();
            self.reads.push_back(Read { tag, last, received: None });
        }
        if let Some(WriteRequest { address, .. }) = write {
            self.next_tag = tag.wrapping_add(1);
            self.beats.drain(..self.beats_per_line());
            self.sent.insert(address, self.cycle);
            if let Some(index) = self.writes.iter().position(|write| write.left > 0) {
                let write = &mut self.writes[index];
                (write.line, write.left) = (write.line + 1, write.left - 1);
                self.burst_of.insert(tag, self.answered + index as u64);
            }
        }
        if let Some(response) = received {
            // A tag that is unknown is of before a reset.
            let read = self.reads.iter_mut().find(|read| read.tag == response.tag && read.received.is_none());
            if let Some(read) = read {
                read.received = Some((response.data, if response.error { SLVERR } else { OKAY }));
            }
        }
        if let Some(response) = acknowledged
            && let Some(burst) = self.burst_of.remove(&response.tag)
            && let Some(write) = self.writes.get_mut((burst - self.answered) as usize)
        {
            write.unacknowledged -= 1;
            // The codes of errors are above that of success.
            write.response = write.response.max(if response.error { SLVERR } else { OKAY });
        }
    }

    /// The next whole line to be written.
    fn next_line(&self) -> Option<(u64, Line)> {
        let write = self.writes.iter().find(|write| write.left > 0)?;
        let (words, number) = (self.model.bus as usize / 32, self.beats_per_line());
        if self.beats.len() < number {
            return None;
        }
        let mut line: Line = [0; 16];
        for (part, beat) in line.chunks_mut(words).zip(&self.beats) {
            part.copy_from_slice(&beat.data[..words]);
        }
        Some((write.line, line))
    }

    fn read_beat(&mut self) -> Option<ReadBeat> {
        let Read { last, received, .. } = *self.reads.front()?;
        let (line, response) = received?;
        let words = self.model.bus as usize / 32;
        let mut data = [0; 16];
        data[..words].copy_from_slice(&line[self.beat as usize * words..][..words]);
        self.beat += 1;
        let ends = self.beat as usize == self.beats_per_line();
        if ends {
            self.beat = 0;
            self.reads.pop_front();
        }
        Some(ReadBeat { data, response, last: ends && last })
    }

    fn write_response(&mut self) -> Option<u8> {
        let Write { response, .. } = *self.writes.front().filter(|write| write.unacknowledged == 0)?;
        self.writes.pop_front();
        self.answered += 1;
        Some(response)
    }
}
