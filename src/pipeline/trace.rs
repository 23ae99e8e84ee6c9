//! The kernel that this thread is reading, and its ports.

use std::cell::RefCell;
use std::panic::Location;
use std::sync::atomic::{AtomicU64, Ordering};

use super::kernel::{Kernel, Kind, Promise, ValueId};
use super::wire::{Bit, Wire};
use crate::hdl::BuildErrors;
use crate::number::Format;

thread_local! {
    static CURRENT: RefCell<Option<(u64, Kernel)>> = const { RefCell::new(None) };
}

/// Tells kernels apart, in all threads.
static SERIAL: AtomicU64 = AtomicU64::new(0);

/// The content of wires and bits: a value of one kernel, or `None` after an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Handle {
    kernel: u64,
    value: Option<ValueId>,
}

impl Handle {
    const POISON: Self = Self { kernel: 0, value: None };
}

/// Reads a kernel: `body` takes inputs from the ports, computes with them and gives outputs to the ports.
///
/// # Errors
/// Returns all bad operations together: mixed formats, wires of another kernel, constants that their format cannot
/// represent.
pub fn trace(name: &str, body: impl FnOnce(&Ports)) -> Result<Kernel, BuildErrors> {
    let serial = SERIAL.fetch_add(1, Ordering::Relaxed) + 1;
    let outer = CURRENT.replace(Some((serial, Kernel::new(name))));
    let mut restore = Restore { outer: Some(outer) };
    body(&Ports { _private: () });
    let traced = CURRENT.replace(restore.outer.take().flatten());
    match traced {
        Some((_, kernel)) if kernel.errors.is_empty() => Ok(kernel),
        Some((_, kernel)) => Err(BuildErrors(kernel.errors)),
        // Only if `body` replaced the thread's kernel, which is impossible outside this file.
        None => Err(BuildErrors(Vec::new())),
    }
}

/// Puts the outer kernel back if `body` panics.
struct Restore {
    outer: Option<Option<(u64, Kernel)>>,
}

impl Drop for Restore {
    fn drop(&mut self) {
        if let Some(outer) = self.outer.take() {
            CURRENT.set(outer);
        }
    }
}

/// Makes a value of `operands` in the present kernel. If an operand is poisoned, so is the value. An operand of another
/// kernel, or an error of `make`, is recorded and poisons the value.
pub(super) fn make(
    what: &str,
    operands: &[Handle],
    place: &'static Location<'static>,
    make: impl FnOnce(&mut Kernel, &[ValueId]) -> Result<ValueId, String>,
) -> Handle {
    CURRENT.with_borrow_mut(|current| {
        let Some((serial, kernel)) = current else { return Handle::POISON };
        let Some(ids) = operands.iter().map(|handle| handle.value).collect::<Option<Vec<_>>>() else {
            return Handle::POISON;
        };
        if operands.iter().any(|handle| handle.kernel != *serial) {
            kernel.error(format!("{what}: a wire of another kernel"), place);
            return Handle::POISON;
        }
        match make(kernel, &ids) {
            Ok(id) => Handle { kernel: *serial, value: Some(id) },
            Err(message) => {
                kernel.error(message, place);
                Handle::POISON
            }
        }
    })
}

/// The ports of the kernel that is being read.
pub struct Ports {
    _private: (),
}

impl Ports {
    /// Adds a line to the description in the module's header.
    pub fn about(&self, line: impl Into<String>) {
        CURRENT.with_borrow_mut(|current| {
            if let Some((_, kernel)) = current {
                kernel.about.push(line.into());
            }
        });
    }

    /// A numeric input.
    #[track_caller]
    pub fn input(&self, name: &str, format: Format) -> Wire {
        Wire(input(name, Kind::Number(format), Location::caller()))
    }

    /// An input that carries a Boolean.
    #[track_caller]
    pub fn input_bit(&self, name: &str) -> Bit {
        Bit(input(name, Kind::Bit, Location::caller()))
    }

    /// A Boolean that is always set.
    #[track_caller]
    pub(super) fn always(&self) -> Bit {
        Bit(make("always", &[], Location::caller(), |kernel, _| Ok(kernel.constant(Kind::Bit, 1))))
    }

    /// Supposes that a Boolean is always set, which is known from elsewhere: see [`Kernel::supposed`].
    #[track_caller]
    pub(super) fn suppose(&self, bit: Bit) {
        make("suppose", &[bit.0], Location::caller(), |kernel, ids| {
            kernel.supposed = Some(ids[0]);
            Ok(ids[0])
        });
    }

    /// A Boolean input that arrives some cycles after the others.
    #[track_caller]
    pub(crate) fn input_bit_after(&self, name: &str, cycles: u32) -> Bit {
        Bit(make(name, &[], Location::caller(), |kernel, _| {
            let id = kernel.input(name, Kind::Bit);
            kernel.late.push((id, cycles));
            Ok(id)
        }))
    }

    /// Promises that `inputs` are neither infinite nor NaN while `condition` holds, and with `not_negative` also not
    /// below zero. The promise is used only if no output depends on such an input while `condition` does not hold.
    #[track_caller]
    pub fn promise_finite(&self, condition: Bit, inputs: &[Wire], not_negative: bool) {
        for input in inputs {
            make("promise", &[condition.0, input.0], Location::caller(), |kernel, ids| {
                kernel.promises.push(Promise { value: ids[1], condition: ids[0], not_negative });
                Ok(ids[1])
            });
        }
    }

    /// A numeric output.
    #[track_caller]
    pub fn output(&self, name: &str, value: Wire) {
        output(name, value.0, Location::caller());
    }

    /// An output that carries a Boolean.
    #[track_caller]
    pub fn output_bit(&self, name: &str, value: Bit) {
        output(name, value.0, Location::caller());
    }
}

fn input(name: &str, kind: Kind, place: &'static Location<'static>) -> Handle {
    make(name, &[], place, |kernel, _| Ok(kernel.input(name, kind)))
}

fn output(name: &str, value: Handle, place: &'static Location<'static>) {
    let made = make(name, &[value], place, |kernel, ids| {
        kernel.outputs.push((name.to_owned(), ids[0]));
        Ok(ids[0])
    });
    CURRENT.with_borrow_mut(|current| {
        if let (Some((_, kernel)), None) = (current, made.value)
            && kernel.errors.is_empty()
        {
            kernel.error(format!("output `{name}`: its value was made outside of a kernel"), place);
        }
    });
}
