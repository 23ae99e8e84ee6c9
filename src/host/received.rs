//! Reads the outcome of a job and its records from memory, once its status has arrived.

use super::error::{HitError, HostError};
use super::session::Session;
use super::task::Task;
use super::transport::Transport;
use crate::config::Input;
use crate::link::{LINE_BYTES, Traffic};
use crate::outcome::{Failure, Outcome};
use crate::query::{ContactRecord, Flow};
use crate::record::{Contacts, Layout};

/// The state at the start of a job: the cycle of its start word, and the link's traffic and the device's writes until
/// then.
#[derive(Clone, Copy, Debug)]
pub(super) struct Begin {
    pub(super) cycle: u64,
    pub(super) traffic: Traffic,
    pub(super) logged: usize,
}

/// The status of a job that has ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Status {
    pub(super) error: u8,
    pub(super) failure: Option<Failure>,
    pub(super) contacts: u32,
    /// Pairs of spheres whose boxes meet, if spheres came in.
    pub(super) candidates: Option<u32>,
    pub(super) invalid: u32,
    /// All ones if there is none.
    pub(super) first_invalid: u32,
    pub(super) cycles_busy: u64,
    pub(super) cycles_input: u64,
    pub(super) cycles_output: u64,
    /// Cycles from the job's start to its first source line, and to its first written line; 0 if there was none.
    pub(super) first_read: u64,
    pub(super) first_write: u64,
    /// The cycle in which the host was told.
    pub(super) cycle: u64,
}

/// The outcome of the job with this beginning and end. Bytes count all traffic over the link since the start.
pub(super) fn outcome<T: Transport>(session: &Session<T>, begin: &Begin, task: &Task, end: &Status) -> Outcome {
    let (transport, workspace) = (&session.transport, &session.workspace);
    let traffic = transport.traffic();
    let reads = traffic.read_responses - begin.traffic.read_responses;
    let writes = traffic.writes - begin.traffic.writes;
    let Status { first_read, first_write, .. } = *end;
    let mut results = workspace.limits(task).results;
    if task.input == Input::Spheres {
        // There may be room for far more.
        results.end = results.end.min(results.start + workspace.layout().destination_lines(end.contacts.into()));
    }
    let stored = |line: u64| transport.line(workspace.physical(line * LINE_BYTES)?);
    let sent = |line: u64| Some(transport.sent(line)?.saturating_sub(begin.cycle));
    Outcome {
        cycles: end.cycle.saturating_sub(begin.cycle),
        error: end.error,
        failure: end.failure,
        contacts: end.contacts,
        candidates: end.candidates,
        invalid: end.invalid,
        first_invalid: Some(end.first_invalid).filter(|&pair| pair != u32::MAX),
        cycles_busy: end.cycles_busy,
        cycles_input: end.cycles_input,
        cycles_output: end.cycles_output,
        latency_cycles: (first_read > 0 && first_write > 0).then(|| first_write.saturating_sub(first_read)),
        bytes_read: reads * LINE_BYTES,
        bytes_written: writes * LINE_BYTES,
        limit_cycles: transport.link().limit_cycles(reads, writes),
        lines: results.clone().map(stored).collect(),
        write_cycles: results.map(sent).collect(),
    }
}

/// The records of a job: one per pair in order, or only those of the pairs that touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Records {
    /// For each record, the number of its pair.
    pub(crate) numbers: Vec<u32>,
    pub(crate) contacts: Vec<ContactRecord>,
}

impl Records {
    /// The records of a job of `pairs` pairs that ended well.
    pub(super) fn read(layout: &Layout, pairs: u32, outcome: &Outcome) -> Result<Self, HostError> {
        let memory = Contacts::new(layout, &outcome.lines);
        if layout.number_bits() > 0 {
            let (records, error) = Self::hits(&memory, pairs as usize, outcome.contacts);
            return error.map_or(Ok(records), |error| Err(error.into()));
        }
        let numbers: Vec<u32> = (0..pairs).collect();
        let unwritten = |number: usize| HostError::Unwritten(memory.line(number) as u64);
        let contact = |number: usize| memory.get(number).ok_or_else(|| unwritten(number));
        Ok(Self { contacts: (0..pairs as usize).map(contact).collect::<Result<_, _>>()?, numbers })
    }

    /// The `count` records of the pairs that touch, in the order of their numbers. If one is wrong, the records before
    /// it.
    pub(crate) fn hits(memory: &Contacts<'_>, pairs: usize, count: u32) -> (Self, Option<HitError>) {
        let mut records = Self::default();
        for index in 0..count as usize {
            let Some((number, contact)) = memory.hit(index) else {
                return (records, Some(HitError::Unwritten { index, count }));
            };
            let after = records.numbers.last().copied();
            if after >= Some(number) || number as usize >= pairs {
                return (records, Some(HitError::Number { index, number, after, pairs }));
            }
            records.numbers.push(number);
            records.contacts.push(contact);
        }
        (records, None)
    }
}

/// One contact for each of this number of pairs, in order; a pair without a record has no contact.
pub(crate) fn by_pair(pairs: usize, numbers: &[u32], contacts: &[ContactRecord]) -> Vec<ContactRecord> {
    let apart = ContactRecord::of_flags(Flow::Fake.flags());
    let mut all = vec![apart; pairs];
    for (&number, &contact) in numbers.iter().zip(contacts) {
        if let Some(place) = all.get_mut(number as usize) {
            *place = contact;
        }
    }
    all
}
