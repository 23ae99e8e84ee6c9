//! SPL2's writes: the queue to the link, fences in it, and acknowledgements on two channels.

use std::collections::VecDeque;

use rand_xoshiro::Xoshiro256PlusPlus;

use super::header::Header;
use crate::link::regulator::{chance, up_to};
use crate::link::{Line, WriteRequest, WriteResponse};

/// Requests pending at which almost-full rises.
const PENDING: usize = 54;
/// Queued requests at which it rises.
const QUEUED: usize = 8;

/// Acknowledgements that may be held back.
const FEW: usize = 3;

/// A write in flight, with its physical line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Write {
    id: u16,
    pub(super) header: Header,
    pub(super) address: u64,
    pub(super) data: Line,
    stale: bool,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Writes {
    queue: VecDeque<(Header, Line)>,
    sent: Vec<Write>,
    acknowledged: VecDeque<u16>,
    next_id: u16,
}

impl Writes {
    pub(super) fn almostfull(&self) -> bool {
        self.queue.len() >= QUEUED || self.queue.len() + self.current() >= PENDING
    }

    fn current(&self) -> usize {
        self.sent.iter().filter(|write| !write.stale).count()
    }

    pub(super) fn push(&mut self, header: Header, data: Line) {
        self.queue.push_back((header, data));
    }

    /// Removes a fence from the head of the queue once every write before it is done, and returns its mdata.
    pub(super) fn pass_fence(&mut self) -> Option<u16> {
        let (header, _) = self.queue.front()?;
        let passes = header.kind == Header::WRITE_FENCE && self.current() == 0;
        passes.then(|| self.queue.pop_front().map(|(header, _)| header.mdata))?
    }

    /// The request to send next, unless a fence holds it back.
    pub(super) fn head(&self) -> Option<&Header> {
        self.queue.front().map(|(header, _)| header).filter(|header| header.kind != Header::WRITE_FENCE)
    }

    /// The request on the link for this write.
    pub(super) fn request(&self, address: u64) -> Option<WriteRequest> {
        let (_, data) = self.queue.front()?;
        Some(WriteRequest { address, tag: self.next_id, data: *data })
    }

    /// Marks the head as accepted by the link.
    pub(super) fn sent(&mut self, address: u64) {
        if let Some((header, data)) = self.queue.pop_front() {
            self.sent.push(Write { id: self.next_id, header, address, data, stale: false });
            self.next_id = self.next_id.wrapping_add(1);
        }
    }

    /// The link answered: the write is in memory now.
    pub(super) fn answered(&mut self, response: &WriteResponse) -> Option<Write> {
        let index = self.sent.iter().position(|write| write.id == response.tag)?;
        let write = self.sent.swap_remove(index);
        self.acknowledged.push_back(write.header.mdata);
        Some(write)
    }

    /// Acknowledges a fence.
    pub(super) fn acknowledge(&mut self, mdata: u16) {
        self.acknowledged.push_back(mdata);
    }

    /// Acknowledgements for channel 0, if it is free, and channel 1.
    pub(super) fn deliver(
        &mut self,
        channel0_is_free: bool,
        held: f64,
        random: &mut Xoshiro256PlusPlus,
    ) -> (Option<u16>, Option<u16>) {
        let few = self.acknowledged.len() < FEW; // no more are held back, so that no bandwidth is lost
        if self.acknowledged.is_empty() || (few && chance(random, held)) {
            return (None, None);
        }
        let (both, first) = (up_to(random, 1) == 1, up_to(random, 1) == 1);
        let both = both && self.acknowledged.len() > 1 && channel0_is_free;
        let on0 = if both || (channel0_is_free && first) { self.acknowledged.pop_front() } else { None };
        let on1 = if both || on0.is_none() { self.acknowledged.pop_front() } else { None };
        (on0, on1)
    }

    /// SPL is reset or disabled. Queued writes are dropped, and their mdata returned. Writes in flight are still done
    /// and acknowledged.
    pub(super) fn reset(&mut self) -> Vec<u16> {
        self.sent.iter_mut().for_each(|write| write.stale = true);
        self.queue.drain(..).map(|(header, _)| header.mdata).collect()
    }

    /// System reset: writes in flight are completed, without responses.
    pub(super) fn forget(&mut self) {
        self.queue.clear();
        self.sent.clear();
        self.acknowledged.clear();
    }

    /// The number of writes from before the last reset that are not acknowledged yet.
    pub(super) fn stale(&self) -> usize {
        self.sent.len() - self.current()
    }
}
