//! Resets of every kind, aborts and lost responses at any time: nothing wrong is ever written, and the next transaction
//! is right, even while SPL still answers earlier requests.

use contact_afu::cosim::spl2::Machine;
use contact_afu::host::{HostError, Running, Session, Transaction, Workspace};
use contact_afu::link::spl2::{PAGE_LINES, Spl2Model};
use contact_afu::link::{Fault, LinkModel};

use crate::bench::{Case, cycles_to_the_last_write, end, machine, model, quick, rough, run, session, workspace};

const SCPUS: u32 = 3;

/// Early cycles of a job one by one, later ones at growing distances.
fn moments() -> impl Iterator<Item = u64> {
    (0..30).step_by(3).chain((30..200).step_by(17)).chain((200..1300).step_by(83))
}

fn two_cases() -> (Case, Case) {
    (Case::random(301, 21), Case::random(57, 22))
}

/// The workspace of the next transaction: late writes of the one before may still arrive at any time.
fn elsewhere(case: &Case) -> Workspace {
    workspace(3, PAGE_LINES + 2, 2 * PAGE_LINES - 9, case.room()).unwrap()
}

/// Starts a job and runs it for `moment` cycles, before the caller disturbs it.
fn disturbed<'s, 'a>(
    session: &'s mut Session<Machine<'a>>,
    case: &Case,
    moment: u64,
) -> Result<Transaction<'s, Machine<'a>, Running>, HostError> {
    session.set_workspace(case.workspace(3));
    let mut running = session.transaction().send(&case.pairs)?.start()?.confirm()?;
    running.idle(moment)?;
    Ok(running)
}

/// Checks the transaction after one whose host disappeared without stopping anything.
#[track_caller]
fn next_is_right(session: &mut Session<Machine<'_>>, next: &Case, what: &str) {
    session.set_workspace(elsewhere(next));
    next.check(&run(session, next).unwrap_or_else(|e| panic!("{what}: {e}")), what);
}

/// Runs a job for some cycles, disturbs the machine, and then runs the next transaction from the start.
fn interrupted(spl: Spl2Model, how: &str, interrupt: impl Fn(&mut Machine<'_>)) {
    let (spoilt, next) = two_cases();
    let model = model(SCPUS);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut session = session(machine(&afu, spl, link, seed), SCPUS, spoilt.workspace(3));
        let mut stale = 0;
        for moment in moments() {
            let what = format!("{link}, {how} after {moment} cycles");
            let mut running = disturbed(&mut session, &spoilt, moment).unwrap_or_else(|e| panic!("{what}: {e}"));
            interrupt(running.transport_mut());
            stale += running.transport().spl().stale().0 + running.transport().spl().stale().1;
            std::mem::forget(running);
            next_is_right(&mut session, &next, &what);
        }
        assert!(stale > 0 || link == "ideal" || how == "the system's reset", "{link}: nothing old was on its way");
    }
}

/// A transaction begins with a reset of SPL. Outstanding requests are answered in the middle of the next transaction.
#[test]
fn a_reset_of_spl_at_any_time() {
    interrupted(quick(), "reset", |machine| machine.write_csr(0x1010, 1).unwrap());
    interrupted(Spl2Model { reset_cycles: 0, ..rough() }, "reset as a level", |machine| {
        machine.write_csr(0x1010, 1).unwrap();
    });
}

#[test]
fn spl_disabled_at_any_time() {
    interrupted(quick(), "disabled", |machine| machine.write_csr(0x1010, 0).unwrap());
}

#[test]
fn a_reset_of_the_system_at_any_time() {
    interrupted(quick(), "the system's reset", |machine| machine.system_reset().unwrap());
}

#[test]
fn abort_at_any_time_and_the_next_job_is_right() {
    let (spoilt, next) = two_cases();
    let model = model(SCPUS);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut session = session(machine(&afu, rough(), link, seed), SCPUS, spoilt.workspace(1));
        let (mut aborted, mut complete) = (0, 0);
        let mut loaded = session.transaction().send(&spoilt.pairs).unwrap();
        for moment in moments() {
            let what = format!("{link}, abort after {moment} cycles");
            let mut running = loaded.start().unwrap().confirm().unwrap();
            running.idle(moment).unwrap();
            running.abort().unwrap();
            let done = running.wait().unwrap_or_else(|e| panic!("{what}: {e}"));
            let outcome = done.outcome();
            match outcome.error {
                1 => {
                    spoilt.check_written(&outcome, &what);
                    aborted += 1;
                }
                _ => {
                    spoilt.check_after(&outcome, moment.max(outcome.cycles), &what);
                    complete += 1;
                }
            }
            let done = end(done.send_next(&next.pairs).unwrap()).unwrap_or_else(|e| panic!("{what}: {e}"));
            next.check(&done.outcome(), &what);
            loaded = done.send_next(&spoilt.pairs).unwrap();
        }
        assert!(aborted > 0 && complete > 0, "{link}: {aborted} aborted, {complete} done");
    }
}

/// Stops a short job in each of its cycles, from the write that starts it to its status.
#[test]
fn reset_and_abort_at_every_cycle_of_a_short_job() {
    let (spoilt, next) = (Case::random(15, 31), Case::random(9, 32));
    let model = model(SCPUS);
    let core = u64::from(cycles_to_the_last_write(SCPUS, spoilt.pairs.len()));
    for (link, aborts) in [("late", false), ("late", true), ("hostile", false), ("hostile", true)] {
        let afu = model.instance(7).unwrap();
        let mut session = session(machine(&afu, quick(), link, 7), SCPUS, spoilt.workspace(3));
        let mut aborted = 0;
        for moment in 0.. {
            let what = format!("{link}, {} after {moment} cycles", if aborts { "abort" } else { "reset" });
            let mut running = disturbed(&mut session, &spoilt, moment).unwrap_or_else(|e| panic!("{what}: {e}"));
            let done = running.is_done();
            if aborts && !done {
                running.abort().unwrap();
                let ended = running.wait().unwrap_or_else(|e| panic!("{what}: {e}"));
                let outcome = ended.outcome();
                match outcome.error {
                    1 => {
                        spoilt.check_written(&outcome, &what);
                        aborted += 1;
                    }
                    // The job was done before the abort arrived.
                    _ => spoilt.check(&outcome, &what),
                }
                std::mem::forget(ended);
            } else {
                running.transport_mut().write_csr(0x1010, 1).unwrap();
                std::mem::forget(running);
            }
            next_is_right(&mut session, &next, &what);
            if done {
                // A job can be stopped until it requests its last write, and the link's latency comes on top.
                assert!(moment > core, "{link}: a job of {moment} cycles");
                assert!(aborted > core || !aborts, "{link}: {aborted} of {moment} aborted, no link takes {core}");
                break;
            }
        }
    }
}

/// Without a watchdog the status never arrives; with one, it reports the error. Nothing wrong is written, and a reset
/// recovers. The first reads are the shell's own. Its polls are repeated, but SPL2 holds them all back behind a lost
/// read.
#[test]
fn a_lost_response_is_an_error_and_never_wrong_data() {
    let (spoilt, next) = two_cases();
    let model = model(SCPUS);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut session = session(machine(&afu, quick(), link, seed), SCPUS, spoilt.workspace(3));
        for (fault, watchdog) in [
            (Fault::ReadLost(9), 3_000),
            (Fault::WriteLost(3), 3_000),
            (Fault::ReadLost(100), 3_000),
            (Fault::WriteLost(100), 3_000),
            (Fault::ReadLost(40), 0),
            (Fault::WriteLost(40), 0),
        ] {
            let what = format!("{link}, {fault:?}, watchdog {watchdog}");
            (session.watchdog, session.max_cycles) = (watchdog, Some(12_000));
            session.set_workspace(spoilt.workspace(3));
            let mut loaded = session.transaction().send(&spoilt.pairs).unwrap();
            loaded.transport_mut().spl_mut().link_mut().plan(&[fault]);
            let ended = end(loaded).map(|done| done.outcome());
            session.transport_mut().spl_mut().link_mut().plan(&[]);
            match ended {
                Ok(outcome) => {
                    assert_eq!((outcome.error, watchdog > 0), (4, true), "{what}");
                    assert!(spoilt.check_written(&outcome, &what) < outcome.lines.len(), "{what}");
                }
                Err(HostError::NoStatus { reads, writes, .. }) => {
                    assert!(watchdog == 0 && (reads, writes) != (0, 0), "{what}: {reads} reads, {writes} writes");
                }
                Err(other) => panic!("{what}: {other}"),
            }
            (session.watchdog, session.max_cycles) = (0, None);
            next_is_right(&mut session, &next, &what);
        }
    }
}
