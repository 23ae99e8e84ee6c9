//! The line port of the model: lines of spheres come in order, and lines of results leave, over a simulated link.

use std::collections::{HashSet, VecDeque};

use crate::afu::spheres::bounds::SPHERE_BITS;
use crate::afu::{Spec, collector, dispatcher, in_order};
use crate::link::{Link, LinkError, LinkModel, ReadRequest, Requests, WriteRequest};
use crate::record::LINE_BITS;

/// Cycles from the start of a job to its first request.
const CYCLES_TO_REQUEST: u64 = 6;
/// Cycles from the cycle in which a line is taken to the next request for its place, and from an acknowledgement to
/// the next request with its tag.
const CYCLES_TO_FREE: u64 = 3;
const CYCLES_TO_REUSE: u64 = in_order::CYCLES_TO_GO as u64 + 4;

/// Responses in the order of their requests, whose tags are used in turn.
#[derive(Debug, Default)]
struct InOrder {
    next: u64,
    early: HashSet<u64>,
}

impl InOrder {
    /// A response comes. Returns how many responses are now in order that were not before.
    fn come(&mut self, tag: u16, slots: u64) -> u64 {
        self.early.insert(self.next + (u64::from(tag) + slots - self.next % slots) % slots);
        let before = self.next;
        while self.early.remove(&self.next) {
            self.next += 1;
        }
        self.next - before
    }
}

/// The line port and the link behind it.
#[derive(Debug)]
pub(super) struct Port {
    link: Link,
    /// Requests of each kind that may wait for their response.
    slots: u64,
    /// Lines of spheres, and those of them that were requested.
    lines: u64,
    asked: u64,
    read: InOrder,
    /// The cycles in which lines are announced to the loader, and in which places of taken lines are free again.
    announced: VecDeque<u64>,
    freed: VecDeque<u64>,
    given: u64,
    /// Records that do not fill a line yet, and how many do.
    records: u64,
    per_line: u64,
    /// The cycles from which full lines wait, and how many may.
    waiting: VecDeque<u64>,
    room: usize,
    /// Lines requested to be written, and those of them that were acknowledged.
    written: u64,
    acknowledged: InOrder,
    /// The cycles in which tags of writes that were acknowledged are free again.
    reused: VecDeque<u64>,
}

impl Port {
    /// A port to read so many lines, with places for `room` lines that are to be written.
    pub(super) fn new(spec: &Spec, link: &LinkModel, lines: u64, room: u32) -> Result<Self, LinkError> {
        Ok(Self {
            // A job whose response is lost or repeated ends with an error, which is no prediction.
            link: Link::new(LinkModel { faults: Vec::new(), ..link.clone() }, 1)?,
            slots: spec.max_outstanding.into(),
            lines,
            asked: 0,
            read: InOrder::default(),
            announced: VecDeque::new(),
            freed: VecDeque::new(),
            given: 0,
            records: 0,
            per_line: spec.layout().contacts_per_line().into(),
            waiting: VecDeque::new(),
            room: room as usize,
            written: 0,
            acknowledged: InOrder::default(),
            reused: VecDeque::new(),
        })
    }

    /// A cycle of the link.
    pub(super) fn cycle(&mut self, now: u64) {
        for later in [&mut self.freed, &mut self.reused] {
            while later.front().is_some_and(|cycle| *cycle <= now) {
                later.pop_front();
            }
        }
        let places = self.asked - self.given + self.freed.len() as u64;
        let tags = self.written - self.acknowledged.next + self.reused.len() as u64;
        let reads = now >= CYCLES_TO_REQUEST && self.asked < self.lines && places < self.slots;
        let to_request = u64::from(dispatcher::CYCLES_TO_REQUEST);
        let is_ready = self.waiting.front().is_some_and(|cycle| cycle + to_request <= now);
        let writes = is_ready && tags < self.slots;
        let tag = |number: u64| (number % self.slots) as u16;
        let replies = self.link.cycle(&Requests {
            read: reads.then(|| ReadRequest { address: self.asked, tag: tag(self.asked) }),
            write: writes.then(|| WriteRequest { address: self.written, tag: tag(self.written), data: [0; 16] }),
        });
        self.asked += u64::from(reads && replies.read_ready);
        if writes && replies.write_ready {
            self.waiting.pop_front();
            self.written += 1;
        }
        if let Some(response) = replies.write {
            let come = self.acknowledged.come(response.tag, self.slots);
            self.reused.extend((0..come).map(|_| now + CYCLES_TO_REUSE));
        }
        if let Some(response) = replies.read {
            let come = self.read.come(response.tag, self.slots);
            self.announced.extend((0..come).map(|_| now + u64::from(collector::CYCLES_TO_LINE)));
        }
    }

    /// Whether the line of the next spheres is there.
    pub(super) fn has_line(&self, now: u64) -> bool {
        self.announced.front().is_some_and(|cycle| *cycle <= now)
    }

    /// The last spheres of a line were taken.
    pub(super) fn take(&mut self, now: u64) {
        self.announced.pop_front();
        self.given += 1;
        self.freed.push_back(now + CYCLES_TO_FREE);
    }

    /// Spheres of a line.
    pub(super) const PER_LINE: u64 = (LINE_BITS / SPHERE_BITS) as u64;

    /// So many records come to a line in that cycle.
    pub(super) fn put(&mut self, cycle: u64, records: u64) {
        self.records += records;
        while self.records >= self.per_line {
            self.records -= self.per_line;
            self.waiting.push_back(cycle);
        }
    }

    /// The last line leaves, even if it is not full.
    pub(super) fn flush(&mut self, cycle: u64) {
        if self.records > 0 {
            self.records = 0;
            self.waiting.push_back(cycle);
        }
    }

    /// Whether so few lines wait that what is on its way to them has room.
    pub(super) fn accepts(&self, now: u64) -> bool {
        self.waiting.iter().take(self.room / 2).filter(|cycle| **cycle <= now).count() < self.room / 2
    }

    /// Whether every line of spheres was taken, and every line of results was written.
    pub(super) fn is_done(&self) -> bool {
        self.given == self.lines && self.waiting.is_empty() && self.written == self.acknowledged.next
    }
}
