//! A device on a board, behind AXI4: what a driver must provide, and the transport that makes of it what a session
//! takes. `examples/uio.rs` is such a driver.

use std::io;
use std::ops::Range;
use std::time::{Duration, Instant};

use super::handshake::Protocol;
use super::transport::{Transport, TransportError};
use crate::afu::shell::axi::map;
use crate::link::{LINE_BYTES, Line, LinkModel};
use crate::patience::{self, Patience, Work};
use crate::record::Capability;

/// The least time for which a wait sleeps, if nothing happens.
const NAP: Duration = Duration::from_micros(100);
/// Time that a host may lose to others, beside what the device takes.
const SLACK: Duration = Duration::from_secs(1);

/// An accelerator with the shell `axi` on a board, as its driver sees it.
///
/// The buffer is memory that host and device both see, without caches between them: what one has written, the other
/// reads. A driver whose buffer is cached must flush and invalidate in [`write_line`](Self::write_line) and
/// [`read_line`](Self::read_line).
pub trait Device {
    /// Reads the 32-bit register at a byte offset of the AXI4-Lite slave.
    ///
    /// # Errors
    /// Returns the error of the system.
    fn read_register(&self, offset: u32) -> io::Result<u32>;

    /// Writes the 32-bit register at a byte offset. The write has arrived when this returns.
    ///
    /// # Errors
    /// Returns the error of the system.
    fn write_register(&mut self, offset: u32, value: u32) -> io::Result<()>;

    /// The bytes of the buffer, at the addresses that the device puts out.
    fn buffer(&self) -> Range<u64>;

    /// Reads the line at this offset in the buffer, a multiple of 64 bytes.
    fn read_line(&self, offset: u64) -> Line;

    /// Writes the line at this offset in the buffer, a multiple of 64 bytes.
    fn write_line(&mut self, offset: u64, line: &Line);

    /// Sleeps until the device raises its interrupt, and for this time at most. It may return early.
    ///
    /// # Errors
    /// Returns the error of the system.
    fn wait(&mut self, at_most: Duration) -> io::Result<()>;
}

/// A [`Device`] as a [`Transport`]. Its cycles are those of the host's clock, counted at the device's frequency.
#[derive(Debug)]
pub struct Hardware<D> {
    device: D,
    link: LinkModel,
    clock_mhz: f64,
    begun: Instant,
}

impl<D: Device> Hardware<D> {
    /// A device that runs at this clock. The link's model only says how long the host is patient.
    pub fn new(device: D, link: LinkModel, clock_mhz: f64) -> Self {
        Self { device, link, clock_mhz, begun: Instant::now() }
    }

    /// The driver.
    pub fn device(&self) -> &D {
        &self.device
    }

    fn cycles(&self, time: Duration) -> u64 {
        (time.as_secs_f64() * 1e6 * self.clock_mhz) as u64
    }

    /// The offset of a line in the buffer; `None` if it is not in it.
    fn offset(&self, line: u64) -> Option<u64> {
        let (buffer, address) = (self.device.buffer(), line.checked_mul(LINE_BYTES)?);
        let is_inside = address >= buffer.start && address.checked_add(LINE_BYTES)? <= buffer.end;
        is_inside.then(|| address - buffer.start)
    }
}

fn failed(what: &str, offset: u32, error: &io::Error) -> TransportError {
    TransportError::Device(format!("{what} register {offset:#04x}: {error}"))
}

impl<D: Device> Transport for Hardware<D> {
    fn write_csr(&mut self, byte_offset: u32, value: u32) -> Result<(), TransportError> {
        self.device.write_register(byte_offset, value).map_err(|error| failed("writing", byte_offset, &error))
    }

    fn read_csr(&mut self, byte_offset: u32) -> Result<u32, TransportError> {
        self.device.read_register(byte_offset).map_err(|error| failed("reading", byte_offset, &error))
    }

    fn protocol(&self) -> Protocol {
        Protocol::Axi
    }

    fn line(&self, at: u64) -> Option<Line> {
        self.offset(at).map(|offset| self.device.read_line(offset))
    }

    fn put(&mut self, at: u64, line: &Line) {
        if let Some(offset) = self.offset(at) {
            self.device.write_line(offset, line);
        }
    }

    /// By the register, which says it whether or not the system delivers interrupts.
    fn interrupt(&self) -> bool {
        self.device.read_register(map::INTERRUPT_STATUS.offset).is_ok_and(|events| events != 0)
    }

    fn advance(&mut self, cycles: u64) -> Result<(), TransportError> {
        let time = Duration::from_secs_f64(cycles as f64 / (1e6 * self.clock_mhz));
        let waited = self.device.wait(time.max(NAP));
        waited.map_err(|error| TransportError::Device(format!("waiting for the interrupt: {error}")))
    }

    fn cycle(&self) -> u64 {
        self.cycles(self.begun.elapsed())
    }

    fn link(&self) -> &LinkModel {
        &self.link
    }

    fn patience(&self, afu: &Capability, work: &Work) -> Patience {
        let Patience { whole, quiet } = patience::axi(afu, &self.link, &[], &[], work);
        let slack = self.cycles(SLACK);
        Patience { whole: whole.saturating_add(slack), quiet: quiet.saturating_add(slack) }
    }
}
