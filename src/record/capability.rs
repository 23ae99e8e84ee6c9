//! The capability word, in which an AFU describes itself; declared once.

use crate::config::{Config, Input, RecordFormat, Results, Search};
use crate::query::{Fields, GROUPS, Query};

use super::Layout;

/// A part of the word.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The lowest bit.
    pub low: u32,
    /// The number of bits.
    pub bits: u32,
    /// The meaning, for documentation.
    pub meaning: &'static str,
    /// True if every version has this part. The other parts are described only if they are not 0.
    always: bool,
}

const fn part(low: u32, bits: u32, meaning: &'static str, always: bool) -> Part {
    Part { low, bits, meaning, always }
}

const INTERVAL: Part = part(8, 8, "interval", true);
const FIELDS: Part = part(16, 4, "fields (hit, depth, normal, position from the lowest bit up)", true);
const HITS: Part = part(24, 1, "results (1: contacts alone)", false);
const ONE_RADIUS: Part = part(25, 1, "one radius for all spheres", false);
const RECORD: Part = part(26, 2, "words of records (0: f32, 1: f16, 2: bf16)", false);
const QUERY: Part = part(28, 4, "query", false);
const LATENCY: Part = part(32, 12, "SCPU latency (of profile and clock), in cycles", true);
const TABLE: Part = part(44, 5, "spheres come in: log2 of the spheres that the table holds", false);
const LANES: Part = part(49, 4, "log2 of the boxes compared in a cycle", false);
const DECIDERS: Part = part(53, 3, "log2 of the deciders", false);
const BOX_BITS: Part = part(56, 6, "bits of a box's numbers", false);

/// A bound on the cycles that a pair spends outside its SCPU, far above those of any configuration.
pub(crate) const AROUND_CYCLES: u64 = 128;

impl Part {
    /// The number of SCPUs.
    pub const SCPUS: Self = part(0, 8, "SCPUs", true);
    /// All parts, from the lowest bit up. The bits between them are zero.
    pub const ALL: [Self; 12] =
        [Self::SCPUS, INTERVAL, FIELDS, HITS, ONE_RADIUS, RECORD, QUERY, LATENCY, TABLE, LANES, DECIDERS, BOX_BITS];

    /// The value of this part in a word.
    pub const fn of(self, word: u64) -> u64 {
        word >> self.low & self.most()
    }

    /// The bits of this part in a word.
    pub const fn mask(self) -> u64 {
        self.most() << self.low
    }

    const fn most(self) -> u64 {
        (1 << self.bits) - 1
    }

    /// The word with this part only. A value that is too large is replaced by the largest possible.
    fn word(self, value: u32) -> u64 {
        u64::from(value).min(self.most()) << self.low
    }
}

/// What an AFU says about itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capability {
    /// Number of sphere collision processing units.
    pub scpus: u32,
    /// Initiation interval of an SCPU, in cycles.
    pub interval: u32,
    /// The fields of a contact that are computed.
    pub fields: Fields,
    /// The pairs for which the AFU returns a record.
    pub results: Results,
    /// True if all spheres have one radius, which is not in the records.
    pub one_radius: bool,
    /// The number format of the records.
    pub record: RecordFormat,
    /// The kind of pair; `None` if this version does not know it.
    pub query: Option<Query>,
    /// The latency of an SCPU, in cycles; with deciders, that of both.
    pub scpu_cycles: u32,
    /// The sizes of the search, if spheres come in.
    pub search: Option<Search>,
}

impl Capability {
    /// The capability of an AFU whose SCPUs have this latency in cycles.
    pub fn new(config: &Config, scpu_cycles: u32) -> Self {
        Self {
            // Behind deciders, one contact per cycle is computed.
            scpus: if config.decide > 0 { config.scpus.min(config.interval) } else { config.scpus },
            interval: config.interval,
            fields: config.contact,
            results: config.results,
            one_radius: config.radius.is_some(),
            record: config.record,
            query: Some(config.query),
            scpu_cycles,
            search: (config.input == Input::Spheres).then_some(config.search),
        }
    }

    /// Cycles after a reset after which a job begins when it is started: the delay lines in the AFU are full, and
    /// control knows it.
    pub fn cycles_after_reset(&self) -> u64 {
        u64::from(self.scpu_cycles) + u64::from(self.scpus) + 8
    }

    /// Encodes the capability as a word.
    pub fn bits(&self) -> u64 {
        let asked = GROUPS.iter().fold(0, |mask, group| mask << 1 | u32::from((group.is_asked)(self.fields)));
        let query = self.query.map_or(u32::MAX, |query| query.shape().code);
        Part::SCPUS.word(self.scpus)
            | INTERVAL.word(self.interval)
            | FIELDS.word(asked << 1 | 1)
            | HITS.word((self.results == Results::Hits).into())
            | ONE_RADIUS.word(self.one_radius.into())
            | RECORD.word(self.record as u32)
            | QUERY.word(query)
            | LATENCY.word(self.scpu_cycles)
            | self.search.map_or(0, |Search { table, box_bits, lanes, deciders }| {
                let log2 = |value: u32| value.checked_ilog2().unwrap_or(0);
                TABLE.word(log2(table))
                    | LANES.word(log2(lanes))
                    | DECIDERS.word(log2(deciders))
                    | BOX_BITS.word(box_bits)
            })
    }

    /// Decodes a word.
    pub fn from_bits(bits: u64) -> Self {
        let part = |part: Part| part.of(bits) as u32;
        let asked = |bit: u32| part(FIELDS) >> bit & 1 == 1;
        Self {
            scpus: part(Part::SCPUS),
            interval: part(INTERVAL),
            fields: Fields { depth: asked(1), normal: asked(2), position: asked(3) },
            results: if part(HITS) == 1 { Results::Hits } else { Results::All },
            one_radius: part(ONE_RADIUS) == 1,
            record: match part(RECORD) {
                1 => RecordFormat::F16,
                2 => RecordFormat::Bf16,
                _ => RecordFormat::F32,
            },
            query: Query::ALL.into_iter().find(|query| query.shape().code == part(QUERY)),
            scpu_cycles: part(LATENCY),
            search: (part(TABLE) > 0).then(|| Search {
                table: 1 << part(TABLE),
                lanes: 1 << part(LANES),
                deciders: 1 << part(DECIDERS),
                box_bits: part(BOX_BITS),
            }),
        }
    }

    /// Describes the parts of a word in prose, each with its bits. Optional parts are described only if they are set.
    pub fn describe(word: u64) -> String {
        let said = Self::from_bits(word);
        let query = said.query.map_or("unknown", |query| query.shape().name);
        let told = |part: &Part| {
            let place = match part.bits {
                1 => part.low.to_string(),
                bits => format!("{}:{}", part.low + bits - 1, part.low),
            };
            let value = part.of(word);
            match part.low {
                _ if part.always => Some(format!("{place} {}", part.meaning)),
                _ if value == 0 => None,
                low if low == HITS.low => Some(format!("{place} set: only contacts come back")),
                low if low == RECORD.low => Some(format!("{place} are {value}: words of records are {}", said.record)),
                low if [TABLE.low, LANES.low, DECIDERS.low, BOX_BITS.low].contains(&low) => {
                    Some(format!("{place} are {value}: {}", part.meaning))
                }
                low if low == QUERY.low => Some(format!("{place} are {value}: pairs are {query}")),
                _ => Some(format!("{place} set: {}", part.meaning)),
            }
        };
        Part::ALL.iter().filter_map(told).collect::<Vec<_>>().join(", ")
    }

    /// Pairs in a source line.
    pub fn pairs_per_line(&self) -> u32 {
        let config = Config {
            query: self.query.unwrap_or_default(),
            record: self.record,
            radius: self.one_radius.then_some(0.0),
            ..Config::default()
        };
        Layout::of(super::LINE_BITS, &config).pairs_per_line()
    }

    /// Cycles that the SCPUs take for `pairs` pairs if none waits for memory. In an interval each SCPU takes one pair,
    /// and all together take at most one line per cycle. The first turn may come a whole interval late, and the last
    /// round may hold a single pair.
    pub fn computing_cycles(&self, pairs: u64) -> u64 {
        let interval = u64::from(self.interval.max(1));
        let each_interval = u64::from(self.scpus).clamp(1, u64::from(self.pairs_per_line()) * interval);
        (pairs.div_ceil(each_interval) + 1) * interval
    }

    /// A bound on the cycles from a line of pairs in to their contacts out, if the AFU waits for nothing.
    pub fn latency_cycles(&self) -> u64 {
        AROUND_CYCLES + u64::from(self.scpu_cycles) + u64::from(self.scpus) + u64::from(self.interval)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_says_what_it_was_made_of() {
        let fields = "normal".parse().expect("fields");
        let base = Config { scpus: 7, interval: 3, contact: fields, ..Config::default() };
        for config in [
            base.clone(),
            Config { results: Results::Hits, ..base.clone() },
            Config { radius: Some(0.5), record: RecordFormat::Bf16, ..base.clone() },
            Config { input: Input::Spheres, results: Results::Hits, ..base.clone() },
            Config { query: Query::SpherePlane, record: RecordFormat::F16, ..base },
        ] {
            let said = Capability::new(&config, 99);
            assert_eq!(Capability::from_bits(said.bits()), said);
            let is_told = Capability::describe(said.bits()).contains("31:28 are 1: pairs are sphere-plane, 43:32");
            assert_eq!(is_told, said.query == Some(Query::SpherePlane));
            assert_eq!(said.pairs_per_line(), Layout::of(512, &config).pairs_per_line());
        }
        // The parts do not overlap, and the bits between them are zero.
        let all = Part::ALL.iter().fold(0_u64, |all, part| {
            assert_eq!(all & part.mask(), 0, "{part:?}");
            all | part.mask()
        });
        assert_eq!(all, 0x3FFF_FFFF_FF0F_FFFF);
        assert_eq!(Capability::from_bits(u64::MAX).query, None);
    }

    #[test]
    fn all_scpus_take_a_pair_an_interval_but_no_more_than_a_line_a_cycle() {
        let of = |scpus, interval, record| {
            Capability::new(&Config { scpus, interval, record, ..Config::default() }, 0).computing_cycles(1000)
        };
        assert_eq!(of(1, 31, RecordFormat::F16), 31 * 1001);
        assert_eq!(of(10, 5, RecordFormat::F32), 5 * 101);
        assert_eq!(of(19, 5, RecordFormat::F32), 5 * 101);
        assert_eq!(of(64, 1, RecordFormat::F16), 251);
        assert_eq!(of(0, 0, RecordFormat::F32), 1001, "whatever a word says");
    }
}
