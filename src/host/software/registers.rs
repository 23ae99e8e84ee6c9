//! The registers of the shell `axi`. A job has ended as soon as it is started.

use std::collections::HashMap;

use super::jobs::Counted;
use crate::afu::shell::axi::map::{self, Access, Register};
use crate::config::Input;
use crate::host::task::Task;
use crate::link::LINE_BYTES;

/// The registers, as a host sees them.
#[derive(Debug)]
pub(super) struct Registers {
    input: Input,
    capability: u64,
    /// What was written to registers that keep it, by offset.
    kept: HashMap<u32, u32>,
    /// A job has ended since the last read of the control register.
    has_ended: bool,
    /// Recorded events.
    events: u32,
    jobs: u32,
    last: Option<Counted>,
}

impl Registers {
    pub(super) fn new(input: Input, capability: u64) -> Self {
        Self { input, capability, kept: HashMap::new(), has_ended: false, events: 0, jobs: 0, last: None }
    }

    /// The register that has a word at this offset, and the number of that word.
    fn at(&self, offset: u32) -> Option<(Register, u32)> {
        let has = |register: &Register| (register.offset..register.offset + 4 * register.words).contains(&offset);
        let register = map::registers(self.input).find(has)?;
        Some((register, (offset - register.offset) / 4))
    }

    fn kept(&self, register: Register, word: u32) -> u32 {
        self.kept.get(&(register.offset + 4 * word)).copied().unwrap_or(0)
    }

    fn line(&self, register: Register) -> u64 {
        (u64::from(self.kept(register, 1)) << 32 | u64::from(self.kept(register, 0))) / LINE_BYTES
    }

    /// Writes a word. Returns the source line, the destination line and the job, if that starts one.
    pub(super) fn write(&mut self, offset: u32, value: u32) -> Option<(u64, u64, Task)> {
        let (register, _) = self.at(offset)?;
        match register.offset {
            at if at == map::CONTROL.offset => return (map::START.get(value) == 1).then(|| self.job()),
            at if at == map::INTERRUPT_STATUS.offset => self.events ^= value & events(),
            at if at == map::SOFT_RESET.offset => {}
            _ if register.access == Access::ReadWrite => {
                let bits = register.fields.iter().fold(0, |bits, field| bits | field.put(u32::MAX));
                let bits = if register.fields.is_empty() { u32::MAX } else { bits };
                self.kept.insert(offset, value & bits);
            }
            _ => {}
        }
        None
    }

    fn job(&mut self) -> (u64, u64, Task) {
        self.jobs = self.jobs.wrapping_add(1);
        let task = Task {
            input: self.input,
            count: self.kept(map::COUNT, 0),
            others: self.kept(map::OTHERS, 0),
            mode: self.kept(map::MODE, 0),
            destination_lines: self.kept(map::DESTINATION_LINES, 0).into(),
            ..Task::default()
        };
        (self.line(map::SOURCE), self.line(map::DESTINATION), task)
    }

    /// The job that was started has ended.
    pub(super) fn end(&mut self, ended: Counted) {
        self.last = Some(ended);
        self.has_ended = true;
        self.events |= self.kept(map::INTERRUPT_ENABLE, 0) & events();
    }

    /// Reads a word.
    pub(super) fn read(&mut self, offset: u32) -> u32 {
        let Some((register, word)) = self.at(offset) else { return 0 };
        let of_last = |value: fn(&Counted) -> u32| self.last.as_ref().map_or(0, value);
        let wide = |value: u128| (value >> (32 * word)) as u32;
        match register.offset {
            at if at == map::CONTROL.offset => {
                let ended = u32::from(std::mem::take(&mut self.has_ended));
                map::IDLE.put(1) | map::DONE.put(ended) | map::READY.put(ended)
            }
            at if at == map::INTERRUPT_STATUS.offset => self.events,
            at if at == map::STATUS.offset => {
                map::ENDED.put(self.last.is_some().into()) | map::ERROR.put(of_last(|last| last.error.into()))
            }
            at if at == map::CONTACTS.offset => of_last(|last| last.contacts),
            at if at == map::CANDIDATES.offset => of_last(|last| last.candidates),
            at if at == map::INVALID.offset => of_last(|last| last.invalid),
            at if at == map::FIRST_INVALID.offset => self.last.as_ref().map_or(u32::MAX, |last| last.first_invalid),
            at if at == map::JOBS.offset => self.jobs,
            at if at == map::IDENTITY.offset => wide(map::AFU_ID),
            at if at == map::MAP_VERSION.offset => map::VERSION,
            at if at == map::CAPABILITY.offset => wide(self.capability.into()),
            _ => self.kept(register, word),
        }
    }

    pub(super) fn interrupt(&self) -> bool {
        map::ENABLE.get(self.kept(map::GLOBAL_INTERRUPT_ENABLE, 0)) == 1 && self.events != 0
    }
}

/// The bits of the events.
fn events() -> u32 {
    map::DONE_EVENT.put(1) | map::READY_EVENT.put(1)
}
