//! Jobs one after another without a reset: the delay before the next one starts, and the effect of writing the context
//! again.

use contact_afu::afu::shell::spl2::map::{self, control, pointers, status};
use contact_afu::cosim::spl2::Machine;
use contact_afu::host::Workspace;
use contact_afu::link::spl2::PAGE_LINES;

use crate::bench::{Case, end, machine, model, quick, session};

const SCPUS: u32 = 3;
/// Cycles of a poll (CSR write, read and answer) in addition to its pause, over an ideal link.
const POLL_CYCLES: u64 = 40;

#[test]
fn the_next_job_starts_when_the_last_one_has_ended() {
    let case = Case::random(20, 41);
    let afu = model(SCPUS).instance(1).unwrap();
    let mut session = session(machine(&afu, quick(), "ideal", 1), SCPUS, case.workspace(1));
    let mut loaded = session.transaction().send(&case.pairs).unwrap();
    loaded.transport_mut().advance(200).unwrap();
    let mut cycles = Vec::new();
    for pause in [0, 0, 0, 1, 7, 31, 32, 33, 600, 0] {
        loaded.transport_mut().advance(pause).unwrap();
        let done = end(loaded).unwrap();
        let outcome = done.outcome();
        case.check(&outcome, "a job after another");
        cycles.push(outcome.cycles);
        loaded = done.send_next(&case.pairs).unwrap();
    }
    let most = cycles[0] + u64::from(map::IDLE_POLL_CYCLES) + POLL_CYCLES;
    assert!(cycles.iter().all(|cycles| *cycles <= most), "{cycles:?}: more than {most}");
}

/// A context written by the test: its line in the workspace, and its buffers.
struct Context {
    workspace: Workspace,
    line: u64,
    source: u64,
    destination: u64,
}

impl Context {
    fn address(&self, line: u64) -> u64 {
        self.workspace.context() + 64 * line
    }

    fn put(&self, machine: &mut Machine<'_>, line: u64, data: [u32; 16]) {
        let at = self.workspace.physical(self.address(line)).unwrap();
        machine.memory_mut().set(at, &data);
    }

    fn get(&self, machine: &Machine<'_>, line: u64) -> [u32; 16] {
        let at = self.workspace.physical(self.address(line)).unwrap();
        machine.memory().get(at).copied().unwrap_or_default()
    }

    fn write(&self, machine: &mut Machine<'_>, case: &Case) {
        let mut line = [0; 16];
        pointers::SOURCE.set(&mut line, self.address(self.source).into());
        pointers::DESTINATION.set(&mut line, self.address(self.destination).into());
        pointers::LINES.set(&mut line, case.room().into());
        self.put(machine, self.line, line);
        self.put(machine, self.line + 1, [0; 16]);
        self.put(machine, self.source, [0; 16]);
        for (number, line) in (1..).zip(case.source()) {
            self.put(machine, self.source + number, *line);
        }
    }

    fn announce(&self, machine: &mut Machine<'_>) {
        let address = self.address(self.line);
        machine.write_csr(map::CONTEXT_BASE_HIGH.offset, (address >> 32) as u32).unwrap();
        machine.write_csr(map::CONTEXT_BASE_LOW.offset, address as u32).unwrap();
    }

    fn start(&self, machine: &mut Machine<'_>, case: &Case, sequence: u32) {
        let mut line = [0; 16];
        control::COUNT.set(&mut line, case.pairs.len() as u128);
        control::SEQUENCE.set(&mut line, sequence.into());
        control::START.set(&mut line, map::START_WORD.into());
        self.put(machine, self.source, line);
    }

    /// True if the job is complete. Checks that every result is where this context puts it.
    fn is_done(&self, machine: &Machine<'_>, case: &Case, sequence: u32) -> bool {
        let line = self.get(machine, self.line + 1);
        if status::DONE.get(&line) == 0 || status::SEQUENCE.get(&line) != sequence.into() {
            return false;
        }
        assert_eq!(status::ERROR.get(&line), 0);
        let lines = case.wanted().len() as u64;
        let got: Vec<_> = (0..lines).map(|number| self.get(machine, self.destination + number)).collect();
        assert_eq!(got, case.wanted());
        true
    }
}

/// The next job uses only the new context. A running job uses only the old one.
#[test]
fn a_context_written_again_counts_from_the_next_job_on() {
    let (old, new) = (Case::random(60, 42), Case::random(33, 43));
    let model = model(SCPUS);
    let workspace = old.workspace(3);
    let second =
        Context { workspace: workspace.clone(), line: PAGE_LINES, source: PAGE_LINES + 2, destination: 2 * PAGE_LINES };
    for moment in (0..120).step_by(3) {
        let afu = model.instance(moment).unwrap();
        let mut session = session(machine(&afu, quick(), "late", moment), SCPUS, workspace.clone());
        let done = end(session.transaction().send(&old.pairs).unwrap()).unwrap();
        old.check(&done.outcome(), "the first job");
        let mut loaded = done.send_next(&old.pairs).unwrap();
        second.write(loaded.transport_mut(), &new);
        let mut running = loaded.start().unwrap().confirm().unwrap();
        running.transport_mut().spl_mut().limit(None);
        running.idle(moment).unwrap();
        let runs = !running.is_done();
        second.announce(running.transport_mut());
        let first = 1 << 31 | moment as u32;
        second.start(running.transport_mut(), &new, first);
        for sequence in [first, first + 1] {
            let done = (0..30_000).any(|_| {
                running.idle(1).unwrap();
                second.is_done(running.transport(), &new, sequence)
            });
            assert!(done, "after {moment} cycles: no status of job {sequence:#x} in the new context");
            second.start(running.transport_mut(), &new, sequence + 1);
        }
        // A running job continues in its own context. If it had not begun, it may have used the new one.
        if runs && running.is_done() {
            old.check_written(&running.wait().unwrap().outcome(), "the old context's job");
        }
    }
}
