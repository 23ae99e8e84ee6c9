//! The cycles in which lines leave that are limited by bandwidth only, without latency.

use super::direction::Direction;
use super::model::LinkModel;
use super::regulator::Bucket;

impl LinkModel {
    /// The cycles in which data of reads arrives. `ready` are the cycles (rising) in which it would arrive with
    /// unlimited bandwidth. The link was idle before, and nothing is written meanwhile.
    pub fn pace_of_reads(&self, ready: &[u64]) -> Vec<u64> {
        self.pace(&self.read, ready)
    }

    /// The cycles in which writes are accepted. `ready` are the cycles (rising) in which they are requested. The link
    /// was idle before, and nothing is read meanwhile.
    pub fn pace_of_writes(&self, ready: &[u64]) -> Vec<u64> {
        self.pace(&self.write, ready)
    }

    fn pace(&self, direction: &Direction, ready: &[u64]) -> Vec<u64> {
        let mut buckets = [Bucket::full(direction.lines_per_cycle), Bucket::full(self.lines_per_cycle)];
        let mut next = 0;
        let mut pace = Vec::with_capacity(ready.len());
        for &ready in ready {
            loop {
                let goes = next >= ready && buckets.iter().all(Bucket::has_line);
                if goes {
                    pace.push(next);
                    buckets.iter_mut().for_each(Bucket::take);
                }
                next += 1;
                buckets.iter_mut().for_each(Bucket::drip);
                if goes {
                    break;
                }
            }
        }
        pace
    }
}
