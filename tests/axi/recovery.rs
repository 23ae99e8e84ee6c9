//! Aborts, resets, error responses and lost responses at any time: nothing wrong is ever written, no rule of AXI4 is
//! broken, and the next transaction is right.

use contact_afu::afu::JobError;
use contact_afu::afu::shell::axi::map;
use contact_afu::cosim::axi::Machine;
use contact_afu::host::{HostError, Running, Session, Transaction};
use contact_afu::link::axi::Handshake;
use contact_afu::link::{Fault, LinkModel};
use contact_afu::outcome::{Channel, Failure};

use crate::bench::{Case, config, end, machine, model, run, session};

const SCPUS: u32 = 3;

/// Starts a job and runs it for `moment` cycles, before the caller disturbs it.
fn disturbed<'s, 'a>(
    session: &'s mut Session<Machine<'a>>,
    case: &Case,
    moment: u64,
) -> Result<Transaction<'s, Machine<'a>, Running>, HostError> {
    session.set_workspace(case.workspace(60, 30));
    let mut running = session.transaction().send(&case.pairs)?.start()?.confirm()?;
    running.idle(moment)?;
    Ok(running)
}

/// Checks the transaction after one that was disturbed, in other buffers.
#[track_caller]
fn next_is_right(session: &mut Session<Machine<'_>>, next: &Case, what: &str) {
    session.set_workspace(next.workspace(2000, 1000));
    next.check(&run(session, next).unwrap_or_else(|e| panic!("{what}: {e}")), what);
}

/// What happens to a short job.
#[derive(Clone, Copy, Debug, PartialEq)]
enum How {
    /// The host writes the register of the soft reset, and waits for the status.
    Abort,
    /// The host is gone; the next one begins with a soft reset.
    Gone,
    /// Accelerator and interconnect are reset together.
    SystemReset,
}

#[test]
fn abort_and_reset_at_every_cycle_of_a_short_job() {
    let (spoilt, next) = (Case::random(15, 31), Case::random(9, 32));
    for (bus, link) in [(512, "late"), (128, "hostile")] {
        let config = config(SCPUS, bus);
        let model = model(&config);
        for how in [How::Abort, How::Gone, How::SystemReset] {
            let afu = model.instance(7).unwrap();
            let machine = machine(&afu, link, Handshake::Free, 7);
            let mut session = session(machine, &config, spoilt.workspace(0, 0));
            let mut aborted = 0;
            for moment in 0.. {
                let what = format!("{bus} bits, {link}, {how:?} after {moment} cycles");
                let mut running = disturbed(&mut session, &spoilt, moment).unwrap_or_else(|e| panic!("{what}: {e}"));
                let done = running.is_done();
                match how {
                    How::Abort if !done => {
                        running.abort().unwrap();
                        let ended = running.wait().unwrap_or_else(|e| panic!("{what}: {e}"));
                        let outcome = ended.outcome();
                        if outcome.error == 1 {
                            spoilt.check_written(&outcome, &what);
                            aborted += 1;
                        } else {
                            spoilt.check(&outcome, &what);
                        }
                        std::mem::forget(ended);
                    }
                    How::SystemReset => {
                        running.transport_mut().system_reset().unwrap_or_else(|e| panic!("{what}: {e}"));
                        std::mem::forget(running);
                    }
                    _ => std::mem::forget(running),
                }
                next_is_right(&mut session, &next, &what);
                if done {
                    assert!(moment > 60 && (aborted > 60 || how != How::Abort), "{what}: {aborted} aborted");
                    break;
                }
            }
        }
    }
}

/// An error response ends the job with an error that names channel and address, and the next job is right.
#[test]
fn an_error_response_names_its_channel_and_address() {
    let (spoilt, next) = (Case::random(301, 21), Case::random(57, 22));
    for bus in [512, 128] {
        let config = config(SCPUS, bus);
        let model = model(&config);
        for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
            let afu = model.instance(seed).unwrap();
            let machine = machine(&afu, link, Handshake::Free, seed);
            let mut session = session(machine, &config, spoilt.workspace(0, 0));
            for (fault, number, channel) in [
                (Fault::ReadError(0), 0, Channel::Read),
                (Fault::ReadError(99), 99, Channel::Read),
                (Fault::WriteError(0), 0, Channel::Write),
                (Fault::WriteError(149), 149, Channel::Write),
            ] {
                let what = format!("{bus} bits, {link}, {fault:?}");
                let workspace = spoilt.workspace(60, 30);
                let first = if channel == Channel::Read { workspace.source() } else { workspace.destination() };
                session.set_workspace(workspace);
                let mut loaded = session.transaction().send(&spoilt.pairs).unwrap();
                loaded.transport_mut().memory_mut().link_mut().plan(&[fault]);
                let done = end(loaded).unwrap_or_else(|e| panic!("{what}: {e}"));
                let outcome = done.outcome();
                spoilt.check_written(&outcome, &what);
                let line = first + 64 * number;
                let Some(Failure { channel: found, response: 2, address }) = outcome.failure else {
                    panic!("{what}: {:?}", outcome.failure)
                };
                // A read names its line. A write names its burst, which begins at most 4 KB before.
                let before = if channel == Channel::Read { 0 } else { 4095 - line % 4096 % 64 };
                assert!(
                    found == channel && (line - before.min(line)..=line).contains(&address),
                    "{what}: {address:#x}"
                );
                let error = done.retrieve().unwrap_err().to_string();
                let letter = if channel == Channel::Read { "SLVERR on channel R" } else { "SLVERR on channel B" };
                assert!(error.contains(letter) && error.contains(&format!("{address:#x}")), "{what}: {error}");
                session.transport_mut().memory_mut().link_mut().plan(&[]);
                next_is_right(&mut session, &next, &what);
            }
        }
    }
}

/// With a watchdog the job ends with its error; without one the host gives up. Either way the soft reset cannot end,
/// and says so; a reset of accelerator and interconnect recovers.
#[test]
fn a_lost_response_is_an_error_and_never_wrong_data() {
    let (spoilt, next) = (Case::random(301, 21), Case::random(57, 22));
    let config = config(SCPUS, 256);
    let model = model(&config);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let machine = machine(&afu, link, Handshake::Free, seed);
        let mut session = session(machine, &config, spoilt.workspace(0, 0));
        for (fault, watchdog) in [
            (Fault::ReadLost(9), 3_000),
            (Fault::WriteLost(100), 3_000),
            (Fault::ReadLost(40), 0),
            (Fault::WriteLost(3), 0),
        ] {
            let what = format!("{link}, {fault:?}, watchdog {watchdog}");
            (session.watchdog, session.max_cycles) = (watchdog, Some(12_000));
            session.set_workspace(spoilt.workspace(60, 30));
            let mut loaded = session.transaction().send(&spoilt.pairs).unwrap();
            loaded.transport_mut().memory_mut().link_mut().plan(&[fault]);
            match end(loaded) {
                Ok(done) => {
                    let outcome = done.outcome();
                    assert_eq!((outcome.error, watchdog > 0), (4, true), "{what}");
                    assert!(spoilt.check_written(&outcome, &what) < outcome.lines.len(), "{what}");
                    let text = done.retrieve().unwrap_err().to_string();
                    assert!(text.contains("watchdog"), "{what}: {text}");
                }
                Err(HostError::NoStatus { reads, writes, .. }) => {
                    assert!(watchdog == 0 && (reads, writes) != (0, 0), "{what}: {reads} reads, {writes} writes");
                }
                Err(other) => panic!("{what}: {other}"),
            }
            (session.watchdog, session.max_cycles) = (0, None);
            let stuck = session.transaction().send(&next.pairs).unwrap_err().to_string();
            assert!(stuck.contains("memory owes a response"), "{what}: {stuck}");
            session.transport_mut().memory_mut().link_mut().plan(&[]);
            session.transport_mut().system_reset().unwrap();
            next_is_right(&mut session, &next, &what);
        }
    }
}

/// What nobody asked for is counted, and ends the job that runs with error 7. It never goes by unseen, whenever it
/// comes, and the next job is right without a reset.
#[test]
fn a_response_that_nobody_asked_for_is_told() {
    let (spoilt, next) = (Case::random(15, 31), Case::random(9, 32));
    for (bus, link) in [(512, "late"), (128, "ideal")] {
        let config = config(SCPUS, bus);
        let model = model(&config);
        for (read, write) in [(true, false), (false, true)] {
            let afu = model.instance(7).unwrap();
            let mut session = session(machine(&afu, link, Handshake::Free, 7), &config, spoilt.workspace(0, 0));
            let unasked = |machine: &mut Machine<'_>| machine.read_register(map::UNASKED.offset).unwrap();
            let mut told = 0;
            for moment in 0.. {
                let what = format!("{bus} bits, {link}, read {read}, after {moment} cycles");
                let mut running = disturbed(&mut session, &spoilt, moment).unwrap_or_else(|e| panic!("{what}: {e}"));
                let done = running.is_done();
                running.transport_mut().memory_mut().give_unasked(read, write);
                let ended = running.wait().unwrap_or_else(|e| panic!("{what}: {e}"));
                let error = ended.outcome().error;
                assert!(error == 0 || error == JobError::Response.code(), "{what}: error {error}");
                if error != 0 {
                    let text = ended.retrieve().unwrap_err().to_string();
                    assert!(text.contains("reset the interconnect and the accelerator together"), "{what}: {text}");
                    told += 1;
                } else {
                    std::mem::forget(ended);
                }
                next_is_right(&mut session, &next, &what);
                assert_eq!(unasked(session.transport_mut()), moment as u32 + 1, "{what}");
                if done {
                    assert!(moment > 60 && told > 10 && error == 0, "{what}: {told} told");
                    break;
                }
            }
        }
    }
}
