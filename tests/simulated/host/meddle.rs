//! Devices that are disturbed during a transaction.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

use contact_afu::host::{Transport, TransportError};
use contact_afu::link::spl2::DeviceWrite;
use contact_afu::link::{Line, LinkModel, Traffic};

/// A device, and a change that is applied to it whenever time has passed.
pub struct Meddled<T> {
    pub device: T,
    pub meddle: Box<dyn FnMut(&mut T)>,
    /// CSR writes: offset and value.
    pub csrs: Rc<RefCell<Vec<(u32, u32)>>>,
}

impl<T> Meddled<T> {
    pub fn new(device: T, meddle: impl FnMut(&mut T) + 'static) -> Self {
        Self { device, meddle: Box::new(meddle), csrs: Rc::default() }
    }
}

impl<T: Transport> Transport for Meddled<T> {
    fn write_csr(&mut self, byte_offset: u32, value: u32) -> Result<(), TransportError> {
        self.csrs.borrow_mut().push((byte_offset, value));
        let done = self.device.write_csr(byte_offset, value);
        (self.meddle)(&mut self.device);
        done
    }

    fn advance(&mut self, cycles: u64) -> Result<(), TransportError> {
        let done = self.device.advance(cycles);
        (self.meddle)(&mut self.device);
        done
    }

    fn line(&self, at: u64) -> Option<Line> {
        self.device.line(at)
    }

    fn put(&mut self, at: u64, line: &Line) {
        self.device.put(at, line);
    }

    fn forget(&mut self, lines: Range<u64>) {
        self.device.forget(lines);
    }

    fn cycle(&self) -> u64 {
        self.device.cycle()
    }

    fn watch(&mut self, lines: Range<u64>) {
        self.device.watch(lines);
    }

    fn device_writes(&self) -> &[DeviceWrite] {
        self.device.device_writes()
    }

    fn link(&self) -> &LinkModel {
        self.device.link()
    }

    fn traffic(&self) -> Traffic {
        self.device.traffic()
    }
}

/// A device that dies: after some CSR writes, time passes without any effect.
pub struct Dying<T> {
    pub device: T,
    /// The number of CSR writes that still have an effect.
    pub left: usize,
    pub cycles: u64,
}

impl<T: Transport> Transport for Dying<T> {
    fn write_csr(&mut self, byte_offset: u32, value: u32) -> Result<(), TransportError> {
        self.cycles += 1;
        if self.left == 0 {
            return Ok(());
        }
        self.left -= 1;
        self.device.write_csr(byte_offset, value)
    }

    fn advance(&mut self, cycles: u64) -> Result<(), TransportError> {
        self.cycles += cycles;
        if self.left == 0 { Ok(()) } else { self.device.advance(cycles) }
    }

    fn line(&self, at: u64) -> Option<Line> {
        self.device.line(at)
    }

    fn put(&mut self, at: u64, line: &Line) {
        self.device.put(at, line);
    }

    fn forget(&mut self, lines: Range<u64>) {
        self.device.forget(lines);
    }

    fn cycle(&self) -> u64 {
        self.cycles
    }

    fn watch(&mut self, lines: Range<u64>) {
        self.device.watch(lines);
    }

    fn device_writes(&self) -> &[DeviceWrite] {
        self.device.device_writes()
    }

    fn link(&self) -> &LinkModel {
        self.device.link()
    }

    fn traffic(&self) -> Traffic {
        self.device.traffic()
    }
}
