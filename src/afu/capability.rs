//! What an AFU says of itself in its capability word, read back.

use crate::config::Results;

/// Words of a pair, padded: six words are padded to eight, so that one radius for all spheres changes nothing.
const PAIR_WORDS: u32 = 8;
/// Bits of a line.
const LINE_BITS: u32 = 512;
/// Cycles that a pair spends outside its SCPU, from the line port and back: far above those of any configuration.
const AROUND_CYCLES: u64 = 128;

/// The parts of a capability word that a host plans with ([`Afu::capability`](super::Afu::capability) has all).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capability {
    /// Sphere Collision Processing Units.
    pub scpus: u32,
    /// Cycles from one pair to the next in an SCPU.
    pub interval: u32,
    /// Which pairs come back.
    pub results: Results,
    /// Pairs in a source line.
    pub pairs_per_line: u32,
    /// Cycles of a pair in an SCPU.
    pub scpu_cycles: u32,
}

impl Capability {
    /// Takes a capability word apart.
    pub fn from_bits(bits: u64) -> Self {
        let part = |low: u32, width: u32| (bits >> low) as u32 & ((1 << width) - 1);
        let results = if part(24, 1) == 1 { Results::Hits } else { Results::All };
        let word_bits = if part(26, 2) == 0 { 32 } else { 16 };
        Self {
            scpus: part(0, 8),
            interval: part(8, 8),
            results,
            pairs_per_line: LINE_BITS / (PAIR_WORDS * word_bits),
            scpu_cycles: part(32, 12),
        }
    }

    /// Cycles that the SCPUs take for so many pairs if none waits for memory. In an interval each SCPU takes one pair,
    /// and all together no more than one line per cycle. The first turn may come a whole interval late, and the last
    /// round may be of a single pair.
    pub fn computing_cycles(&self, pairs: u64) -> u64 {
        let interval = u64::from(self.interval.max(1));
        let each_interval = u64::from(self.scpus).clamp(1, u64::from(self.pairs_per_line) * interval);
        (pairs.div_ceil(each_interval) + 1) * interval
    }

    /// A bound on the cycles from a line of pairs in to their contacts out, for an AFU that waits for nothing.
    pub fn latency_cycles(&self) -> u64 {
        AROUND_CYCLES + u64::from(self.scpu_cycles) + u64::from(self.interval)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Afu, Spec};
    use super::*;
    use crate::config::{Config, RecordFormat};

    #[test]
    fn the_word_says_what_a_host_plans_with() {
        for (record, results, radius) in [
            (RecordFormat::F32, Results::All, None),
            (RecordFormat::F32, Results::All, Some(0.5)),
            (RecordFormat::Bf16, Results::Hits, Some(0.5)),
            (RecordFormat::F16, Results::All, None),
        ] {
            let profile = "e8f3z".parse().expect("a profile");
            let config = Config { scpus: 7, interval: 3, record, results, radius, profile, ..Config::default() };
            let afu = Afu::generate(Spec::from(config)).expect("an AFU");
            let said = Capability::from_bits(afu.capability());
            assert_eq!((said.scpus, said.interval, said.results), (7, 3, results));
            assert_eq!(said.pairs_per_line, afu.layout().pairs_per_line());
            let t = afu.timing();
            assert_eq!(said.scpu_cycles, afu.kernel().latency);
            let around = t.start + t.request + t.collect + t.feed + t.gather + t.pack + t.flush + t.dispatch + t.done;
            let around = around + t.acknowledge + t.scpu - said.scpu_cycles;
            assert!(2 * u64::from(around) < AROUND_CYCLES, "{around}: hits pass a sieve and a backlog besides");
        }
    }

    #[test]
    fn all_scpus_take_a_pair_an_interval_but_no_more_than_a_line_a_cycle() {
        let of = |scpus, interval, pairs_per_line| {
            let said = Capability { scpus, interval, results: Results::All, pairs_per_line, scpu_cycles: 0 };
            said.computing_cycles(1000)
        };
        assert_eq!(of(1, 31, 4), 31 * 1001);
        assert_eq!(of(10, 5, 2), 5 * 101);
        assert_eq!(of(19, 5, 2), 5 * 101);
        assert_eq!(of(64, 1, 4), 251);
        assert_eq!(of(0, 0, 2), 1001, "whatever a word says");
    }
}
