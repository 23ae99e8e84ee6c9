//! The Verilated AFU behind AXI4 as a device.

use std::ops::Range;

use super::error::HostError;
use super::handshake::Protocol;
use super::transport::{Transport, TransportError};
use crate::cosim::axi::{Machine, MachineError};
use crate::link::spl2::Limits;
use crate::link::{Line, LinkModel, Traffic};
use crate::patience::{self, Patience, Work};
use crate::record::Capability;

impl From<MachineError> for TransportError {
    fn from(error: MachineError) -> Self {
        match error {
            MachineError::Protocol { cycle, what } => Self::Axi { cycle, what },
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
        Ok(self.write_register(byte_offset, value)?)
    }

    fn read_csr(&mut self, byte_offset: u32) -> Result<u32, TransportError> {
        Ok(self.read_register(byte_offset)?)
    }

    fn protocol(&self) -> Protocol {
        Protocol::Axi
    }

    fn line(&self, at: u64) -> Option<Line> {
        self.memory().link().memory.get(at).copied()
    }

    fn put(&mut self, at: u64, line: &Line) {
        self.memory_mut().link_mut().memory.set(at, line);
    }

    fn forget(&mut self, lines: Range<u64>) {
        self.memory_mut().link_mut().memory.forget(lines);
    }

    fn interrupt(&self) -> bool {
        Machine::interrupt(self)
    }

    fn advance(&mut self, cycles: u64) -> Result<(), TransportError> {
        Ok(Machine::advance(self, cycles)?)
    }

    fn cycle(&self) -> u64 {
        Machine::cycle(self)
    }

    fn limit(&mut self, limits: Option<Limits>) {
        if let Some(Limits { reads, results, .. }) = limits {
            self.memory_mut().guard(reads.first().cloned().unwrap_or_default(), results);
        }
    }

    fn sent(&self, line: u64) -> Option<u64> {
        self.memory().sent(line)
    }

    fn last_work(&self) -> u64 {
        Machine::last_work(self)
    }

    fn link(&self) -> &LinkModel {
        self.memory().link().model()
    }

    fn patience(&self, afu: &Capability, work: &Work) -> Patience {
        let (reads, writes) = self.memory().stalls();
        patience::axi(afu, Transport::link(self), &reads, &writes, work)
    }

    fn traffic(&self) -> Traffic {
        self.memory().link().traffic()
    }
}
