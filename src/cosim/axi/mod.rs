//! A simulated board: a Verilated `contact_afu_axi` between an AXI4 memory and a host's AXI4-Lite master.
//!
//! A host sees a [`Machine`]: registers, memory, an interrupt and time. The module [`host`](crate::host) uses it as a
//! [`Transport`](crate::host::Transport). Every cycle is checked against the rules of AXI4 and AXI4-Lite.

mod error;
mod ports;

pub use error::MachineError;

use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::instance::{Clock, Instance};
use crate::link::LinkModel;
use crate::link::axi::{AxiError, AxiMemory, AxiModel, FromMemory, Handshake, LiteMaster, LiteMonitor, LiteSlave};
use ports::Ports;

/// Cycles for which the reset is held.
const RESET_CYCLES: u64 = 16;
/// Cycles of a reset after which no VALID may be high.
const SETTLED_CYCLES: u64 = 3;
/// Cycles after which an access of a register has failed.
const ACCESS_CYCLES: u64 = 10_000;
/// All bytes of a register.
const ALL_BYTES: u8 = 0xF;

/// A host's view of the AFU behind AXI4.
#[derive(Debug)]
pub struct Machine<'a> {
    clock: Clock<'a>,
    ports: Ports<'a>,
    memory: AxiMemory,
    monitor: LiteMonitor,
    host: LiteMaster,
    random: Xoshiro256PlusPlus,
    /// True if the host takes responses, and puts out address and data, when it likes.
    pub hesitates: bool,
    cycle: u64,
    /// The cycle of the AFU's last access of memory, or the last response to one.
    last_work: u64,
}

impl<'a> Machine<'a> {
    /// Takes the ports of `afu`, a module with the `axi` shell's ports, connects the memory of `link`, and resets both.
    ///
    /// # Errors
    /// Returns an error if a port is missing, if `link` has an invalid value, or if the module stops the simulation.
    pub fn new(afu: &'a Instance, link: LinkModel, handshake: Handshake, seed: u64) -> Result<Self, MachineError> {
        let (clock, ports) = (afu.clock("ap_clk")?, Ports::new(afu)?);
        let model = AxiModel { bus: ports.bus, handshake };
        let memory = AxiMemory::new(model, link, seed)?;
        let mut machine = Self {
            clock,
            ports,
            memory,
            monitor: LiteMonitor::default(),
            host: LiteMaster::default(),
            random: Xoshiro256PlusPlus::seed_from_u64(seed ^ 0x71_7E),
            hesitates: false,
            cycle: 0,
            last_work: 0,
        };
        machine.system_reset()?;
        Ok(machine)
    }

    /// Resets the AFU and the interconnect: both forget what was asked for, and memory keeps its content.
    ///
    /// # Errors
    /// Returns an error if a VALID of the AFU stays high, or if the module stops the simulation.
    pub fn system_reset(&mut self) -> Result<(), MachineError> {
        self.ports.reset(true);
        self.host = LiteMaster::default();
        for cycle in 0..RESET_CYCLES {
            let settled = cycle >= SETTLED_CYCLES;
            let result = self
                .memory
                .reset(&self.ports.to_memory(), settled)
                .and_then(|()| self.monitor.reset(&self.ports.to_host(), settled));
            self.checked(result)?;
            self.ports.drive_memory(&FromMemory::default());
            self.ports.drive_host(&self.host);
            self.tick()?;
        }
        self.ports.reset(false);
        Ok(())
    }

    /// The host writes the first word of a register.
    ///
    /// # Errors
    /// Returns an error if there is no response, and the errors of [`Machine::advance`].
    pub fn write_register(&mut self, offset: u32, value: u32) -> Result<(), MachineError> {
        self.write_bytes(offset, value, ALL_BYTES)
    }

    /// The host writes those bytes of a register that have a bit in `strobes`.
    ///
    /// # Errors
    /// Returns the errors of [`Machine::write_register`].
    pub fn write_bytes(&mut self, offset: u32, value: u32, strobes: u8) -> Result<(), MachineError> {
        let (mut address, mut data) = (Some(offset), Some((value, strobes)));
        for _ in 0..ACCESS_CYCLES {
            // A VALID stays; the other one may come later.
            if self.host.aw.is_none() && self.likes() {
                self.host.aw = address;
            }
            if self.host.w.is_none() && self.likes() {
                self.host.w = data;
            }
            self.host.b_ready = self.likes();
            let (host, afu) = self.one_cycle()?;
            if host.aw.is_some() && afu.aw_ready {
                (address, self.host.aw) = (None, None);
            }
            if host.w.is_some() && afu.w_ready {
                (data, self.host.w) = (None, None);
            }
            if host.b_ready && afu.b.is_some() {
                self.host = LiteMaster::default();
                return Ok(());
            }
        }
        Err(MachineError::NoResponse { what: "write", offset, cycles: ACCESS_CYCLES })
    }

    /// The host reads a word.
    ///
    /// # Errors
    /// Returns an error if there is no response, and the errors of [`Machine::advance`].
    pub fn read_register(&mut self, offset: u32) -> Result<u32, MachineError> {
        let mut address = Some(offset);
        for _ in 0..ACCESS_CYCLES {
            if self.host.ar.is_none() && self.likes() {
                self.host.ar = address;
            }
            self.host.r_ready = self.likes();
            let (host, afu) = self.one_cycle()?;
            if host.ar.is_some() && afu.ar_ready {
                (address, self.host.ar) = (None, None);
            }
            if let Some((value, _)) = afu.r.filter(|_| host.r_ready) {
                self.host = LiteMaster::default();
                return Ok(value);
            }
        }
        Err(MachineError::NoResponse { what: "read", offset, cycles: ACCESS_CYCLES })
    }

    /// True if the host does something in this cycle.
    fn likes(&mut self) -> bool {
        !self.hesitates || self.random.next_u64() & 1 == 0
    }

    /// Runs the clock.
    ///
    /// # Errors
    /// Returns an error if the AFU breaks a rule of AXI4 or AXI4-Lite, or stops the simulation.
    pub fn advance(&mut self, cycles: u64) -> Result<(), MachineError> {
        for _ in 0..cycles {
            self.one_cycle()?;
        }
        Ok(())
    }

    /// One cycle. Returns what host and AFU drove on AXI4-Lite.
    fn one_cycle(&mut self) -> Result<(LiteMaster, LiteSlave), MachineError> {
        let (to_memory, to_host) = (self.ports.to_memory(), self.ports.to_host());
        let host = self.host;
        let result = self.monitor.check(&host, &to_host).and_then(|()| self.memory.cycle(&to_memory));
        let from_memory = self.checked(result)?;
        let asks = to_memory.aw.is_some() || to_memory.w.is_some() || to_memory.ar.is_some();
        if asks || from_memory.b.is_some() || from_memory.r.is_some() {
            self.last_work = self.cycle;
        }
        self.ports.drive_memory(&from_memory);
        self.ports.drive_host(&host);
        self.tick()?;
        Ok((host, to_host))
    }

    fn checked<T>(&self, result: Result<T, AxiError>) -> Result<T, MachineError> {
        result.map_err(|what| MachineError::Protocol { cycle: self.cycle, what })
    }

    fn tick(&mut self) -> Result<(), MachineError> {
        self.clock.tick(1)?;
        self.cycle += 1;
        Ok(())
    }

    /// True while the port `interrupt` is high.
    pub fn interrupt(&self) -> bool {
        self.ports.interrupt()
    }

    /// The cycle of the AFU's last access of memory, or the last response to one.
    pub(crate) fn last_work(&self) -> u64 {
        self.last_work
    }

    /// Cycles so far.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The memory.
    pub fn memory(&self) -> &AxiMemory {
        &self.memory
    }

    /// The memory, to plant faults.
    pub fn memory_mut(&mut self) -> &mut AxiMemory {
        &mut self.memory
    }
}
