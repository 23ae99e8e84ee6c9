//! How many cycles each part of an AFU takes, from the numbers its hardware is generated with.

use crate::config::{RecordFormat, Results};

use super::{Afu, collector, control, dispatcher, feeder, packer, slot, top};

/// Cycles on the way of a line that meets nothing in its way, part by part, without those that the link takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Control: from `start` to the parts running.
    pub start: u32,
    /// Collector: to the first read request.
    pub request: u32,
    /// Collector: from its response to a line in order.
    pub collect: u32,
    /// Feeder: to pairs on their way to the slots.
    pub feed: u32,
    /// Slot: the SCPU, and the register before it.
    pub scpu: u32,
    /// Results of all slots or-ed together and registered.
    pub gather: u32,
    /// Packer: to a full line.
    pub pack: u32,
    /// Packer: more for a last line that is not full.
    pub flush: u32,
    /// Packer: to knowing that a job has no pairs.
    pub nothing: u32,
    /// Dispatcher: to its write request.
    pub dispatch: u32,
    /// Dispatcher: from the last acknowledgement to its being counted.
    pub acknowledge: u32,
    /// Control: to `done`.
    pub done: u32,
}

/// What the capability word calls the numbers of records.
pub(super) fn record_code(record: RecordFormat) -> u64 {
    match record {
        RecordFormat::F32 => 0,
        RecordFormat::F16 => 1,
        RecordFormat::Bf16 => 2,
    }
}

impl Afu {
    /// What the AFU says of itself in its capability word: bits 7:0 SCPUs, 15:8 interval, 19:16 contact fields (hit,
    /// depth, normal, position from bit 16 up), 24 whether contacts alone come back, 25 whether all
    /// spheres have one radius, 27:26 the numbers of records (0 f32, 1 f16, 2 bf16), 43:32 latency of an SCPU in
    /// cycles.
    pub fn capability(&self) -> u64 {
        let config = &self.spec().config;
        let fields = [config.contact.position, config.contact.normal, config.contact.depth, true];
        let mask = fields.into_iter().fold(0, |mask, bit| mask << 1 | u64::from(bit));
        let only_hits = u64::from(config.results == Results::Hits);
        let one_radius = u64::from(config.radius.is_some());
        let latency = u64::from(self.kernel().latency.min(0xfff));
        latency << 32
            | record_code(config.record) << 26
            | one_radius << 25
            | only_hits << 24
            | mask << 16
            | u64::from(config.interval.min(0xff)) << 8
            | u64::from(config.scpus)
    }

    /// What each part takes.
    pub fn timing(&self) -> Timing {
        Timing {
            start: control::CYCLES_TO_RUN,
            request: collector::CYCLES_TO_REQUEST,
            collect: collector::CYCLES_TO_LINE,
            feed: feeder::CYCLES_TO_ISSUE,
            scpu: slot::latency(self.kernel().latency),
            gather: top::RANKS_AFTER,
            pack: packer::CYCLES_TO_LINE,
            flush: packer::CYCLES_TO_FLUSH,
            nothing: packer::CYCLES_TO_NOTHING,
            dispatch: dispatcher::CYCLES_TO_REQUEST,
            acknowledge: dispatcher::CYCLES_TO_IDLE,
            done: control::CYCLES_TO_DONE,
        }
    }
}
