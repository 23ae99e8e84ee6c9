//! The cycles of a transaction.

/// The cost of one transaction, in cycles of the AFU's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The number of pairs.
    pub pairs: u64,
    /// The number of spheres, of both sets.
    pub spheres: u64,
    /// From the first CSR write to SPL enabled: reset, DSM, AFU_ID, contexts.
    pub set_up: u64,
    /// The AFU's own count of its busy cycles.
    pub run: u64,
    /// From the start word to the status, without `run`: finding the control memory, counters, fence, status.
    pub handshake: u64,
    /// SPL disabled and reset.
    pub tear_down: u64,
    /// Bytes read over the link from the start word to the status.
    pub bytes_read: u64,
    /// Bytes written over the link in the same time.
    pub bytes_written: u64,
    /// The minimum number of cycles for these bytes over the link.
    pub link_limit: f64,
    /// Set-up time that the link's description states. It stands for all software before a transaction.
    pub stated_set_up: u64,
    /// Tear-down time that the link's description states.
    pub stated_tear_down: u64,
}

impl Report {
    /// Cycles from the start word to the status.
    pub fn job(&self) -> u64 {
        self.run + self.handshake
    }

    /// Nanoseconds at a clock of `mhz`, including the set-up and tear-down that the link's description states.
    pub fn stated_ns(&self, mhz: f64) -> f64 {
        (self.stated_set_up + self.job() + self.stated_tear_down) as f64 * 1000.0 / mhz
    }

    /// The share of the link limit that the job reached.
    pub fn efficiency(&self) -> f64 {
        if self.job() == 0 { 0.0 } else { self.link_limit / self.job() as f64 }
    }
}
