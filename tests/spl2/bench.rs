//! AFUs to test, jobs for them, and the expected contents of memory.

use contact_afu::afu::shell::spl2::map;
use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Shell};
use contact_afu::cosim::spl2::Machine;
use contact_afu::cosim::{File, Instance, Model, Outcome, Source, Trace};
use contact_afu::host::{Done, Expected, HostError, Loaded, Session, Transaction, Workspace};
use contact_afu::kernel::Reference;
use contact_afu::link::spl2::{Spl2, Spl2Model};
use contact_afu::link::{Line, Link, Stalls};
use contact_afu::pairs::Set;
use contact_afu::query::{ContactRecord, Flow, PairRecord};

/// The AFU of these tests: all fields, and an arithmetic whose model is built quickly.
pub fn config(scpus: u32) -> Config {
    Config { scpus, shell: Shell::Spl2, profile: "e8f3z".parse().unwrap(), ..Config::default() }
}

/// The Verilog of [`config`]. The number of SCPUs is a parameter and not in the text.
pub fn files() -> Vec<File> {
    let afu = Afu::generate(Spec::from(config(Config::default().scpus))).unwrap();
    afu.verilog().into_iter().map(|(name, text)| File { name, text }).collect()
}

/// Cycles from the start of the core to the request for the last write, without a link.
pub fn cycles_to_the_last_write(scpus: u32, pairs: usize) -> u32 {
    let afu = Afu::generate(Spec::from(config(scpus))).unwrap();
    let timing = afu.timing();
    let through = [timing.start, timing.request, timing.collect, timing.feed, timing.scpu, timing.chain, timing.pack];
    let lines = pairs.div_ceil(2) as u32;
    through.iter().sum::<u32>() + lines - 1 + timing.dispatch
}

pub fn model(scpus: u32) -> Model {
    build(files(), scpus)
}

pub fn build(files: Vec<File>, scpus: u32) -> Model {
    Model::build(&Source::new("afu_top", files).parameter("SCPUS", scpus.into()), Trace::Off).unwrap()
}

/// A machine with a preset link.
pub fn machine<'a>(afu: &'a Instance, spl: Spl2Model, link: &str, seed: u64) -> Machine<'a> {
    Machine::new(afu, Spl2::new(spl, Link::new(link.parse().unwrap(), seed).unwrap(), seed)).unwrap()
}

/// Decides where the pages of all workspaces are.
const PAGES_SEED: u64 = 7;

pub fn session(machine: Machine<'_>, scpus: u32, workspace: Workspace) -> Session<Machine<'_>> {
    Session::new(machine, workspace, Expected::new(&config(scpus)).unwrap())
}

/// A workspace with its buffers at these lines.
pub fn workspace(pages: u64, source: u64, destination: u64, lines: u32) -> Result<Workspace, HostError> {
    let layout = Expected::edited(&config(1)).layout;
    Workspace::new(layout, pages, PAGES_SEED)?.with_buffers(source, destination, lines)
}

/// Runs a loaded transaction to its end.
pub fn end<'s, 'a>(
    loaded: Transaction<'s, Machine<'a>, Loaded>,
) -> Result<Transaction<'s, Machine<'a>, Done>, HostError> {
    loaded.start()?.confirm()?.wait()
}

pub fn run(session: &mut Session<Machine<'_>>, case: &Case) -> Result<Outcome, HostError> {
    Ok(end(session.transaction().send(&case.pairs)?)?.outcome())
}

/// SPL2 at its worst: reads in any order, almost-full at random, acknowledgements in pairs, immediate CSR writes.
pub fn rough() -> Spl2Model {
    Spl2Model {
        csr_cycles: 3,
        reads_in_order: false,
        held: 0.4,
        fence_answers: true,
        almostfull: Stalls { chance: 0.1, longest: 9 },
        ..Spl2Model::default()
    }
}

/// Cheap CSR writes, because a test has many sessions.
pub fn quick() -> Spl2Model {
    Spl2Model { csr_cycles: 5, ..Spl2Model::default() }
}

/// Pairs and the expected results.
pub struct Case {
    pub pairs: Vec<PairRecord>,
    source: Vec<Line>,
    lines: Vec<Line>,
    status: (u32, u32, Option<u32>),
}

/// Packs records of eight words into lines, two records per line.
fn lines<'a>(records: impl Iterator<Item = &'a [u32; 8]>) -> Vec<Line> {
    let words: Vec<u32> = records.flatten().copied().collect();
    words.chunks(16).map(|line| std::array::from_fn(|word| line.get(word).copied().unwrap_or(0))).collect()
}

impl Case {
    pub fn new(pairs: Vec<PairRecord>) -> Self {
        let config = config(1);
        let records = Reference::new(config.profile.format(), config.contact).run_all(&pairs);
        let is_invalid = |record: &ContactRecord| record.flow() == Some(Flow::Invalid);
        Self {
            source: lines(pairs.iter().map(|pair| &pair.0)),
            lines: lines(records.iter().map(|record| &record.0)),
            status: (
                records.iter().filter(|record| record.is_contact()).count() as u32,
                records.iter().filter(|record| is_invalid(record)).count() as u32,
                records.iter().position(is_invalid).map(|number| number as u32),
            ),
            pairs,
        }
    }

    pub fn random(count: u64, seed: u64) -> Self {
        Self::new(Set::Random(count).pairs(seed))
    }

    /// The minimum number of lines of each buffer.
    pub fn room(&self) -> u32 {
        (1 + self.source.len()).max(self.lines.len()) as u32
    }

    /// A workspace with two halves behind the context, with exactly the room that the case needs.
    pub fn workspace(&self, pages: u64) -> Workspace {
        workspace(pages, 2, 2 + u64::from(self.room()), self.room()).unwrap()
    }

    pub fn source(&self) -> &[Line] {
        &self.source
    }

    pub fn wanted(&self) -> &[Line] {
        &self.lines
    }

    /// True if every word and every figure is right.
    pub fn is_right(&self, outcome: &Outcome) -> bool {
        outcome.error == 0
            && outcome.lines.iter().map(Option::as_ref).eq(self.lines.iter().map(Some))
            && (outcome.contacts, outcome.invalid, outcome.first_invalid) == self.status
    }

    #[track_caller]
    pub fn check(&self, outcome: &Outcome, what: &str) {
        self.check_after(outcome, outcome.cycles, what);
    }

    /// The same for a job that started `cycles` cycles ago. After its end the AFU has polled for the next job.
    #[track_caller]
    pub fn check_after(&self, outcome: &Outcome, cycles: u64, what: &str) {
        assert_eq!(outcome.error, 0, "{what}");
        for (number, (got, wanted)) in outcome.lines.iter().zip(&self.lines).enumerate() {
            assert!(got.as_ref() == Some(wanted), "{what}: line {number}: {got:x?}, not {wanted:x?}");
        }
        assert!(self.is_right(outcome), "{what}: {:?}", self.status);
        let lines = self.source.len() as u64;
        let own_reads = outcome.bytes_read / 64 - lines;
        let most = 2 + cycles / u64::from(map::IDLE_POLL_CYCLES);
        assert!((1..=most).contains(&own_reads), "{what}: {own_reads} polls in {cycles} cycles");
        assert!(outcome.cycles_busy < outcome.cycles, "{what}");
    }

    /// Checks every line that was written; returns their number.
    #[track_caller]
    pub fn check_written(&self, outcome: &Outcome, what: &str) -> usize {
        let written = outcome.lines.iter().zip(&self.lines).filter_map(|(got, wanted)| Some((got.as_ref()?, wanted)));
        written.inspect(|(got, wanted)| assert!(got == wanted, "{what}: {got:x?}, not {wanted:x?}")).count()
    }
}
