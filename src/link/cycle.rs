//! The link in operation: one call per clock cycle.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::fault::Fault;
use super::memory::{Line, Memory};
use super::model::{LinkError, LinkModel};
use super::queue::Queue;
use super::regulator::{Bucket, Gate};

/// A request to read a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadRequest {
    /// Line address.
    pub address: u64,
    /// Comes back with the response.
    pub tag: u16,
}

/// A request to write a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WriteRequest {
    /// Line address.
    pub address: u64,
    /// Comes back with the response.
    pub tag: u16,
    /// The line.
    pub data: Line,
}

/// The requests of an AFU in a cycle. A request that is not accepted is repeated unchanged in the next cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Requests {
    /// A read.
    pub read: Option<ReadRequest>,
    /// A write.
    pub write: Option<WriteRequest>,
}

/// The response to a read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadResponse {
    /// The tag of the request.
    pub tag: u16,
    /// The line.
    pub data: Line,
    /// True if the read failed.
    pub error: bool,
}

/// The response to a write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WriteResponse {
    /// The tag of the request.
    pub tag: u16,
    /// True if the write failed.
    pub error: bool,
}

/// The outputs of the link in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Replies {
    /// True if a read request is accepted in this cycle.
    pub read_ready: bool,
    /// True if a write request is accepted in this cycle.
    pub write_ready: bool,
    /// The response to an earlier read.
    pub read: Option<ReadResponse>,
    /// The response to an earlier write.
    pub write: Option<WriteResponse>,
}

/// Requests accepted and responses given so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Read requests accepted.
    pub reads: u64,
    /// Responses to reads.
    pub read_responses: u64,
    /// Write requests accepted.
    pub writes: u64,
    /// Responses to writes.
    pub write_responses: u64,
}

#[derive(Clone, Copy, Debug)]
struct Read {
    address: u64,
    tag: u16,
    error: bool,
    /// The read waits for the next read, to swap data with it.
    held: bool,
    flipped: Option<u16>,
}

#[derive(Clone, Copy, Debug)]
struct Write {
    request: WriteRequest,
    error: bool,
    /// The job that the write belongs to; `None` if it must not be done.
    job: Option<u64>,
}

/// A link with its memory. It lives as long as the host, so requests that an AFU forgot in a reset are still answered.
#[derive(Clone, Debug)]
pub struct Link {
    model: LinkModel,
    /// The memory behind the link.
    pub memory: Memory,
    random: Xoshiro256PlusPlus,
    now: u64,
    reads: Queue<Read>,
    writes: Queue<Write>,
    read_gate: Gate,
    write_gate: Gate,
    read_bucket: Bucket,
    write_bucket: Bucket,
    joint_bucket: Bucket,
    faults: Vec<Fault>,
    /// The traffic at the time when the faults were planned, because they count from there.
    planned_at: Traffic,
    traffic: Traffic,
}

impl Link {
    /// A link that follows `model`, to empty memory. The same `seed` gives the same link.
    ///
    /// # Errors
    /// Returns an error if the model holds a value outside its range.
    pub fn new(model: LinkModel, seed: u64) -> Result<Self, LinkError> {
        model.check()?;
        Ok(Self {
            memory: Memory::new(),
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
            now: 0,
            reads: Queue::new(model.read, model.order),
            writes: Queue::new(model.write, model.write_order.unwrap_or(model.order)),
            read_gate: Gate::new(model.read.stalls),
            write_gate: Gate::new(model.write.stalls),
            read_bucket: Bucket::new(model.read.lines_per_cycle),
            write_bucket: Bucket::new(model.write.lines_per_cycle),
            joint_bucket: Bucket::new(model.lines_per_cycle),
            faults: model.faults.clone(),
            planned_at: Traffic::default(),
            traffic: Traffic::default(),
            model,
        })
    }

    /// The model of the link.
    pub fn model(&self) -> &LinkModel {
        &self.model
    }

    /// The traffic so far.
    pub fn traffic(&self) -> Traffic {
        self.traffic
    }

    /// The numbers of outstanding reads and writes. Requests whose response is lost do not count.
    pub fn in_flight(&self) -> (usize, usize) {
        (self.reads.len(), self.writes.len())
    }

    /// Plants faults in place of those planned before. They count requests from now on.
    pub fn plan(&mut self, faults: &[Fault]) {
        self.faults = faults.to_vec();
        self.planned_at = self.traffic;
    }

    /// Advances one clock cycle: takes the AFU's outputs in this cycle and returns its inputs in the same cycle. A
    /// request accepted in this cycle is answered in a later one.
    pub fn cycle(&mut self, requests: &Requests) -> Replies {
        self.now += 1;
        self.read_bucket.drip();
        self.joint_bucket.drip();
        // The directions share a bandwidth, and each has priority in every other cycle. A read takes its share when its
        // data arrives, a write when its data leaves.
        let (read, write_ready) = if self.now.is_multiple_of(2) {
            let read = self.answer_read();
            (read, self.offer_write(requests))
        } else {
            let ready = self.offer_write(requests);
            (self.answer_read(), ready)
        };
        let write = self.answer_write();
        let read_ready = self.read_gate.is_open(&mut self.random) && self.reads.has_room();
        if let Some(request) = requests.read.filter(|_| read_ready) {
            self.accept_read(request);
        }
        if let Some(request) = requests.write.filter(|_| write_ready) {
            self.accept_write(request);
        }
        Replies { read_ready, write_ready, read, write }
    }

    fn answer_read(&mut self) -> Option<ReadResponse> {
        if !(self.read_bucket.has_line() && self.joint_bucket.has_line()) {
            return None;
        }
        let may_leave = |read: &Read| !read.held;
        let Read { address, tag, error, flipped, .. } = self.reads.pop(self.now, &mut self.random, may_leave)?;
        self.read_bucket.take();
        self.joint_bucket.take();
        self.traffic.read_responses += 1;
        let mut data = self.memory.read(address);
        if let Some(bit) = flipped {
            data[usize::from(bit / 32) % data.len()] ^= 1 << (bit % 32);
        }
        Some(ReadResponse { tag, data, error })
    }

    fn offer_write(&mut self, requests: &Requests) -> bool {
        if !self.write_gate.is_open(&mut self.random) {
            return false;
        }
        self.write_bucket.drip(); // not in a stall, which carries nothing
        let ready = self.write_bucket.has_line() && self.joint_bucket.has_line() && self.writes.has_room();
        if ready && requests.write.is_some() {
            self.write_bucket.take();
            self.joint_bucket.take();
        }
        ready
    }

    /// A line is in memory only once its write is acknowledged, so an AFU that is done too early is detected.
    fn answer_write(&mut self) -> Option<WriteResponse> {
        let Write { request, error, job } = self.writes.pop(self.now, &mut self.random, |_| true)?;
        self.traffic.write_responses += 1;
        if let Some(job) = job.filter(|_| !error) {
            self.memory.write(request.address, &request.data, job);
        }
        Some(WriteResponse { tag: request.tag, error })
    }

    fn accept_read(&mut self, request: ReadRequest) {
        let number = self.traffic.reads - self.planned_at.reads;
        self.traffic.reads += 1;
        let ReadRequest { address, tag } = request;
        self.memory.accept_read(address);
        let mut read = Read { address, tag, error: false, held: false, flipped: None };
        for fault in &self.faults {
            match *fault {
                Fault::ReadLost(n) if n == number => return,
                Fault::ReadError(n) if n == number => read.error = true,
                Fault::ReadSwapped(n) if n == number => read.held = true,
                Fault::ReadFlipped { read: n, bit } if n == number => read.flipped = Some(bit),
                Fault::ReadTwice(n) if n == number => self.reads.push(self.now, read, &mut self.random),
                _ => {}
            }
        }
        if let Some(partner) = self.reads.iter_mut().find(|other| other.held) {
            partner.held = false;
            std::mem::swap(&mut partner.address, &mut read.address);
        }
        self.reads.push(self.now, read, &mut self.random);
    }

    fn accept_write(&mut self, request: WriteRequest) {
        let number = self.traffic.writes - self.planned_at.writes;
        self.traffic.writes += 1;
        let job = self.memory.accept_write(request.address);
        if !self.faults.contains(&Fault::WriteLost(number)) {
            let error = self.faults.contains(&Fault::WriteError(number));
            let write = Write { request, error, job };
            self.writes.push(self.now, write, &mut self.random);
            if self.faults.contains(&Fault::WriteTwice(number)) {
                self.writes.push(self.now, Write { job: None, ..write }, &mut self.random);
            }
        }
    }
}
