//! Registers and scan chains around a unit: few pins for any number of ports, and only register-to-register paths.
//!
//! A chain shifts `scan_in` through. `load` copies it into the operand registers, which feed the unit. The results go
//! into registers and, when `shift` is low, into a second chain that ends at `scan_out`. The operand registers have an
//! enable, so no register of the unit that delays an input can be merged with one of the wrapper's.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// The name of the wrapper's module.
pub const TOP: &str = "bench";
/// The name of the unit's instance in it.
pub(crate) const UNIT: &str = "unit";

/// The name of the registers that feed the unit.
pub(crate) const OPERANDS: &str = "operand_register";
/// The name of the registers that take the unit's results.
pub(crate) const RESULTS: &str = "result_register";

/// The wrapper around `unit`. The words in the chains have the order of the ports, the first one most significant. A
/// chain shifts the most significant bit first.
///
/// # Errors
/// Returns an error only if the generator has a fault.
pub fn wrap(unit: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new(TOP);
    graph.about(format!("registers and scan chains around {}", unit.name));
    let ports = |output: bool| unit.ports.iter().filter(move |port| port.output == output);
    let bits = |output: bool| bits(unit, output);

    let scan_in = graph.input("scan_in", 1);
    let scanned = if bits(false) > 0 { operands(&graph, scan_in, bits(false)) } else { None };
    let mut taken = bits(false);
    let mut inputs = Vec::new();
    for port in ports(false) {
        taken -= port.width;
        inputs.extend(scanned.map(|operands| (port.name.as_str(), operands.slice(taken, port.width))));
    }
    let instance = graph.instance_of_top(UNIT, unit, &inputs);
    let results: Vec<Signal<'_>> = ports(true).map(|port| instance.output(&port.name)).collect();

    let result = graph.data_register(RESULTS, bits(true));
    result.next(Signal::join(&results));
    let shift = graph.input("shift", 1);
    let chain = graph.data_register("result_chain", bits(true));
    // The bit that follows is the input's. A constant would turn the last register into another kind of cell.
    let shifted = shift_in(chain.value(), scan_in);
    chain.next(shift.select(shifted, result.value()));
    graph.output("scan_out", chain.msb());
    graph.finish()
}

/// The number of bits in a unit's inputs or outputs.
pub fn bits(unit: &Module, outputs: bool) -> u32 {
    unit.ports.iter().filter(|port| port.output == outputs).map(|port| port.width).sum()
}

/// The chain that is filled bit by bit, and the registers that are loaded from it.
fn operands<'g>(graph: &'g Graph, scan_in: Signal<'g>, bits: u32) -> Option<Signal<'g>> {
    let chain = graph.data_register("operand_chain", bits);
    chain.next(shift_in(chain.value(), scan_in));
    let operands = graph.data_register(OPERANDS, bits);
    operands.next_if(graph.input("load", 1), chain.value());
    Some(operands.value())
}

fn shift_in<'g>(chain: Signal<'g>, bit: Signal<'g>) -> Signal<'g> {
    if chain.width() == 1 { bit } else { chain.low(chain.width() - 1).concat(bit) }
}
