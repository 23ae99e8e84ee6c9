//! The handshake below SPL2: control memory, DSM and context.

use super::Identity;
use crate::afu::shell::spl2::map::{self, Csr, control, identity, latency, performance, status};
use crate::config::Input;
use crate::host::error::HostError;
use crate::host::received::{Begin, Status};
use crate::host::session::Session;
use crate::host::task::Task;
use crate::host::transport::{Transport, TransportError};
use crate::host::workspace::{AFU_DSM, SPL_CONTEXT, SPL_DSM};
use crate::link::spl2::CsrOffset;
use crate::link::{LINE_BYTES, Line};

/// Resets SPL and the AFU, gives them their memory, waits for the AFU to identify itself, and enables it.
pub(in crate::host) fn set_up<T: Transport>(session: &mut Session<T>) -> Result<(), HostError> {
    let pair = |high: Csr, low: Csr| (high.offset, low.offset);
    session.transport.write_csr(CsrOffset::Control as u32, 1)?;
    zero(session, SPL_DSM, 1);
    write_pointer(session, CsrOffset::DsmHigh as u32, CsrOffset::DsmLow as u32, SPL_DSM)?;
    wait_for(session, |session| session.line_at(SPL_DSM)[0] != 0)?;
    zero(session, AFU_DSM, map::DSM_BYTES / LINE_BYTES);
    session.transport.watch(AFU_DSM / LINE_BYTES..(AFU_DSM + map::DSM_BYTES) / LINE_BYTES);
    let (high, low) = pair(map::DSM_BASE_HIGH, map::DSM_BASE_LOW);
    write_pointer(session, high, low, AFU_DSM)?;
    wait_for(session, |session| identity(session).afu_id != 0)?;
    session.check_identity()?;
    for (at, line) in session.workspace.described()? {
        session.transport.put(at, &line);
    }
    let status = session.workspace.line(session.workspace.context(), map::STATUS_LINE.into())?;
    session.transport.watch(status..status + 1);
    write_pointer(session, CsrOffset::ContextHigh as u32, CsrOffset::ContextLow as u32, SPL_CONTEXT)?;
    let (high, low) = pair(map::CONTEXT_BASE_HIGH, map::CONTEXT_BASE_LOW);
    write_pointer(session, high, low, session.workspace.context())?;
    Ok(session.transport.write_csr(CsrOffset::Control as u32, 2)?)
}

/// Disables SPL, then resets it.
pub(in crate::host) fn tear_down<T: Transport>(session: &mut Session<T>) -> Result<(), HostError> {
    session.transport.write_csr(CsrOffset::Control as u32, 0)?;
    Ok(session.transport.write_csr(CsrOffset::Control as u32, 1)?)
}

/// What the AFU wrote into its DSM.
pub(in crate::host) fn identity<T: Transport>(session: &Session<T>) -> Identity {
    let line = dsm(session, map::IDENTITY_LINE);
    Identity {
        afu_id: identity::AFU_ID.get(&line),
        version: identity::VERSION.get(&line) as u32,
        capability: identity::CAPABILITY.get(&line) as u64,
    }
}

/// Clears the control memory: no job is there.
pub(in crate::host) fn clear_control<T: Transport>(session: &mut Session<T>) -> Result<(), HostError> {
    session.put(session.workspace.source(), map::CONTROL_LINE.into(), &[0; 16])
}

/// Writes the start word.
pub(in crate::host) fn start<T: Transport>(session: &mut Session<T>, task: &Task) -> Result<(), HostError> {
    set_control(session, task, false)
}

/// Writes the control memory with the mark of an abort.
pub(in crate::host) fn abort<T: Transport>(session: &mut Session<T>, task: &Task) -> Result<(), HostError> {
    set_control(session, task, true)
}

/// True if the status of the job has arrived.
pub(in crate::host) fn has_ended<T: Transport>(session: &Session<T>, begin: &Begin) -> bool {
    status_line(session, begin).is_some()
}

/// The status of the job, which has arrived after counters and latencies.
pub(in crate::host) fn status<T: Transport>(session: &Session<T>, begin: &Begin) -> Option<Status> {
    let (line, cycle) = status_line(session, begin)?;
    let (latencies, figures) = (dsm(session, map::LATENCY_LINE), dsm(session, map::PERFORMANCE_LINE));
    let word = |field: map::Field, line: &Line| field.get(line) as u64;
    let of_status = |field: map::Field| field.get(&line) as u32;
    Some(Status {
        error: of_status(status::ERROR) as u8,
        failure: None,
        contacts: of_status(status::CONTACTS),
        candidates: (session.input() == Input::Spheres).then(|| of_status(status::CANDIDATES)),
        invalid: of_status(status::INVALID),
        first_invalid: of_status(status::FIRST_INVALID),
        cycles_busy: word(performance::BUSY, &figures),
        cycles_input: word(performance::INPUT, &figures),
        cycles_output: word(performance::OUTPUT, &figures),
        first_read: word(latency::FIRST_READ, &latencies),
        first_write: word(latency::FIRST_WRITE, &latencies),
        cycle,
    })
}

/// The status line of the job, with the cycle in which it arrived.
fn status_line<T: Transport>(session: &Session<T>, begin: &Begin) -> Option<(Line, u64)> {
    let status_line = u64::from(map::STATUS_LINE) * LINE_BYTES;
    let at = session.workspace.physical(session.workspace.context() + status_line)?;
    let of_job = |line: &Line| status::SEQUENCE.get(line) == session.sequence.into() && status::DONE.get(line) == 1;
    let new = session.transport.device_writes().get(begin.logged..)?;
    let write = new.iter().find(|write| write.address == at && of_job(&write.data))?;
    Some((write.data, write.cycle))
}

/// Waits for an identity in a DSM.
fn wait_for<T: Transport>(session: &mut Session<T>, is_there: impl Fn(&Session<T>) -> bool) -> Result<(), HostError> {
    let (begun, patience) = (session.transport.cycle(), session.patience(&Task::default()).whole);
    while !is_there(session) {
        let waited = session.transport.cycle() - begun;
        if waited > patience {
            return Err(HostError::NoIdentity(waited));
        }
        session.transport.advance(1)?;
    }
    Ok(())
}

/// A line of the AFU's DSM.
fn dsm<T: Transport>(session: &Session<T>, line: u32) -> Line {
    session.line_at(AFU_DSM + u64::from(line) * LINE_BYTES)
}

/// Writes the control memory.
fn set_control<T: Transport>(session: &mut Session<T>, task: &Task, abort: bool) -> Result<(), HostError> {
    let mut line = [0; 16];
    control::COUNT.set(&mut line, task.count.into());
    control::OTHERS.set(&mut line, task.others.into());
    control::MODE.set(&mut line, task.mode.into());
    control::SEQUENCE.set(&mut line, session.sequence.into());
    control::ABORT.set(&mut line, abort.into());
    control::WATCHDOG.set(&mut line, session.watchdog.into());
    control::START.set(&mut line, map::START_WORD.into());
    session.put(session.workspace.source(), map::CONTROL_LINE.into(), &line)
}

/// Writes both halves of a 64-bit CSR.
fn write_pointer<T: Transport>(
    session: &mut Session<T>,
    high: u32,
    low: u32,
    address: u64,
) -> Result<(), TransportError> {
    session.transport.write_csr(high, (address >> 32) as u32)?;
    session.transport.write_csr(low, address as u32)
}

fn zero<T: Transport>(session: &mut Session<T>, address: u64, lines: u64) {
    let first = address / LINE_BYTES;
    (first..first + lines).for_each(|line| session.transport.put(line, &[0; 16]));
}
