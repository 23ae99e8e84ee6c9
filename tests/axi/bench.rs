//! AFUs to test, jobs for them, and the expected contents of memory.

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Shell};
use contact_afu::cosim::axi::Machine;
use contact_afu::cosim::{File, Instance, Model, Outcome, Source, Trace};
use contact_afu::host::{Done, Expected, HostError, Loaded, Session, Transaction, Workspace};
use contact_afu::link::axi::Handshake;
use contact_afu::link::{Line, LinkModel};
use contact_afu::pairs::Set;
use contact_afu::query::{ContactRecord, Flow, PairRecord};

/// The AFU of these tests: all fields, and an arithmetic whose model is built quickly.
pub fn config(scpus: u32, bus: u32) -> Config {
    Config { scpus, bus, shell: Shell::Axi, profile: "e8f3z".parse().unwrap(), ..Config::default() }
}

/// The Verilog of a configuration. The number of SCPUs is a parameter and not in the text.
pub fn files(config: &Config) -> Vec<File> {
    let afu = Afu::generate(Spec::from(Config { scpus: Config::default().scpus, ..config.clone() })).unwrap();
    afu.verilog().into_iter().map(|(name, text)| File { name, text }).collect()
}

pub fn model(config: &Config) -> Model {
    build(files(config), config.scpus)
}

pub fn build(files: Vec<File>, scpus: u32) -> Model {
    Model::build(&Source::new("contact_afu_axi", files).parameter("SCPUS", scpus.into()), Trace::Off).unwrap()
}

/// A machine with a preset link, whose host hesitates.
pub fn machine<'a>(afu: &'a Instance, link: &str, handshake: Handshake, seed: u64) -> Machine<'a> {
    let link: LinkModel = link.parse().unwrap();
    let mut machine = Machine::new(afu, link, handshake, seed).unwrap();
    machine.hesitates = true;
    machine
}

pub fn session<'a>(machine: Machine<'a>, config: &Config, workspace: Workspace) -> Session<Machine<'a>> {
    Session::new(machine, workspace, Expected::new(config).unwrap())
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

/// Pairs and the expected results.
pub struct Case {
    pub pairs: Vec<PairRecord>,
    lines: Vec<Line>,
    status: (u32, u32, Option<u32>),
}

impl Case {
    pub fn random(count: u64, seed: u64) -> Self {
        let pairs = Set::Random(count).pairs(seed);
        let records = config(1, 512).reference().run_all(&pairs);
        let words: Vec<u32> = records.iter().flat_map(|record| record.0).collect();
        let line = |words: &[u32]| std::array::from_fn(|word| words.get(word).copied().unwrap_or(0));
        let is_invalid = |record: &ContactRecord| record.flow() == Some(Flow::Invalid);
        Self {
            lines: words.chunks(16).map(line).collect(),
            status: (
                records.iter().filter(|record| record.is_contact()).count() as u32,
                records.iter().filter(|record| is_invalid(record)).count() as u32,
                records.iter().position(is_invalid).map(|number| number as u32),
            ),
            pairs,
        }
    }

    /// Lines of the source, and of the destination.
    pub fn lines(&self) -> u32 {
        self.lines.len() as u32
    }

    /// The source's lines.
    pub fn source(&self) -> Vec<Line> {
        let words: Vec<u32> = self.pairs.iter().flat_map(|pair| pair.0).collect();
        words.chunks(16).map(|line| std::array::from_fn(|word| line.get(word).copied().unwrap_or(0))).collect()
    }

    /// The destination's lines.
    pub fn wanted(&self) -> &[Line] {
        &self.lines
    }

    /// A workspace whose buffers begin at these lines of 4 KB, with exactly the room that the case needs.
    pub fn workspace(&self, source: u64, destination: u64) -> Workspace {
        let lines = (self.lines.len() as u64).max(1);
        let apart = lines.next_multiple_of(64) + 64;
        let layout = Expected::edited(&config(1, 512)).layout;
        let workspace = Workspace::contiguous(layout, 4 * apart + 1000).unwrap();
        workspace.with_buffers(source, apart + destination, lines as u32).unwrap()
    }

    /// True if every word and every figure is right.
    pub fn is_right(&self, outcome: &Outcome) -> bool {
        (outcome.error, outcome.failure) == (0, None)
            && outcome.lines.iter().map(Option::as_ref).eq(self.lines.iter().map(Some))
            && (outcome.contacts, outcome.invalid, outcome.first_invalid) == self.status
    }

    #[track_caller]
    pub fn check(&self, outcome: &Outcome, what: &str) {
        assert_eq!((outcome.error, outcome.failure), (0, None), "{what}");
        for (number, (got, wanted)) in outcome.lines.iter().zip(&self.lines).enumerate() {
            assert!(got.as_ref() == Some(wanted), "{what}: line {number}: {got:x?}, not {wanted:x?}");
        }
        assert!(self.is_right(outcome), "{what}: {:?}", self.status);
        assert!(outcome.cycles_busy < outcome.cycles, "{what}");
    }

    /// Checks every line that was written; returns their number.
    #[track_caller]
    pub fn check_written(&self, outcome: &Outcome, what: &str) -> usize {
        let written = outcome.lines.iter().zip(&self.lines).filter_map(|(got, wanted)| Some((got.as_ref()?, wanted)));
        written.inspect(|(got, wanted)| assert!(got == wanted, "{what}: {got:x?}, not {wanted:x?}")).count()
    }
}
