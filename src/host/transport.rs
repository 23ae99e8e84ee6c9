//! The interface between a host and a device, with the memory that they share.

use std::ops::Range;

use super::handshake::Protocol;
#[cfg(feature = "cosim")]
use crate::link::axi::AxiError;
use crate::link::spl2::{DeviceWrite, Limits, Spl2Error, Spl2Model};
use crate::link::{Line, LinkModel, Traffic};
use crate::patience::{self, Patience, Work};
use crate::record::Capability;

/// A device, with the memory that it shares with the host.
pub trait Transport {
    /// Writes a 32-bit CSR of SPL or the AFU. The write has arrived when this returns.
    ///
    /// # Errors
    /// Returns the device's protocol errors since then.
    fn write_csr(&mut self, byte_offset: u32, value: u32) -> Result<(), TransportError>;

    /// Reads a 32-bit register of the AFU.
    ///
    /// # Errors
    /// Returns an error if the device has no register that can be read, and the device's protocol errors since then.
    fn read_csr(&mut self, byte_offset: u32) -> Result<u32, TransportError> {
        Err(TransportError::Device(format!("register {byte_offset:#x} cannot be read")))
    }

    /// The registers of the device.
    fn protocol(&self) -> Protocol {
        Protocol::Spl2
    }

    /// A line of physical memory; `None` if it is known that it was never written.
    fn line(&self, at: u64) -> Option<Line>;

    /// Writes a line of physical memory.
    fn put(&mut self, at: u64, line: &Line);

    /// Forgets lines of physical memory, so that the device must write them. On real memory there is nothing to do.
    fn forget(&mut self, _lines: Range<u64>) {}

    /// True while the device raises its interrupt.
    fn interrupt(&self) -> bool {
        false
    }

    /// Advances the device by this number of clock cycles.
    ///
    /// # Errors
    /// Returns the device's protocol errors since then.
    fn advance(&mut self, cycles: u64) -> Result<(), TransportError>;

    /// Cycles so far.
    fn cycle(&self) -> u64;

    /// From now on the device's writes to these physical lines are logged.
    fn watch(&mut self, _lines: Range<u64>) {}

    /// The device's writes to watched lines, in the order in which they arrived.
    fn device_writes(&self) -> &[DeviceWrite] {
        &[]
    }

    /// Restricts the device to the lines of a job, or lifts the restriction. A simulated device fails if it accesses
    /// another line. A device that nobody can observe ignores this.
    fn limit(&mut self, _limits: Option<Limits>) {}

    /// The cycle in which the device sent a result line of the limited job. `None` if it did not, or cannot be
    /// observed.
    fn sent(&self, _virtual_line: u64) -> Option<u64> {
        None
    }

    /// The cycle of the device's last request that was not a poll. A device that cannot be observed is never idle.
    fn last_work(&self) -> u64 {
        self.cycle()
    }

    /// The link between device and memory.
    fn link(&self) -> &LinkModel;

    /// The model of SPL2, which is between device and link.
    fn spl2(&self) -> Spl2Model {
        Spl2Model::default()
    }

    /// The cycles that a job may take on the device that reports this capability.
    fn patience(&self, afu: &Capability, work: &Work) -> Patience {
        patience::spl2(afu, self.link(), &self.spl2(), work)
    }

    /// The traffic so far. A device that cannot be observed has none.
    fn traffic(&self) -> Traffic {
        Traffic::default()
    }
}

/// A protocol error of a device, or of the host that drives it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TransportError {
    /// The page table has no page for the address.
    #[error(
        "page fault: a {what} of virtual line {line:#x}, which no page of the workspace holds; end the transaction: the next one begins with a new page table"
    )]
    PageFault {
        /// Read or write.
        what: &'static str,
        /// The virtual line address.
        line: u64,
    },
    /// The device broke the protocol of its port.
    #[error("protocol broken in cycle {cycle}: {what}")]
    Protocol {
        /// The cycle, counted from the start of the device.
        cycle: u64,
        /// The error.
        what: Spl2Error,
    },
    /// A simulated device broke a rule of AXI4 or AXI4-Lite.
    #[cfg(feature = "cosim")]
    #[error("protocol broken in cycle {cycle}: {what}")]
    Axi {
        /// The cycle, counted from the start of the device.
        cycle: u64,
        /// The rule.
        what: AxiError,
    },
    /// Another error.
    #[error("the device: {0}")]
    Device(String),
}
