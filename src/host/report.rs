//! The cycles of a transaction.

/// The cost of one transaction, in cycles of the AFU's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Pairs.
    pub pairs: u64,
    /// From the first CSR write to SPL enabled: reset, DSM, AFU_ID, contexts.
    pub set_up: u64,
    /// The AFU at work, as it counts itself.
    pub run: u64,
    /// From the start word to the status, without `run`: the control memory found, counters, fence, status.
    pub handshake: u64,
    /// SPL disabled and reset.
    pub tear_down: u64,
    /// Bytes read over the link from the start word to the status.
    pub bytes_read: u64,
    /// Bytes written.
    pub bytes_written: u64,
    /// Cycles that those bytes take at least over the link.
    pub link_limit: f64,
    /// Set-up time from the link's description; it stands for all software before a transaction.
    pub stated_set_up: u64,
    /// Tear-down that it states.
    pub stated_tear_down: u64,
}

impl Report {
    /// Cycles from the start word to the status.
    pub fn job(&self) -> u64 {
        self.run + self.handshake
    }

    /// Nanoseconds at a clock of `mhz` with set-up and tear-down as the link's description states them.
    pub fn stated_ns(&self, mhz: f64) -> f64 {
        (self.stated_set_up + self.job() + self.stated_tear_down) as f64 * 1000.0 / mhz
    }

    /// The share of the link's speed that the job reached.
    pub fn efficiency(&self) -> f64 {
        if self.job() == 0 { 0.0 } else { self.link_limit / self.job() as f64 }
    }
}
