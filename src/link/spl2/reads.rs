//! SPL2's reads: a queue towards the link, and the reorder window behind it.

use std::collections::VecDeque;

use super::header::Header;
use crate::link::{Line, ReadRequest, ReadResponse};

/// Requests pending at which almost-full rises.
const PENDING: usize = 58;
/// Queued requests at which it rises.
const QUEUED: usize = 8;
/// Reads that can wait for their turn.
const WINDOW: usize = 64;

/// A read on its way.
#[derive(Clone, Copy, Debug)]
struct Read {
    id: u16,
    mdata: u16,
    data: Option<Line>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Reads {
    queue: VecDeque<Header>,
    /// In order of requests.
    window: VecDeque<Read>,
    /// Asked for before a reset: they come back when they come.
    stale: VecDeque<Read>,
    next_id: u16,
}

impl Reads {
    pub(super) fn almostfull(&self) -> bool {
        self.queue.len() >= QUEUED || self.queue.len() + self.window.len() >= PENDING
    }

    pub(super) fn push(&mut self, header: Header) {
        self.queue.push_back(header);
    }

    /// The request to be sent next.
    pub(super) fn head(&self) -> Option<&Header> {
        self.queue.front().filter(|_| self.window.len() < WINDOW)
    }

    /// The link's request for it.
    pub(super) fn request(&self, address: u64) -> ReadRequest {
        ReadRequest { address, tag: self.next_id }
    }

    /// The link has accepted it.
    pub(super) fn sent(&mut self) {
        if let Some(header) = self.queue.pop_front() {
            self.window.push_back(Read { id: self.next_id, mdata: header.mdata, data: None });
            self.next_id = self.next_id.wrapping_add(1);
        }
    }

    /// The link's answer; answers from before a system reset are dropped.
    pub(super) fn answered(&mut self, response: &ReadResponse) {
        let mut all = self.window.iter_mut().chain(&mut self.stale);
        if let Some(read) = all.find(|read| read.id == response.tag && read.data.is_none()) {
            read.data = Some(response.data);
        }
    }

    /// The next answer to the AFU: old answers first, then the next in turn, or any.
    pub(super) fn deliver(&mut self, in_order: bool) -> Option<(u16, Line)> {
        let stale = self.stale.iter().position(|read| read.data.is_some());
        let read = match stale {
            Some(index) => self.stale.remove(index),
            None if in_order => {
                self.window.front().is_some_and(|read| read.data.is_some()).then(|| self.window.pop_front())?
            }
            None => {
                let index = self.window.iter().rposition(|read| read.data.is_some())?;
                self.window.remove(index)
            }
        }?;
        Some((read.mdata, read.data?))
    }

    /// SPL is reset or disabled: what is queued is gone (its mdata are given), what is on its way comes back all the
    /// same.
    pub(super) fn reset(&mut self) -> Vec<u16> {
        self.stale.append(&mut self.window);
        self.queue.drain(..).map(|header| header.mdata).collect()
    }

    /// The whole system is reset.
    pub(super) fn forget(&mut self) {
        self.reset();
        self.stale.clear();
    }

    /// Reads of before the last reset that are still to come back.
    pub(super) fn stale(&self) -> usize {
        self.stale.len()
    }
}
