//! One module with its state.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_int};
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::ptr::NonNull;
use std::slice;

use super::abi::{Api, raw};
use super::error::SimulationError;
use super::port::Port;
use crate::files::Aside;

/// A simulated module. Its ports are memory ([`Port`]), and [`Clock::tick`] is its clock.
///
/// It may move between threads, but only one thread may use it at a time.
#[derive(Debug)]
pub struct Instance {
    api: Api,
    handle: NonNull<raw::afu_instance>,
    /// The waveform that is being written.
    waveform: RefCell<Option<Waveform>>,
}

/// A waveform that is being written, under a temporary name.
#[derive(Debug)]
struct Waveform {
    path: PathBuf,
    aside: Aside,
}

// SAFETY: an instance has its own VerilatedContext and refers to nothing of the thread that made it. It is not Sync,
// and its ports borrow it.
unsafe impl Send for Instance {}

/// The module's clock input.
#[derive(Clone, Copy, Debug)]
pub struct Clock<'a> {
    instance: &'a Instance,
    index: u32,
}

impl Instance {
    pub(super) fn new(api: Api, seed: u64) -> Result<Self, SimulationError> {
        // SAFETY: a function of a loaded model, which takes any seed.
        let handle = NonNull::new(unsafe { (api.create)(seed) });
        let handle = handle.ok_or_else(|| SimulationError::Stopped(message(api, std::ptr::null_mut())))?;
        Ok(Self { api, handle, waveform: RefCell::new(None) })
    }

    fn ports(&self) -> &[raw::afu_port] {
        let mut count = 0;
        // SAFETY: the handle is live; the list is owned by the instance and does not change.
        unsafe {
            let first = (self.api.ports)(self.handle.as_ptr(), &mut count);
            if first.is_null() { &[] } else { slice::from_raw_parts(first, count as usize) }
        }
    }

    /// Names and widths of all ports: (name, bits, true for an input).
    pub fn port_list(&self) -> Vec<(String, u32, bool)> {
        let entry = |port: &raw::afu_port| (name_of(port), port.bits, port.direction == raw::AFU_INPUT);
        self.ports().iter().map(entry).collect()
    }

    /// True if there is a port of this name.
    pub fn has_port(&self, name: &str) -> bool {
        self.ports().iter().any(|port| name_of(port) == name)
    }

    fn find(&self, name: &str, bits: u32, direction: u32) -> Result<(u32, &raw::afu_port), SimulationError> {
        let text = |bits: u32, direction: u32| {
            format!("an {} of {bits} bits", if direction == raw::AFU_INPUT { "input" } else { "output" })
        };
        let fail =
            |found: String| SimulationError::Port { name: name.to_owned(), expected: text(bits, direction), found };
        let mut all = (0..).zip(self.ports());
        let (index, port) =
            all.find(|(_, port)| name_of(port) == name).ok_or_else(|| fail("no such port".to_owned()))?;
        if (port.bits, port.direction) != (bits, direction) {
            return Err(fail(text(port.bits, port.direction)));
        }
        Ok((index, port))
    }

    fn port(&self, name: &str, bits: u32, direction: u32) -> Result<Port<'_>, SimulationError> {
        let (_, port) = self.find(name, bits, direction)?;
        // SAFETY: address and width come from the harness. The memory lives as long as the instance, which is not Sync
        // and which the port borrows.
        Ok(unsafe { Port::new(port.address, bits) })
    }

    /// The input `name` of `bits` bits.
    ///
    /// # Errors
    /// Returns an error if there is no such input.
    pub fn input(&self, name: &str, bits: u32) -> Result<Port<'_>, SimulationError> {
        self.port(name, bits, raw::AFU_INPUT)
    }

    /// The output `name` of `bits` bits.
    ///
    /// # Errors
    /// Returns an error if there is no such output.
    pub fn output(&self, name: &str, bits: u32) -> Result<Port<'_>, SimulationError> {
        self.port(name, bits, raw::AFU_OUTPUT)
    }

    /// The clock input `name`.
    ///
    /// # Errors
    /// Returns an error if there is no such input of one bit.
    pub fn clock(&self, name: &str) -> Result<Clock<'_>, SimulationError> {
        self.find(name, 1, raw::AFU_INPUT).map(|(index, _)| Clock { instance: self, index })
    }

    /// Settles the outputs that depend on inputs combinationally.
    ///
    /// # Errors
    /// Returns an error if the module stops the simulation.
    pub fn evaluate(&self) -> Result<(), SimulationError> {
        // SAFETY: the handle is live.
        self.checked(unsafe { (self.api.evaluate)(self.handle.as_ptr()) })
    }

    /// Writes a waveform to `path` from now on, with the time axis of a clock of this half period. The model must have
    /// been built with a [`Trace`](super::Trace). The file exists only after [`Instance::trace_close`]. Another
    /// waveform may follow.
    ///
    /// # Errors
    /// Returns an error if the model was built without a trace, a waveform is already open, or the file cannot be
    /// written.
    pub fn trace_open(&self, path: &Path, half_period_ps: u64) -> Result<(), SimulationError> {
        let fail = |why: String| SimulationError::Waveform { path: path.to_owned(), why };
        let aside = Aside::new(path).map_err(|e| fail(e.to_string()))?;
        let text = CString::new(aside.path().as_os_str().as_bytes()).map_err(|e| fail(e.to_string()))?;
        // SAFETY: the handle is live and the text ends with a zero.
        match unsafe { (self.api.trace_open)(self.handle.as_ptr(), text.as_ptr(), half_period_ps) } {
            0 => {
                self.waveform.replace(Some(Waveform { path: path.to_owned(), aside }));
                Ok(())
            }
            _ => Err(fail(message(self.api, self.handle.as_ptr()))),
        }
    }

    /// Closes the waveform and moves its file to its place.
    ///
    /// # Errors
    /// Returns an error if no waveform is open, or if the file could not be written. In the second case there is no
    /// file.
    pub fn trace_close(&self) -> Result<(), SimulationError> {
        // SAFETY: the handle is live.
        self.checked(unsafe { (self.api.trace_close)(self.handle.as_ptr()) })?;
        let Some(Waveform { path, aside }) = self.waveform.take() else { return Ok(()) };
        aside.finish().map_err(|error| SimulationError::Waveform { path, why: error.to_string() })
    }

    fn checked(&self, result: c_int) -> Result<(), SimulationError> {
        if result == 0 {
            return Ok(());
        }
        let why = message(self.api, self.handle.as_ptr());
        // Dropping the waveform also removes its file.
        match self.waveform.borrow_mut().take_if(|_| result == raw::AFU_WAVEFORM) {
            Some(Waveform { path, .. }) => Err(SimulationError::Waveform { path, why }),
            None => Err(SimulationError::Stopped(why)),
        }
    }
}

impl Clock<'_> {
    /// Runs `cycles` full cycles. Each has a rising edge, at which registers take their inputs, and a falling edge.
    ///
    /// # Errors
    /// Returns an error if the module stops the simulation.
    #[inline]
    pub fn tick(self, cycles: u64) -> Result<(), SimulationError> {
        let Instance { api, handle, .. } = self.instance;
        // SAFETY: the handle is live, and the index belongs to one of its ports.
        self.instance.checked(unsafe { (api.clock)(handle.as_ptr(), self.index, cycles) })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the handle is live, and nothing uses it after this.
        unsafe { (self.api.destroy)(self.handle.as_ptr()) }
    }
}

fn name_of(port: &raw::afu_port) -> String {
    // SAFETY: a zero-terminated literal in the model, which is never unloaded.
    unsafe { CStr::from_ptr(port.name) }.to_string_lossy().into_owned()
}

fn message(api: Api, handle: *mut raw::afu_instance) -> String {
    // SAFETY: the handle is live, or null to get this thread's creation error. The text is never null.
    unsafe { CStr::from_ptr((api.error)(handle)) }.to_string_lossy().into_owned()
}
