//! Kernels as pipelines. Mathematics read with [`Wire`] becomes a graph of operators. Balancing turns it into a module
//! that takes new operands in every cycle (or every few cycles with fewer operators) and never stalls.

mod balance;
mod contact;
mod emit;
mod guard;
mod kernel;
mod names;
mod range;
mod report;
mod share;
mod trace;
mod widen;
mod wire;

pub use contact::{Settings, contact_kernel, is_normal};
pub use kernel::Kernel;
pub use report::{KernelReport, OperatorUse};
pub use trace::{Ports, trace};
pub use wire::{Bit, Wire};
