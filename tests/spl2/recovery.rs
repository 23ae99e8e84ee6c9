//! Resets of every kind, aborts and lost responses at any moment: nothing wrong is ever written, and the next
//! transaction is right, also while SPL still answers what was asked before.

use contact_afu::cosim::Job;
use contact_afu::cosim::spl2::{Machine, MachineError, Place, Session};
use contact_afu::link::spl2::{PAGE_BYTES, Spl2Model};
use contact_afu::link::{Fault, LinkModel};

use crate::bench::{Case, cycles_to_the_last_write, machine, model, quick, rough};

const SCPUS: u32 = 3;

/// Early cycles of a job closely, later ones with growing distance.
fn moments() -> impl Iterator<Item = u64> {
    (0..30).step_by(3).chain((30..200).step_by(17)).chain((200..1300).step_by(83))
}

fn two_cases() -> (Case, Case) {
    (Case::random(301, 21), Case::random(57, 22))
}

/// Where the next transaction is: late writes of the one before may come at any time.
fn elsewhere(case: &Case) -> Place {
    let place = case.place();
    let page = PAGE_BYTES / 64;
    Place { pages: 3, source: page + place.source, destination: 2 * page - 9, ..place }
}

fn spoilt_place(case: &Case) -> Place {
    Place { pages: 3, ..case.place() }
}

/// Runs a job for some cycles, does something to the machine, and runs the next transaction from the start.
fn interrupted(spl: Spl2Model, how: &str, interrupt: impl Fn(&mut Machine<'_>)) {
    let (spoilt, next) = two_cases();
    let model = model(SCPUS);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut machine = machine(&afu, spl, link, seed);
        let mut stale = 0;
        for moment in moments() {
            let what = format!("{link}, {how} after {moment} cycles");
            let mut session = Session::open(&mut machine, spoilt_place(&spoilt), Some(SCPUS)).unwrap();
            session.start(&spoilt.job());
            session.machine().advance(moment).unwrap_or_else(|e| panic!("{what}: {e}"));
            interrupt(&mut machine);
            stale += machine.spl().stale().0 + machine.spl().stale().1;
            let mut session =
                Session::open(&mut machine, elsewhere(&next), Some(SCPUS)).unwrap_or_else(|e| panic!("{what}: {e}"));
            let outcome = session.run(&next.job()).unwrap_or_else(|e| panic!("{what}: {e}"));
            next.check(&outcome, &what);
        }
        assert!(stale > 0 || link == "ideal" || how == "the system's reset", "{link}: nothing old was on its way");
    }
}

/// Opening a session resets SPL: what is still on its way is answered in the middle of the next.
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
        let mut machine = machine(&afu, rough(), link, seed);
        let mut session = Session::open(&mut machine, spoilt.place(), Some(SCPUS)).unwrap();
        let (mut aborted, mut complete) = (0, 0);
        for moment in moments() {
            let what = format!("{link}, abort after {moment} cycles");
            session.start(&spoilt.job());
            session.machine().advance(moment).unwrap();
            session.abort();
            let status = session.wait(30_000).unwrap_or_else(|e| panic!("{what}: {e}"));
            let outcome = session.outcome(&status);
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
            next.check(&session.run(&next.job()).unwrap_or_else(|e| panic!("{what}: {e}")), &what);
        }
        assert!(aborted > 0 && complete > 0, "{link}: {aborted} aborted, {complete} done");
    }
}

/// A short job stopped in each of its cycles, from the write that starts it to its status.
#[test]
fn reset_and_abort_at_every_cycle_of_a_short_job() {
    let (spoilt, next) = (Case::random(15, 31), Case::random(9, 32));
    let model = model(SCPUS);
    let core = u64::from(cycles_to_the_last_write(SCPUS, spoilt.pairs.len()));
    for (link, aborts) in [("late", false), ("late", true), ("hostile", false), ("hostile", true)] {
        let afu = model.instance(7).unwrap();
        let mut machine = machine(&afu, quick(), link, 7);
        let mut aborted = 0;
        for moment in 0.. {
            let what = format!("{link}, {} after {moment} cycles", if aborts { "abort" } else { "reset" });
            let mut session = Session::open(&mut machine, spoilt_place(&spoilt), Some(SCPUS)).unwrap();
            session.start(&spoilt.job());
            session.machine().advance(moment).unwrap_or_else(|e| panic!("{what}: {e}"));
            let done = session.status().is_some();
            if aborts && !done {
                session.abort();
                let status = session.wait(30_000).unwrap_or_else(|e| panic!("{what}: {e}"));
                let outcome = session.outcome(&status);
                match outcome.error {
                    1 => {
                        spoilt.check_written(&outcome, &what);
                        aborted += 1;
                    }
                    // It was done before it saw the abort.
                    _ => spoilt.check(&outcome, &what),
                }
            } else {
                machine.write_csr(0x1010, 1).unwrap();
            }
            let mut session =
                Session::open(&mut machine, elsewhere(&next), Some(SCPUS)).unwrap_or_else(|e| panic!("{what}: {e}"));
            next.check(&session.run(&next.job()).unwrap_or_else(|e| panic!("{what}: {e}")), &what);
            if done {
                // Until its last line is asked to be written, a job can be stopped, and the link takes time on top.
                assert!(moment > core, "{link}: a job of {moment} cycles");
                assert!(aborted > core || !aborts, "{link}: {aborted} of {moment} aborted, no link takes {core}");
                break;
            }
        }
    }
}

/// Without a watchdog the status never comes, with one it says so; nothing wrong is written, and after a reset all is
/// well. The first reads are the shell's own: its polls are asked again, but behind a lost read SPL2 holds them all
/// back.
#[test]
fn a_lost_response_is_an_error_and_never_wrong_data() {
    let (spoilt, next) = two_cases();
    let model = model(SCPUS);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut machine = machine(&afu, quick(), link, seed);
        for (fault, watchdog) in [
            (Fault::ReadLost(9), 3_000),
            (Fault::WriteLost(3), 3_000),
            (Fault::ReadLost(100), 3_000),
            (Fault::WriteLost(100), 3_000),
            (Fault::ReadLost(40), 0),
            (Fault::WriteLost(40), 0),
        ] {
            let what = format!("{link}, {fault:?}, watchdog {watchdog}");
            let mut session = Session::open(&mut machine, spoilt_place(&spoilt), Some(SCPUS)).unwrap();
            session.machine().spl_mut().link_mut().plan(&[fault]);
            let job = Job { watchdog, max_cycles: Some(12_000), ..spoilt.job() };
            let ended = session.run(&job);
            session.machine().spl_mut().link_mut().plan(&[]);
            match ended {
                Ok(outcome) => {
                    assert_eq!((outcome.error, watchdog > 0), (4, true), "{what}");
                    assert!(spoilt.check_written(&outcome, &what) < outcome.lines.len(), "{what}");
                }
                Err(MachineError::NoStatus { in_flight, .. }) => {
                    assert!(watchdog == 0 && in_flight != (0, 0), "{what}: {in_flight:?}");
                }
                Err(other) => panic!("{what}: {other}"),
            }
            let mut session = Session::open(&mut machine, elsewhere(&next), Some(SCPUS)).unwrap();
            next.check(&session.run(&next.job()).unwrap_or_else(|e| panic!("{what}: {e}")), &what);
        }
    }
}
