//! Jobs one after another without a reset: how soon the next one starts, and what a context that is written again does.

use contact_afu::afu::shell::spl2::map::{self, control, pointers, status};
use contact_afu::cosim::spl2::{Machine, Place, Session};
use contact_afu::link::spl2::PAGE_BYTES;

use crate::bench::{Case, machine, model, quick};

const SCPUS: u32 = 3;
/// Cycles of CSR write, read and answer that a poll takes on top of its pause, over an ideal link.
const POLL_CYCLES: u64 = 40;

#[test]
fn the_next_job_starts_when_the_last_one_has_ended() {
    let case = Case::random(20, 41);
    let afu = model(SCPUS).instance(1).unwrap();
    let mut machine = machine(&afu, quick(), "ideal", 1);
    let mut session = Session::open(&mut machine, case.place(), Some(SCPUS)).unwrap();
    session.machine().advance(200).unwrap();
    let mut cycles = Vec::new();
    for pause in [0, 0, 0, 1, 7, 31, 32, 33, 600, 0] {
        session.machine().advance(pause).unwrap();
        let outcome = session.run(&case.job()).unwrap();
        case.check(&outcome, "a job after another");
        cycles.push(outcome.cycles);
    }
    let most = cycles[0] + u64::from(map::IDLE_POLL_CYCLES) + POLL_CYCLES;
    assert!(cycles.iter().all(|cycles| *cycles <= most), "{cycles:?}: more than {most}");
}

/// A context of the test's own: its line in the workspace, and where its buffers are.
struct Context {
    line: u64,
    source: u64,
    destination: u64,
}

const PAGE_LINES: u64 = PAGE_BYTES / 64;
/// The workspace's virtual line address, as `Session` lays it out.
const WORKSPACE_LINE: u64 = 0x0000_7F12_3460_0000 / 64;

impl Context {
    fn write(&self, session: &mut Session<'_, '_>, case: &Case) {
        let address = |line: u64| u128::from((WORKSPACE_LINE + line) * 64);
        let mut line = [0; 16];
        pointers::SOURCE.set(&mut line, address(self.source));
        pointers::DESTINATION.set(&mut line, address(self.destination));
        pointers::LINES.set(&mut line, case.place().lines.into());
        put(session, self.line, line);
        put(session, self.line + 1, [0; 16]);
        put(session, self.source, [0; 16]);
        for (number, line) in (1..).zip(case.job().source) {
            put(session, self.source + number, *line);
        }
    }

    fn announce(&self, session: &mut Session<'_, '_>) {
        let address = (WORKSPACE_LINE + self.line) * 64;
        let machine = session.machine();
        machine.write_csr(map::CONTEXT_BASE_HIGH.offset, (address >> 32) as u32).unwrap();
        machine.write_csr(map::CONTEXT_BASE_LOW.offset, address as u32).unwrap();
    }

    fn start(&self, session: &mut Session<'_, '_>, case: &Case, sequence: u32) {
        let mut line = [0; 16];
        control::COUNT.set(&mut line, case.pairs.len() as u128);
        control::SEQUENCE.set(&mut line, sequence.into());
        control::START.set(&mut line, map::START_WORD.into());
        put(session, self.source, line);
    }

    /// Whether the status is that of a whole job, with every result where this context wants it.
    fn is_done(&self, session: &mut Session<'_, '_>, case: &Case, sequence: u32) -> bool {
        let line = get(session, self.line + 1);
        if status::DONE.get(&line) == 0 || status::SEQUENCE.get(&line) != sequence.into() {
            return false;
        }
        assert_eq!(status::ERROR.get(&line), 0);
        let lines = case.wanted().len() as u64;
        let got: Vec<_> = (0..lines).map(|number| get(session, self.destination + number)).collect();
        assert_eq!(got, case.wanted());
        true
    }
}

fn put(session: &mut Session<'_, '_>, line: u64, data: [u32; 16]) {
    let at = session.physical(line);
    session.machine().memory_mut().set(at, &data);
}

fn get(session: &mut Session<'_, '_>, line: u64) -> [u32; 16] {
    let at = session.physical(line);
    session.machine().memory().get(at).copied().unwrap_or_default()
}

/// The job after it is wholly of the new context; one that runs stays wholly of the old.
#[test]
fn a_context_written_again_counts_from_the_next_job_on() {
    let (old, new) = (Case::random(60, 42), Case::random(33, 43));
    let model = model(SCPUS);
    let second = Context { line: PAGE_LINES, source: PAGE_LINES + 2, destination: 2 * PAGE_LINES };
    for moment in (0..120).step_by(3) {
        let afu = model.instance(moment).unwrap();
        let mut machine: Machine<'_> = machine(&afu, quick(), "late", moment);
        let mut session = Session::open(&mut machine, Place { pages: 3, ..old.place() }, Some(SCPUS)).unwrap();
        old.check(&session.run(&old.job()).unwrap(), "the first job");
        second.write(&mut session, &new);
        session.start(&old.job());
        session.machine().spl_mut().limit(None);
        session.machine().advance(moment).unwrap();
        let runs = session.status().is_none();
        second.announce(&mut session);
        let first = 1 << 31 | moment as u32;
        second.start(&mut session, &new, first);
        for sequence in [first, first + 1] {
            let done = (0..30_000).any(|_| {
                session.machine().advance(1).unwrap();
                second.is_done(&mut session, &new, sequence)
            });
            assert!(done, "after {moment} cycles: no status of job {sequence:#x} in the new context");
            second.start(&mut session, &new, sequence + 1);
        }
        // What ran went on in its own context; before it began, the new context may have come first.
        if runs && let Some(status) = session.status() {
            old.check_written(&session.outcome(&status), "the old context's job");
        }
    }
}
