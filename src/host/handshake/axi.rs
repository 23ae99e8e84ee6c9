//! The handshake of the shell `axi`: registers and an interrupt.

use super::Identity;
use crate::afu::DRAIN_CYCLES;
use crate::afu::shell::axi::map::{self, Register};
use crate::config::Input;
use crate::host::error::HostError;
use crate::host::received::Status;
use crate::host::session::Session;
use crate::host::task::Task;
use crate::host::transport::{Transport, TransportError};
use crate::outcome::{Channel, Failure};

/// Cycles between two reads of the register that says whether the soft reset has ended.
const POLL_CYCLES: u64 = 16;

/// Ends what runs, checks the identity, and enables the interrupt.
pub(in crate::host) fn set_up<T: Transport>(session: &mut Session<T>) -> Result<(), HostError> {
    tear_down(session)?;
    session.check_identity()?;
    write(session, map::GLOBAL_INTERRUPT_ENABLE, map::ENABLE.put(1))?;
    write(session, map::INTERRUPT_ENABLE, map::DONE_EVENT.put(1))?;
    Ok(acknowledge(session)?)
}

/// The soft reset: aborts what runs, and waits until memory owes nothing.
pub(in crate::host) fn tear_down<T: Transport>(session: &mut Session<T>) -> Result<(), HostError> {
    write(session, map::SOFT_RESET, map::RESET.put(1))?;
    let begun = session.transport.cycle();
    let patience = session.patience(&Task::default()).whole + u64::from(DRAIN_CYCLES.max(session.watchdog));
    while map::RESET.get(read(session, map::SOFT_RESET, 0)?) != 0 {
        let waited = session.transport.cycle() - begun;
        if waited > patience {
            return Err(HostError::NotDrained(waited));
        }
        session.transport.advance(POLL_CYCLES)?;
    }
    Ok(())
}

/// What the AFU has in its registers.
pub(in crate::host) fn identity<T: Transport>(session: &mut Session<T>) -> Result<Identity, HostError> {
    let mut afu_id = 0;
    for word in (0..map::IDENTITY.words).rev() {
        afu_id = afu_id << 32 | u128::from(read(session, map::IDENTITY, word)?);
    }
    let version = read(session, map::MAP_VERSION, 0)?;
    Ok(Identity { afu_id, version, capability: read_wide(session, map::CAPABILITY)? })
}

/// Writes the job, then its start.
pub(in crate::host) fn start<T: Transport>(session: &mut Session<T>, task: &Task) -> Result<(), HostError> {
    let workspace = &session.workspace;
    let (source, destination) = (workspace.pairs(), workspace.destination());
    let lines = u32::try_from(workspace.destination_room()).unwrap_or(u32::MAX);
    write_wide(session, map::SOURCE, source)?;
    write_wide(session, map::DESTINATION, destination)?;
    write(session, map::COUNT, task.count)?;
    write(session, map::DESTINATION_LINES, lines)?;
    write(session, map::MODE, task.mode)?;
    if task.input == Input::Spheres {
        write(session, map::OTHERS, task.others)?;
    }
    write(session, map::WATCHDOG, session.watchdog)?;
    write(session, map::CONTROL, map::START.put(1))?;
    Ok(())
}

/// Begins the soft reset, with which the job ends.
pub(in crate::host) fn abort<T: Transport>(session: &mut Session<T>) -> Result<(), HostError> {
    Ok(write(session, map::SOFT_RESET, map::RESET.put(1))?)
}

/// The status, once the interrupt has come.
pub(in crate::host) fn status<T: Transport>(session: &mut Session<T>) -> Result<Option<Status>, HostError> {
    if !session.transport.interrupt() {
        return Ok(None);
    }
    let cycle = session.transport.cycle();
    acknowledge(session)?;
    let status = read(session, map::STATUS, 0)?;
    let failure = read(session, map::FAILURE, 0)?;
    let address = read_wide(session, map::FAILURE_ADDRESS)?;
    let channel = match map::CHANNEL.get(failure) {
        0 => None,
        1 => Some(Channel::Read),
        _ => Some(Channel::Write),
    };
    let response = map::RESPONSE.get(failure) as u8;
    let candidates = match session.input() {
        Input::Direct => None,
        Input::Spheres => Some(read(session, map::CANDIDATES, 0)?),
    };
    Ok(Some(Status {
        error: map::ERROR.get(status) as u8,
        failure: channel.map(|channel| Failure { channel, response, address }),
        contacts: read(session, map::CONTACTS, 0)?,
        candidates,
        invalid: read(session, map::INVALID, 0)?,
        first_invalid: read(session, map::FIRST_INVALID, 0)?,
        cycles_busy: read_wide(session, map::CYCLES_BUSY)?,
        cycles_input: read_wide(session, map::CYCLES_INPUT)?,
        cycles_output: read_wide(session, map::CYCLES_OUTPUT)?,
        first_read: read(session, map::FIRST_READ, 0)?.into(),
        first_write: read(session, map::FIRST_WRITE, 0)?.into(),
        cycle,
    }))
}

/// Clears the recorded events: writes back what was read.
fn acknowledge<T: Transport>(session: &mut Session<T>) -> Result<(), TransportError> {
    let events = read(session, map::INTERRUPT_STATUS, 0)?;
    write(session, map::INTERRUPT_STATUS, events)
}

fn write<T: Transport>(session: &mut Session<T>, register: Register, value: u32) -> Result<(), TransportError> {
    session.transport.write_csr(register.offset, value)
}

fn write_wide<T: Transport>(session: &mut Session<T>, register: Register, value: u64) -> Result<(), TransportError> {
    session.transport.write_csr(register.offset, value as u32)?;
    session.transport.write_csr(register.offset + 4, (value >> 32) as u32)
}

fn read<T: Transport>(session: &mut Session<T>, register: Register, word: u32) -> Result<u32, TransportError> {
    session.transport.read_csr(register.offset + 4 * word)
}

fn read_wide<T: Transport>(session: &mut Session<T>, register: Register) -> Result<u64, TransportError> {
    let low = read(session, register, 0)?;
    Ok(u64::from(read(session, register, 1)?) << 32 | u64::from(low))
}
