//! The ports of the `line` shell.

use super::job::Job;
use crate::afu::port::{self, Declaration, JobInputs, JobOutputs, ReadInputs, ReadOutputs, WriteInputs, WriteOutputs};
use crate::afu::{EPOCH_BITS, Spec};
use crate::config::{Config, Input, Results};
use crate::cosim::error::SimulationError;
use crate::cosim::instance::Instance;
use crate::cosim::port::Port;
use crate::link::{ReadRequest, Replies, Requests, WriteRequest};

/// The AFU's ports, fetched once.
#[derive(Debug)]
pub(super) struct Ports<'a> {
    /// Bits of a tag: those of the AFU that is driven.
    pub(super) tag_bits: u32,
    reset: Port<'a>,
    reset_active_low: bool,
    job: JobInputs<Port<'a>>,
    told: JobOutputs<Port<'a>>,
    read_replies: ReadInputs<Port<'a>>,
    write_replies: WriteInputs<Port<'a>>,
    reads: ReadOutputs<Port<'a>>,
    writes: WriteOutputs<Port<'a>>,
}

/// The counters of the AFU.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counters {
    pub(super) contacts: u32,
    pub(super) candidates: Option<u32>,
    pub(super) invalid: u32,
    pub(super) first_invalid: u32,
    pub(super) busy: u64,
    pub(super) input: u64,
    pub(super) output: u64,
}

impl<'a> Ports<'a> {
    pub(super) fn new(afu: &'a Instance) -> Result<Self, SimulationError> {
        let reset_active_low = !afu.has_port("rst") && afu.has_port("rst_n");
        let results = if afu.has_port("destination_lines") { Results::Hits } else { Results::All };
        let input = if afu.has_port("others") { Input::Spheres } else { Input::Direct };
        let mut spec = Spec::from(Config { input, results, ..Config::default() });
        // A tag that is too short or too long is refused below: its port has another width than any AFU's.
        let tag_bits = afu.port_list().into_iter().find(|(name, ..)| name == "rd_req_tag").map(|(_, bits, _)| bits);
        if let Some(slot_bits) = tag_bits.and_then(|bits| bits.checked_sub(EPOCH_BITS)).filter(|bits| *bits <= 8) {
            spec.max_outstanding = 1 << slot_bits;
        }
        let input = |port: Declaration| afu.input(port.name, port.bits);
        let output = |port: Declaration| afu.output(port.name, port.bits);
        Ok(Self {
            tag_bits: spec.tag_bits(),
            reset: input(port::reset(reset_active_low))?,
            reset_active_low,
            job: JobInputs::of(&spec).try_map(input)?,
            told: JobOutputs::of(&spec).try_map(output)?,
            read_replies: ReadInputs::of(&spec).try_map(input)?,
            write_replies: WriteInputs::of(&spec).try_map(input)?,
            reads: ReadOutputs::of(&spec).try_map(output)?,
            writes: WriteOutputs::of(&spec).try_map(output)?,
        })
    }

    pub(super) fn reset(&self, active: bool) {
        self.reset.set((active != self.reset_active_low).into());
    }

    /// Sets all requests to idle.
    pub(super) fn quiet(&self) {
        self.job.start.set(0);
        self.job.abort_job.set(0);
    }

    pub(super) fn start(&self, job: &Job, epoch: u8) {
        let ports = &self.job;
        ports.source.set(job.source_address);
        ports.destination.set(job.destination_address);
        if let Some(port) = ports.destination_lines {
            port.set(job.destination_lines.min(u64::from(u32::MAX)));
        }
        ports.count.set(job.pairs.into());
        if let Some(port) = ports.others {
            port.set(job.others.into());
        }
        ports.mode.set(job.mode.into());
        ports.epoch.set(epoch.into());
        ports.watchdog.set(job.watchdog.into());
        ports.abort_job.set(0);
        ports.start.set(1);
    }

    /// Clears `start`, and every input that needs to be valid only with it.
    pub(super) fn started(&self) {
        let ports = self.job.named().into_iter().filter(|(name, _)| *name != "abort_job");
        ports.for_each(|(_, port)| port.set(0));
    }

    pub(super) fn abort(&self, active: bool) {
        self.job.abort_job.set(active.into());
    }

    pub(super) fn is_busy(&self) -> bool {
        self.told.busy.is_high()
    }

    pub(super) fn is_done(&self) -> bool {
        self.told.done.is_high()
    }

    pub(super) fn error(&self) -> u8 {
        self.told.error.get() as u8
    }

    pub(super) fn capability(&self) -> u64 {
        self.told.capability.get()
    }

    pub(super) fn counters(&self) -> Counters {
        Counters {
            contacts: self.told.contacts.get() as u32,
            candidates: self.told.candidates.map(|port| port.get() as u32),
            invalid: self.told.invalid.get() as u32,
            first_invalid: self.told.first_invalid.get() as u32,
            busy: self.told.cycles_busy.get(),
            input: self.told.cycles_input.get(),
            output: self.told.cycles_output.get(),
        }
    }

    /// The AFU's requests in this cycle.
    #[inline]
    pub(super) fn requests(&self) -> Requests {
        let (reads, writes) = (&self.reads, &self.writes);
        let read = reads
            .rd_req_valid
            .is_high()
            .then(|| ReadRequest { address: reads.rd_req_address.get(), tag: reads.rd_req_tag.get() as u16 });
        let write = writes.wr_req_valid.is_high().then(|| WriteRequest {
            address: writes.wr_req_address.get(),
            tag: writes.wr_req_tag.get() as u16,
            data: writes.wr_req_data.words(),
        });
        Requests { read, write }
    }

    /// Applies the link's outputs of this cycle. Without a response, tag and data keep their old values, which are
    /// invalid.
    #[inline]
    pub(super) fn reply(&self, replies: &Replies) {
        self.read_replies.rd_req_ready.set(replies.read_ready.into());
        self.write_replies.wr_req_ready.set(replies.write_ready.into());
        self.read_replies.rd_rsp_valid.set(replies.read.is_some().into());
        self.write_replies.wr_rsp_valid.set(replies.write.is_some().into());
        if let Some(read) = &replies.read {
            self.read_replies.rd_rsp_tag.set(read.tag.into());
            self.read_replies.rd_rsp_data.set_words(&read.data);
            self.read_replies.rd_rsp_error.set(read.error.into());
        }
        if let Some(write) = &replies.write {
            self.write_replies.wr_rsp_tag.set(write.tag.into());
            self.write_replies.wr_rsp_error.set(write.error.into());
        }
    }
}
