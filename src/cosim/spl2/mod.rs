//! The simulated HARP v1: a Verilated `afu_top` below SPL2 over a link to memory.
//!
//! A host sees a [`Machine`]: CSR writes, memory and time. The module [`host`](crate::host) uses it as a
//! [`Transport`](crate::host::Transport).

mod error;
mod ports;

pub use error::MachineError;

use super::instance::{Clock, Instance};
use crate::link::Memory;
use crate::link::spl2::{Header, Spl2, Transmit};
use ports::Ports;

/// Cycles for which the system's reset is held.
const RESET_CYCLES: u64 = 4;

/// A host's view of the AFU below SPL2.
#[derive(Debug)]
pub struct Machine<'a> {
    clock: Clock<'a>,
    ports: Ports<'a>,
    spl: Spl2,
    cycle: u64,
    /// The line that the AFU read last.
    last_read: Option<u64>,
    /// The cycle of its last request that was not a poll.
    last_work: u64,
}

impl<'a> Machine<'a> {
    /// Takes the ports of `afu`, a module with the `spl2` shell's ports, and resets the system.
    ///
    /// # Errors
    /// Returns an error if a port is missing, or if the module stops the simulation.
    pub fn new(afu: &'a Instance, spl: Spl2) -> Result<Self, MachineError> {
        let (clock, ports) = (afu.clock("clk")?, Ports::new(afu)?);
        let mut machine = Self { clock, ports, spl, cycle: 0, last_read: None, last_work: 0 };
        machine.system_reset()?;
        Ok(machine)
    }

    /// The system's reset: the AFU and SPL lose their state, and memory keeps its content.
    ///
    /// # Errors
    /// Returns an error if the module stops the simulation.
    pub fn system_reset(&mut self) -> Result<(), MachineError> {
        self.ports.system_reset(true);
        for _ in 0..RESET_CYCLES {
            self.spl.system_reset();
            self.one_cycle(&Transmit::default())?;
        }
        self.ports.system_reset(false);
        Ok(())
    }

    /// The host writes a 32-bit CSR. This takes [`Spl2Model::csr_cycles`](crate::link::spl2::Spl2Model).
    ///
    /// # Errors
    /// Returns the errors of [`Machine::advance`].
    pub fn write_csr(&mut self, byte_offset: u32, value: u32) -> Result<(), MachineError> {
        self.spl.write_csr(byte_offset, value);
        self.advance(u64::from(self.spl.model().csr_cycles).max(1))
    }

    /// Runs the clock.
    ///
    /// # Errors
    /// Returns an error if the AFU breaks the port's protocol, or stops the simulation.
    pub fn advance(&mut self, cycles: u64) -> Result<(), MachineError> {
        for _ in 0..cycles {
            let transmit = self.ports.transmit();
            self.one_cycle(&transmit)?;
        }
        Ok(())
    }

    fn one_cycle(&mut self, transmit: &Transmit) -> Result<(), MachineError> {
        let received = self.spl.cycle(transmit);
        let receive = received.map_err(|what| MachineError::Protocol { cycle: self.cycle, what })?;
        self.note(transmit);
        self.ports.receive(&receive);
        self.clock.tick(1)?;
        self.cycle += 1;
        Ok(())
    }

    /// Takes note of a request. A poll is a read of the same line as the read before it.
    fn note(&mut self, transmit: &Transmit) {
        let line = transmit.read.map(|header| Header::from_bits(header).line);
        if transmit.write.is_some() || line.is_some_and(|line| self.last_read.replace(line) != Some(line)) {
            self.last_work = self.cycle;
        }
    }

    /// The cycle of the AFU's last request that was not a poll: a write, or a read of another line than the last.
    pub(crate) fn last_work(&self) -> u64 {
        self.last_work
    }

    /// Cycles so far.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// SPL2 and the link below.
    pub fn spl(&self) -> &Spl2 {
        &self.spl
    }

    /// Physical memory.
    pub fn memory(&self) -> &Memory {
        &self.spl.link().memory
    }

    /// Physical memory, writable.
    pub fn memory_mut(&mut self) -> &mut Memory {
        &mut self.spl.link_mut().memory
    }

    /// SPL2 and the link below, to plant faults, watch lines and set limits.
    pub fn spl_mut(&mut self) -> &mut Spl2 {
        &mut self.spl
    }
}
