//! The ports of the `line` shell.

use super::job::Job;
use crate::cosim::error::SimulationError;
use crate::cosim::instance::Instance;
use crate::cosim::port::{Port, Wide};
use crate::link::{ReadRequest, Replies, Requests, WriteRequest};

/// The AFU's ports, fetched once.
#[derive(Debug)]
pub(super) struct Ports<'a> {
    reset: Port<'a>,
    reset_active_low: bool,
    start: Port<'a>,
    source: Port<'a>,
    destination: Port<'a>,
    /// Only where only contacts come back.
    destination_lines: Option<Port<'a>>,
    count: Port<'a>,
    mode: Port<'a>,
    epoch: Port<'a>,
    watchdog: Port<'a>,
    abort_job: Port<'a>,
    busy: Port<'a>,
    done: Port<'a>,
    error: Port<'a>,
    contacts: Port<'a>,
    invalid: Port<'a>,
    first_invalid: Port<'a>,
    cycles_busy: Port<'a>,
    cycles_input: Port<'a>,
    cycles_output: Port<'a>,
    capability: Port<'a>,
    rd_req_valid: Port<'a>,
    rd_req_address: Port<'a>,
    rd_req_tag: Port<'a>,
    rd_req_ready: Port<'a>,
    rd_rsp_valid: Port<'a>,
    rd_rsp_tag: Port<'a>,
    rd_rsp_data: Wide<'a, 16>,
    rd_rsp_error: Port<'a>,
    wr_req_valid: Port<'a>,
    wr_req_address: Port<'a>,
    wr_req_tag: Port<'a>,
    wr_req_data: Wide<'a, 16>,
    wr_req_ready: Port<'a>,
    wr_rsp_valid: Port<'a>,
    wr_rsp_tag: Port<'a>,
    wr_rsp_error: Port<'a>,
}

/// What the AFU counted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counters {
    pub(super) contacts: u32,
    pub(super) invalid: u32,
    pub(super) first_invalid: u32,
    pub(super) busy: u64,
    pub(super) input: u64,
    pub(super) output: u64,
}

impl<'a> Ports<'a> {
    pub(super) fn new(afu: &'a Instance) -> Result<Self, SimulationError> {
        let reset_active_low = !afu.has_port("rst") && afu.has_port("rst_n");
        Ok(Self {
            reset: afu.input(if reset_active_low { "rst_n" } else { "rst" }, 1)?,
            reset_active_low,
            start: afu.input("start", 1)?,
            source: afu.input("source", 58)?,
            destination: afu.input("destination", 58)?,
            destination_lines: optional(afu, "destination_lines", 32)?,
            count: afu.input("count", 32)?,
            mode: afu.input("mode", 4)?,
            epoch: afu.input("epoch", 4)?,
            watchdog: afu.input("watchdog", 32)?,
            abort_job: afu.input("abort_job", 1)?,
            busy: afu.output("busy", 1)?,
            done: afu.output("done", 1)?,
            error: afu.output("error", 4)?,
            contacts: afu.output("contacts", 32)?,
            invalid: afu.output("invalid", 32)?,
            first_invalid: afu.output("first_invalid", 32)?,
            cycles_busy: afu.output("cycles_busy", 64)?,
            cycles_input: afu.output("cycles_input", 64)?,
            cycles_output: afu.output("cycles_output", 64)?,
            capability: afu.output("capability", 64)?,
            rd_req_valid: afu.output("rd_req_valid", 1)?,
            rd_req_address: afu.output("rd_req_address", 58)?,
            rd_req_tag: afu.output("rd_req_tag", 10)?,
            rd_req_ready: afu.input("rd_req_ready", 1)?,
            rd_rsp_valid: afu.input("rd_rsp_valid", 1)?,
            rd_rsp_tag: afu.input("rd_rsp_tag", 10)?,
            rd_rsp_data: afu.wide_input("rd_rsp_data")?,
            rd_rsp_error: afu.input("rd_rsp_error", 1)?,
            wr_req_valid: afu.output("wr_req_valid", 1)?,
            wr_req_address: afu.output("wr_req_address", 58)?,
            wr_req_tag: afu.output("wr_req_tag", 10)?,
            wr_req_data: afu.wide_output("wr_req_data")?,
            wr_req_ready: afu.input("wr_req_ready", 1)?,
            wr_rsp_valid: afu.input("wr_rsp_valid", 1)?,
            wr_rsp_tag: afu.input("wr_rsp_tag", 10)?,
            wr_rsp_error: afu.input("wr_rsp_error", 1)?,
        })
    }

    pub(super) fn reset(&self, active: bool) {
        self.reset.set((active != self.reset_active_low).into());
    }

    /// Asks for nothing.
    pub(super) fn quiet(&self) {
        self.start.set(0);
        self.abort_job.set(0);
    }

    pub(super) fn start(&self, job: &Job, epoch: u8) {
        self.source.set(job.source_address);
        self.destination.set(job.destination_address);
        if let Some(port) = self.destination_lines {
            port.set(job.destination_lines.min(u64::from(u32::MAX)));
        }
        self.count.set(job.pairs.into());
        self.mode.set(job.mode.into());
        self.epoch.set(epoch.into());
        self.watchdog.set(job.watchdog.into());
        self.abort_job.set(0);
        self.start.set(1);
    }

    /// Takes `start` back, and everything that needs to be right only with it.
    pub(super) fn started(&self) {
        for port in [self.start, self.source, self.destination, self.count, self.mode, self.epoch, self.watchdog] {
            port.set(0);
        }
        if let Some(port) = self.destination_lines {
            port.set(0);
        }
    }

    pub(super) fn abort(&self, active: bool) {
        self.abort_job.set(active.into());
    }

    pub(super) fn is_busy(&self) -> bool {
        self.busy.is_high()
    }

    pub(super) fn is_done(&self) -> bool {
        self.done.is_high()
    }

    pub(super) fn error(&self) -> u8 {
        self.error.get() as u8
    }

    pub(super) fn capability(&self) -> u64 {
        self.capability.get()
    }

    pub(super) fn counters(&self) -> Counters {
        Counters {
            contacts: self.contacts.get() as u32,
            invalid: self.invalid.get() as u32,
            first_invalid: self.first_invalid.get() as u32,
            busy: self.cycles_busy.get(),
            input: self.cycles_input.get(),
            output: self.cycles_output.get(),
        }
    }

    /// What the AFU asks in this cycle.
    #[inline]
    pub(super) fn requests(&self) -> Requests {
        let read = self
            .rd_req_valid
            .is_high()
            .then(|| ReadRequest { address: self.rd_req_address.get(), tag: self.rd_req_tag.get() as u16 });
        let write = self.wr_req_valid.is_high().then(|| WriteRequest {
            address: self.wr_req_address.get(),
            tag: self.wr_req_tag.get() as u16,
            data: self.wr_req_data.get(),
        });
        Requests { read, write }
    }

    /// What the link does in this cycle. Without a response, tag and data keep what they had: nobody may look.
    #[inline]
    pub(super) fn reply(&self, replies: &Replies) {
        self.rd_req_ready.set(replies.read_ready.into());
        self.wr_req_ready.set(replies.write_ready.into());
        self.rd_rsp_valid.set(replies.read.is_some().into());
        self.wr_rsp_valid.set(replies.write.is_some().into());
        if let Some(read) = &replies.read {
            self.rd_rsp_tag.set(read.tag.into());
            self.rd_rsp_data.set(&read.data);
            self.rd_rsp_error.set(read.error.into());
        }
        if let Some(write) = &replies.write {
            self.wr_rsp_tag.set(write.tag.into());
            self.wr_rsp_error.set(write.error.into());
        }
    }
}

/// An input that not every AFU has.
fn optional<'a>(afu: &'a Instance, name: &str, bits: u32) -> Result<Option<Port<'a>>, SimulationError> {
    if afu.has_port(name) { afu.input(name, bits).map(Some) } else { Ok(None) }
}
