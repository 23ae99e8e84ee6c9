//! The operators of a kernel, for a manifest.

use serde::Serialize;

use crate::hdl::{Module, Op};

/// An operator of a kernel.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct OperatorUse {
    /// The name of its module.
    pub module: String,
    /// The number of instances.
    pub instances: usize,
    /// Cycles from its operands to its result.
    pub latency: u32,
    /// Operations in its graph, registers left out.
    pub operations: usize,
}

/// A kernel's latency, operators and delays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KernelReport {
    /// Cycles from inputs to outputs.
    pub latency: u32,
    /// The clock in MHz that the slowest operator reaches, by the delay model with which it was cut.
    pub clock_mhz: Option<f64>,
    /// The operators in use, by name.
    pub operators: Vec<OperatorUse>,
    /// Bits in delays between operators: the sum of width times cycles. At an interval above 1, the bits in registers
    /// and memories.
    pub delay_bits: u64,
}

impl KernelReport {
    /// The report on a kernel's module.
    pub fn of(kernel: &Module) -> Self {
        let mut operators: Vec<OperatorUse> = Vec::new();
        for instance in &kernel.instances {
            let module = &instance.module;
            match operators.iter_mut().find(|known| known.module == module.name) {
                Some(known) => known.instances += 1,
                None => operators.push(OperatorUse {
                    module: module.name.clone(),
                    instances: 1,
                    latency: module.latency,
                    operations: operations(module),
                }),
            }
        }
        operators.sort_by(|a, b| a.module.cmp(&b.module));
        let delay_bits = kernel.nodes.iter().map(|node| match node.op {
            Op::Delay { cycles } => u64::from(cycles) * u64::from(node.width),
            Op::Register { .. } | Op::MemoryRead { .. } => u64::from(node.width),
            _ => 0,
        });
        let words = kernel.memories.iter().map(|memory| u64::from(memory.depth) * u64::from(memory.width));
        let timings = kernel.instances.iter().filter_map(|instance| instance.module.timing.as_ref());
        let clock_mhz = timings.map(|timing| timing.clock_mhz).reduce(f64::min);
        Self { latency: kernel.latency, clock_mhz, operators, delay_bits: delay_bits.chain(words).sum() }
    }
}

/// Nodes that are logic: neither ports, constants, wiring nor registers.
fn operations(module: &Module) -> usize {
    let is_logic = |op: &Op| {
        !matches!(op, Op::Input | Op::Parameter(_) | Op::Constant(_) | Op::Concat | Op::Slice { .. } | Op::Delay { .. })
    };
    module.nodes.iter().filter(|node| is_logic(&node.op)).count()
}
