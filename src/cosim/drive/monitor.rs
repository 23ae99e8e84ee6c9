//! Checks the line port's protocol in every cycle.

use super::error::DriveError;
use crate::afu::EPOCH_BITS;
use crate::count::counted;
use crate::link::{Memory, Replies, Requests, Violation};

/// The error code of an AFU that gave up waiting for a lost response.
const WATCHDOG: u8 = 4;
/// The error code of an AFU that found more contacts than there is room for.
const OVERFLOW: u8 = 6;

/// A protocol violation of an AFU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProtocolError {
    /// A request changed before it was accepted.
    #[error("a {} request changed or was withdrawn before it was accepted", direction(*is_read))]
    Unstable {
        /// True for a read.
        is_read: bool,
    },
    /// A tag was used before the response of its last use.
    #[error("a {} used tag {tag:#05x} before the response to its last use", direction(*is_read))]
    TagReused {
        /// True for a read.
        is_read: bool,
        /// The tag.
        tag: u16,
    },
    /// A tag with the epoch of another job.
    #[error("a {} used tag {tag:#05x}, but the job's epoch is {epoch}", direction(*is_read))]
    WrongEpoch {
        /// True for a read.
        is_read: bool,
        /// The tag.
        tag: u16,
        /// The job's epoch.
        epoch: u8,
    },
    /// More requests outstanding than agreed.
    #[error("more than {agreed} outstanding {}s", direction(*is_read))]
    TooMany {
        /// True for reads.
        is_read: bool,
        /// The number of slots that a tag can name.
        agreed: u32,
    },
    /// A request without a job. (A request that a job gave up while it was on the port may stay there.)
    #[error("a {} request while no job runs", direction(*is_read))]
    Idle {
        /// True for a read.
        is_read: bool,
    },
    /// An access to a line that does not belong to the job.
    #[error(transparent)]
    Memory(#[from] Violation),
    /// Done while requests were outstanding.
    #[error("done is high with {} and {} outstanding", counted((*reads).into(), "read"), counted((*writes).into(), "write"))]
    DoneEarly {
        /// Reads without a response.
        reads: u32,
        /// Writes without a response.
        writes: u32,
    },
    /// Done and still busy.
    #[error("done and busy are high in the same cycle")]
    DoneAndBusy,
    /// Done without an error code before everything was written.
    #[error("done is high, but line {0:#x} of the destination was never written")]
    Unwritten(u64),
}

fn direction(is_read: bool) -> &'static str {
    if is_read { "read" } else { "write" }
}

/// One direction of the port.
#[derive(Debug)]
struct Half {
    is_read: bool,
    slot_bits: u32,
    /// For each outstanding tag, the cycle in which it was accepted and the number of resets before it.
    since: Vec<Option<(u64, u32)>>,
    /// Outstanding requests, without those that a reset forgot.
    outstanding: u32,
    /// Resets so far.
    resets: u32,
}

impl Half {
    fn new(is_read: bool, slot_bits: u32) -> Self {
        Self { is_read, slot_bits, since: vec![None; 1 << (EPOCH_BITS + slot_bits)], outstanding: 0, resets: 0 }
    }

    fn entry(&mut self, tag: u16) -> &mut Option<(u64, u32)> {
        let tags = self.since.len();
        &mut self.since[usize::from(tag) % tags]
    }

    fn accepted(&mut self, cycle: u64, tag: u16, epoch: u8) -> Result<(), ProtocolError> {
        let is_read = self.is_read;
        if u16::from(epoch) != tag >> self.slot_bits {
            return Err(ProtocolError::WrongEpoch { is_read, tag, epoch });
        }
        let (resets, agreed) = (self.resets, 1 << self.slot_bits);
        let since = self.entry(tag);
        if since.is_some() {
            return Err(ProtocolError::TagReused { is_read, tag });
        }
        *since = Some((cycle, resets));
        self.outstanding += 1;
        if self.outstanding > agreed {
            return Err(ProtocolError::TooMany { is_read, agreed });
        }
        Ok(())
    }

    fn answered(&mut self, tag: u16) {
        if let Some((_, resets)) = self.entry(tag).take() {
            self.outstanding -= u32::from(resets == self.resets);
        }
    }

    fn forget(&mut self) {
        self.outstanding = 0;
        self.resets += 1;
    }

    fn oldest(&self) -> Option<(bool, u16, u64)> {
        let waiting = (0..).zip(self.since.iter()).filter_map(|(tag, entry)| Some((tag, (*entry)?)));
        let of_now = waiting.filter(|(_, (_, resets))| *resets == self.resets);
        of_now.min_by_key(|(_, (cycle, _))| *cycle).map(|(tag, (cycle, _))| (self.is_read, tag, cycle))
    }
}

/// The state that the checks need.
#[derive(Debug)]
pub(super) struct Monitor {
    reads: Half,
    writes: Half,
    epoch: u8,
    /// Requests of the last cycle that were not accepted.
    pending: Requests,
    /// True if the last job gave up its outstanding requests.
    gave_up: bool,
    /// True for the read, and the write, on the port if a job gave it up.
    leftover: [bool; 2],
    violations: u64,
}

impl Monitor {
    /// A monitor of an AFU whose tags have `tag_bits` bits.
    pub(super) fn new(tag_bits: u32) -> Self {
        let slot_bits = tag_bits.saturating_sub(EPOCH_BITS);
        Self {
            reads: Half::new(true, slot_bits),
            writes: Half::new(false, slot_bits),
            epoch: 0,
            pending: Requests::default(),
            gave_up: false,
            leftover: [false; 2],
            violations: 0,
        }
    }

    /// The AFU was reset. It owes nothing, but the link's outstanding responses still arrive.
    pub(super) fn forget(&mut self) {
        self.reads.forget();
        self.writes.forget();
        self.pending = Requests::default();
        self.leftover = [false; 2];
    }

    /// A job of this epoch begins, and memory counts violations from zero.
    pub(super) fn begin(&mut self, epoch: u8) {
        // Outstanding requests of a job that gave up no longer count, nor does its request on the port.
        self.reads.forget();
        self.writes.forget();
        self.epoch = epoch;
        self.violations = 0;
    }

    /// Takes note of the link's responses.
    pub(super) fn answered(&mut self, replies: &Replies) {
        if let Some(read) = &replies.read {
            self.reads.answered(read.tag);
        }
        if let Some(write) = &replies.write {
            self.writes.answered(write.tag);
        }
    }

    /// Checks one cycle.
    pub(super) fn check(
        &mut self,
        cycle: u64,
        requests: &Requests,
        replies: &Replies,
        busy: bool,
        memory: &Memory,
    ) -> Result<(), DriveError> {
        self.check_requests(cycle, requests, replies, busy, memory).map_err(|what| DriveError::Protocol { cycle, what })
    }

    fn check_requests(
        &mut self,
        cycle: u64,
        requests: &Requests,
        replies: &Replies,
        busy: bool,
        memory: &Memory,
    ) -> Result<(), ProtocolError> {
        // A tag is free from the cycle after its response.
        let is_kept = [
            self.pending.read.is_some() && self.pending.read == requests.read,
            self.pending.write.is_some() && self.pending.write == requests.write,
        ];
        let [reads, writes] = &mut self.leftover;
        for (leftover, is_kept) in [(reads, is_kept[0]), (writes, is_kept[1])] {
            *leftover = is_kept && (*leftover || !busy && self.gave_up);
        }
        let [left_read, left_write] = self.leftover;
        let tags = [
            (requests.read.as_ref().map(|read| read.tag), left_read, replies.read_ready, &mut self.reads),
            (requests.write.as_ref().map(|write| write.tag), left_write, replies.write_ready, &mut self.writes),
        ];
        for (tag, leftover, is_ready, half) in tags {
            let Some(tag) = tag.filter(|_| !leftover) else { continue };
            if !busy {
                return Err(ProtocolError::Idle { is_read: half.is_read });
            }
            if is_ready {
                half.accepted(cycle, tag, self.epoch)?;
            }
        }
        self.check_stable(requests, replies)?;
        self.answered(replies);
        // A request that was given up counts for the job that made it.
        let is_late = left_read && replies.read_ready || left_write && replies.write_ready;
        if memory.violation_count() > self.violations {
            self.violations = memory.violation_count();
            if let Some(&violation) = memory.violations().last().filter(|_| !is_late) {
                return Err(violation.into());
            }
        }
        Ok(())
    }

    /// A request stays as it is until it is accepted.
    fn check_stable(&mut self, requests: &Requests, replies: &Replies) -> Result<(), ProtocolError> {
        if self.pending.read.is_some() && self.pending.read != requests.read {
            return Err(ProtocolError::Unstable { is_read: true });
        }
        if self.pending.write.is_some() && self.pending.write != requests.write {
            return Err(ProtocolError::Unstable { is_read: false });
        }
        self.pending.read = requests.read.filter(|_| !replies.read_ready);
        // Comparing a line takes time, and in most cycles there is no write.
        if requests.write.is_some() && !replies.write_ready {
            self.pending.write = requests.write;
        } else if self.pending.write.is_some() {
            self.pending.write = None;
        }
        Ok(())
    }

    /// Checks the end of a job that had to write its destination up to the line address `end`.
    pub(super) fn at_done(
        &mut self,
        cycle: u64,
        error: u8,
        busy: bool,
        memory: &Memory,
        end: u64,
    ) -> Result<(), DriveError> {
        let fail = |what| Err(DriveError::Protocol { cycle, what });
        if busy {
            return fail(ProtocolError::DoneAndBusy);
        }
        self.gave_up = error == WATCHDOG;
        let (reads, writes) = (self.reads.outstanding, self.writes.outstanding);
        if error != WATCHDOG && (reads, writes) != (0, 0) {
            return fail(ProtocolError::DoneEarly { reads, writes });
        }
        match memory.first_unwritten() {
            Some(address) if matches!(error, 0 | OVERFLOW) && address < end => fail(ProtocolError::Unwritten(address)),
            _ => Ok(()),
        }
    }

    /// The oldest outstanding request: true for a read, its tag, and the cycle in which it was accepted.
    pub(super) fn oldest(&self) -> Option<(bool, u16, u64)> {
        self.reads.oldest().into_iter().chain(self.writes.oldest()).min_by_key(|(_, _, cycle)| *cycle)
    }
}
