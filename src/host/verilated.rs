//! The Verilated AFU below SPL2 as a device.

use std::ops::Range;

use super::error::HostError;
use super::transport::{Transport, TransportError};
use crate::cosim::spl2::{Machine, MachineError};
use crate::link::spl2::{DeviceWrite, Limits, Spl2Error, Spl2Model};
use crate::link::{Line, LinkModel, Traffic};

impl From<MachineError> for TransportError {
    fn from(error: MachineError) -> Self {
        match error {
            MachineError::Protocol { what: Spl2Error::PageFault { what, line }, .. } => Self::PageFault { what, line },
            MachineError::Protocol { cycle, what } => Self::Protocol { cycle, what },
            error => Self::Device(error.to_string()),
        }
    }
}

impl From<MachineError> for HostError {
    fn from(error: MachineError) -> Self {
        Self::Transport(error.into())
    }
}

impl Transport for Machine<'_> {
    fn write_csr(&mut self, byte_offset: u32, value: u32) -> Result<(), TransportError> {
        Ok(Machine::write_csr(self, byte_offset, value)?)
    }

    fn line(&self, at: u64) -> Option<Line> {
        self.memory().get(at).copied()
    }

    fn put(&mut self, at: u64, line: &Line) {
        self.memory_mut().set(at, line);
    }

    fn forget(&mut self, lines: Range<u64>) {
        self.memory_mut().forget(lines);
    }

    fn advance(&mut self, cycles: u64) -> Result<(), TransportError> {
        Ok(Machine::advance(self, cycles)?)
    }

    fn cycle(&self) -> u64 {
        Machine::cycle(self)
    }

    fn watch(&mut self, lines: Range<u64>) {
        self.spl_mut().watch(lines);
    }

    fn device_writes(&self) -> &[DeviceWrite] {
        self.spl().log()
    }

    fn limit(&mut self, limits: Option<Limits>) {
        self.spl_mut().limit(limits);
    }

    fn sent(&self, virtual_line: u64) -> Option<u64> {
        self.spl().written(virtual_line)
    }

    fn last_work(&self) -> u64 {
        Machine::last_work(self)
    }

    fn link(&self) -> &LinkModel {
        self.spl().link().model()
    }

    fn spl2(&self) -> Spl2Model {
        *self.spl().model()
    }

    fn traffic(&self) -> Traffic {
        self.spl().link().traffic()
    }
}
