//! AFUs to test, jobs for them, and the expected contents of memory. The expected lines are laid out here
//! independently, not by the `Layout` that the generator and the host share, so that a mistake in it is found.

use std::path::Path;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Results, Shell};
use contact_afu::cosim::{Driver, File, Instance, Job, Model, Outcome, Source, Trace};
use contact_afu::kernel::Reference;
use contact_afu::link::{Line, Link};
use contact_afu::pairs::Set;
use contact_afu::query::{ContactRecord, Fields, Flow, PairRecord};

/// A model of the core in the committed `rtl/`, for any number of SCPUs: nothing is generated.
pub fn committed(scpus: u32) -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("rtl");
    let source = Source::from_folder(&folder, "contact_afu").unwrap().parameter("SCPUS", scpus.into());
    Model::build(&source, Trace::Off).unwrap()
}

/// The same with SCPUs that each take one pair per cycle.
pub fn full_rate(scpus: u32) -> Model {
    generated(&of(scpus))
}

/// The default configuration with `scpus` SCPUs and the AFU's own port as its top, which the driver of these tests
/// uses.
pub fn of(scpus: u32) -> Config {
    Config { scpus, shell: Shell::Line, ..Config::default() }
}

/// Like [`of`], with this profile and these fields of a contact.
pub fn config(scpus: u32, profile: &str, contact: &str) -> Config {
    Config { profile: profile.parse().unwrap(), contact: contact.parse().unwrap(), ..of(scpus) }
}

/// The Verilog of a configuration as generated now. The number of SCPUs is a parameter and not in the text, so models
/// share what they have in common.
pub fn source(config: &Config) -> Source {
    let scpus = if config.has_deciders() { config.scpus } else { Config::default().scpus };
    let afu = Afu::generate(Spec::from(Config { scpus, ..config.clone() })).unwrap();
    let files = afu.verilog().into_iter().map(|(name, text)| File { name, text }).collect();
    with_scpus(Source::new("contact_afu", files), config)
}

/// With the number of SCPUs as a parameter, unless there are deciders, behind which it is fixed.
pub fn with_scpus(source: Source, config: &Config) -> Source {
    if config.has_deciders() { source } else { source.parameter("SCPUS", config.scpus.into()) }
}

/// A model of the Verilog as generated now.
pub fn generated(config: &Config) -> Model {
    Model::build(&source(config), Trace::Off).unwrap()
}

pub fn link(name: &str, seed: u64) -> Link {
    Link::new(name.parse().unwrap(), seed).unwrap()
}

/// A driver of `afu` over a preset link.
pub fn driver<'a>(afu: &'a Instance, name: &str, seed: u64) -> Driver<'a> {
    Driver::new(afu, link(name, seed)).unwrap()
}

/// Pairs for an AFU, and the expected results.
pub struct Case {
    pub pairs: Vec<PairRecord>,
    source: Vec<Line>,
    /// The expected destination lines.
    pub lines: Vec<Line>,
    /// If only contacts come back: the number of lines they fill, and contacts per line.
    hits: Option<(u64, u32)>,
    status: Status,
}

/// Numbers of contacts and invalid pairs, and the first invalid pair.
type Status = (u32, u32, Option<u32>);

fn status(outcome: &Outcome) -> Status {
    (outcome.contacts, outcome.invalid, outcome.first_invalid)
}

impl Case {
    /// These pairs; where all spheres have one radius, with it, which memory does not hold.
    pub fn new(config: &Config, mut pairs: Vec<PairRecord>) -> Self {
        let mut words: Vec<u32> = pairs.iter().flat_map(|pair| pair.0).collect();
        if let Some(radius) = config.radius {
            for (PairRecord(pair), words) in pairs.iter_mut().zip(words.chunks_mut(8)) {
                let [x1, y1, z1, _, x2, y2, z2, _] = *pair;
                *pair = [x1, y1, z1, radius.to_bits(), x2, y2, z2, radius.to_bits()];
                words.copy_from_slice(&[x1, y1, z1, x2, y2, z2, 0, 0]);
            }
        }
        let records = Reference::new(config.profile.format(), config.contact).run_all(&pairs);
        let count = |test: fn(&ContactRecord) -> bool| records.iter().filter(|record| test(record)).count() as u32;
        let is_invalid: fn(&ContactRecord) -> bool = |record| record.flow() == Some(Flow::Invalid);
        let size = hit_words(config.contact, 0, &ContactRecord::default()).len();
        let (lines_of, hits) = match config.results {
            Results::All => (destination(config.contact, &records), None),
            Results::Hits => {
                let hits = (0..).zip(&records).filter(|(_, record)| record.is_contact());
                let words: Vec<u32> = hits.flat_map(|(pair, hit)| hit_words(config.contact, pair, hit)).collect();
                (lines(&words), Some(((pairs.len() * size).div_ceil(16) as u64, 16 / size as u32)))
            }
        };
        Self {
            source: lines(&words),
            lines: lines_of,
            hits,
            status: (
                count(|record| record.is_contact()),
                count(is_invalid),
                records.iter().position(is_invalid).map(|number| number as u32),
            ),
            pairs,
        }
    }

    /// Random pairs of all flows; the first `count` of them.
    pub fn random(config: &Config, count: u64, seed: u64) -> Self {
        Self::new(config, Set::Random(count).pairs(seed))
    }

    pub fn job(&self) -> Job<'_> {
        let room = self.hits.map_or(self.lines.len() as u64, |(room, _)| room);
        let hits_per_line = self.hits.map(|(_, per_line)| per_line);
        Job { hits_per_line, ..Job::new(&self.source, self.pairs.len() as u32, room) }
    }

    /// The same job with room for only `lines` lines.
    pub fn job_with_room(&self, lines: u64) -> Job<'_> {
        Job { destination_lines: lines, ..self.job() }
    }

    /// Checks every word and every figure of a successful job.
    #[track_caller]
    pub fn check(&self, outcome: &Outcome, what: &str) {
        assert_eq!(outcome.job_error(), None, "{what}");
        self.check_written(outcome, what);
        assert!(outcome.lines.iter().take(self.lines.len()).all(Option::is_some), "{what}: a line is missing");
        assert_eq!(status(outcome), self.status, "{what}: contacts, invalid, first invalid");
        assert_eq!((outcome.bytes_read, outcome.bytes_written), self.traffic(), "{what}: each line once");
        assert_eq!(outcome.cycles_busy + 1, outcome.cycles, "{what}: busy from the cycle after the start on");
        assert!(outcome.cycles_input + outcome.cycles_output <= outcome.cycles_busy, "{what}: waiting for one thing");
    }

    /// Bytes that a job reads and writes.
    pub fn traffic(&self) -> (u64, u64) {
        let bytes = |lines: &[Line]| 64 * lines.len() as u64;
        (bytes(&self.source), bytes(&self.lines))
    }

    /// Checks every line that was written; returns their number.
    #[track_caller]
    pub fn check_written(&self, outcome: &Outcome, what: &str) -> usize {
        if self.hits.is_none() {
            assert_eq!(outcome.lines.len(), self.lines.len());
        }
        assert!(outcome.lines.iter().skip(self.lines.len()).all(Option::is_none), "{what}: a line too many");
        let mut written = 0;
        for (number, (got, wanted)) in outcome.lines.iter().zip(&self.lines).enumerate() {
            let Some(got) = got else { continue };
            assert!(got == wanted, "{what}: line {number} of {}: {got:x?}, not {wanted:x?}", self.lines.len());
            written += 1;
        }
        written
    }

    /// True if all figures except the lines are right.
    pub fn status_is_right(&self, outcome: &Outcome) -> bool {
        status(outcome) == self.status
    }

    /// Indices of wrong destination lines.
    pub fn wrong_lines(&self, outcome: &Outcome) -> Vec<usize> {
        (0..self.lines.len()).filter(|&line| outcome.lines[line] != Some(self.lines[line])).collect()
    }
}

/// A contact's record if only contacts come back: its pair's number, then the selected words, padded to a power of two.
fn hit_words(fields: Fields, pair: u32, record: &ContactRecord) -> Vec<u32> {
    let mut words = vec![pair];
    let any = fields != Fields::HIT;
    for (asked, part) in [(fields.position, 0..3), (fields.normal, 3..6), (fields.depth, 6..7), (any, 7..8)] {
        if asked {
            words.extend_from_slice(&record.0[part]);
        }
    }
    words.resize(words.len().next_power_of_two(), 0);
    words
}

/// Packs words into lines; the unused part of the last line is zero.
fn lines(words: &[u32]) -> Vec<Line> {
    let line = |words: &[u32]| std::array::from_fn(|word| words.get(word).copied().unwrap_or(0));
    words.chunks(16).map(line).collect()
}

/// Contacts as the design lays them out: the selected words of position, normal, depth and flags, padded to 1, 2, 4 or
/// 8 words. If only the hit is selected, a contact is one bit.
fn destination(fields: Fields, records: &[ContactRecord]) -> Vec<Line> {
    if fields == Fields::HIT {
        let word = |records: &[ContactRecord]| {
            records.iter().zip(0..).fold(0, |word, (record, bit)| word | u32::from(record.is_contact()) << bit)
        };
        return lines(&records.chunks(32).map(word).collect::<Vec<_>>());
    }
    let record = |record: &ContactRecord| {
        let mut words = Vec::new();
        for (asked, part) in [(fields.position, 0..3), (fields.normal, 3..6), (fields.depth, 6..7), (true, 7..8)] {
            if asked {
                words.extend_from_slice(&record.0[part]);
            }
        }
        words.resize(words.len().next_power_of_two(), 0);
        words
    };
    lines(&records.iter().flat_map(record).collect::<Vec<_>>())
}
