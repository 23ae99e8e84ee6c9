//! Limits of a direction: a token bucket for bandwidth, and stalls.

use rand::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::direction::Stalls;

/// True with probability `share`.
pub(super) fn chance(random: &mut Xoshiro256PlusPlus, share: f64) -> bool {
    // 53 random bits make every multiple of 2^-53 in [0, 1) equally likely.
    share > 0.0 && ((random.next_u64() >> 11) as f64) < share * (1u64 << 53) as f64
}

/// A random number from 0 to `most`, evenly distributed (to within 2^-32).
pub(super) fn up_to(random: &mut Xoshiro256PlusPlus, most: u32) -> u32 {
    if most == 0 { 0 } else { (((random.next_u64() >> 32) * (u64::from(most) + 1)) >> 32) as u32 }
}

/// Limits the average lines per cycle: a bucket into which a share of a line drips in each cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bucket {
    lines_per_cycle: f64,
    full: f64,
    level: f64,
}

impl Bucket {
    /// A bucket that holds only what `lines_per_cycle` needs to lose nothing, so that bursts are not saved up.
    pub(super) fn new(lines_per_cycle: f64) -> Self {
        let full = 1.0 + lines_per_cycle;
        Self { lines_per_cycle, full, level: 0.0 }
    }

    /// A full bucket.
    pub(super) fn full(lines_per_cycle: f64) -> Self {
        let empty = Self::new(lines_per_cycle);
        Self { level: empty.full, ..empty }
    }

    pub(super) fn drip(&mut self) {
        self.level = (self.level + self.lines_per_cycle).min(self.full);
    }

    pub(super) fn has_line(&self) -> bool {
        self.level >= 1.0
    }

    pub(super) fn take(&mut self) {
        self.level -= 1.0;
    }
}

/// Decides in each cycle whether a direction accepts requests.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gate {
    stalls: Stalls,
    left: u32,
}

impl Gate {
    pub(super) fn new(stalls: Stalls) -> Self {
        Self { stalls, left: 0 }
    }

    pub(super) fn is_open(&mut self, random: &mut Xoshiro256PlusPlus) -> bool {
        if self.left > 0 {
            self.left -= 1;
            return false;
        }
        if self.stalls.longest > 0 && chance(random, self.stalls.chance) {
            self.left = up_to(random, self.stalls.longest - 1);
            return false;
        }
        true
    }
}
