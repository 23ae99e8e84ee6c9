//! The registers that the host writes, and the DSM lines that answer them.
//!
//! They are written before SPL is enabled, and on some platforms while SPL still holds its reset. So only the system's
//! reset resets them. A new reset by SPL clears the addresses.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::map::{self, Csr, identity, scratch};
use super::words::MDATA_BITS;
use crate::afu::{ADDRESS_BITS, Spec};

/// Bits of a byte address within a line.
const BYTE_BITS: u32 = 6;

/// Builds the module `spl2_registers`.
pub(super) fn registers(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("spl2_registers");
    graph.about("takes CSR writes, answers them in the DSM");
    let power_on = graph.input("power_on", 1);
    // All inputs are registered; the written value is known by then.
    let heard = |name: &str, width: u32| graph.input(name, width).delay(1).named(&format!("{name}_heard"));
    let spl_reset = heard("spl_reset", 1);
    let (cfg_valid, cfg_offset) = (graph.input("cfg_valid", 1), graph.input("cfg_offset", MDATA_BITS));
    let cfg_data = heard("cfg_data", 32);
    let granted = graph.input("wr_granted", 1);
    let capability = graph.input("capability", 64);

    // A reset by SPL counts when it begins. If it is a level, addresses are written before it ends.
    let before = graph.data_register("spl_reset_before", 1);
    before.next(spl_reset);
    let clear = (power_on | (spl_reset & !*before)).named("clear");

    let written = |csr: Csr| (cfg_valid & cfg_offset.is(u128::from(csr.offset / 4))).delay(1).named(csr.name);
    let address = |high: Csr, low: Csr, name: &str| {
        let high_half = graph.data_register(&format!("{name}_high"), 32);
        high_half.next_if(written(high), cfg_data);
        let commit = written(low);
        let line = graph.data_register(&format!("{name}_line"), ADDRESS_BITS);
        line.next_if(commit, high_half.concat(cfg_data.drop_low(BYTE_BITS)));
        let valid = flag(&graph, &format!("{name}_valid"), commit, clear);
        (line.value(), valid, commit)
    };
    let (dsm_line, dsm_valid, dsm_commit) = address(map::DSM_BASE_HIGH, map::DSM_BASE_LOW, "dsm");
    let (context_line, context_valid, context_commit) =
        address(map::CONTEXT_BASE_HIGH, map::CONTEXT_BASE_LOW, "context");

    // Lines to be written: the identity before the scratch.
    let scratch_written = written(map::SCRATCH);
    let value = graph.data_register("scratch_value", 32);
    value.next_if(scratch_written, cfg_data);
    let take_identity = graph.wire("identity_granted", 1);
    let take_scratch = graph.wire("scratch_granted", 1);
    let identity_due = flag(&graph, "identity_due", dsm_commit, clear | (take_identity & !dsm_commit));
    let scratch_due = flag(&graph, "scratch_due", scratch_written, clear | (take_scratch & !scratch_written));
    let is_due = (dsm_valid & (identity_due | scratch_due) & !granted & !power_on).named("is_due");
    // One copy asks for a turn, the other chooses the line among those of the shell.
    let due = is_due.data_copies("due", 2);
    // The granted line was chosen one cycle before.
    let was_identity = identity_due.delay(1).named("was_identity");
    take_identity.drive(granted & was_identity);
    take_scratch.drive(granted & !was_identity);

    let constant = |width: u32, value: u128| graph.constant(width, value);
    let identity = map::line(
        &graph,
        spec.line_bits,
        &[
            (identity::AFU_ID, constant(128, map::AFU_ID)),
            (identity::VERSION, constant(32, map::VERSION.into())),
            (identity::CAPABILITY, capability),
        ],
    );
    let scratch = map::line(&graph, spec.line_bits, &[(scratch::VALUE, value.value())]);
    let number = identity_due.select(constant(6, map::IDENTITY_LINE.into()), constant(6, map::SCRATCH_LINE.into()));
    graph.output("dsm_line", dsm_line);
    graph.output("dsm_valid", dsm_valid);
    graph.output("context_line", context_line);
    graph.output("context_valid", context_valid);
    graph.output("context_written", context_commit);
    graph.output("wr_valid", due[0]);
    graph.output("wr_chosen", due[1]);
    graph.output("wr_address", dsm_page_line(dsm_line, number));
    graph.output("wr_line", identity_due.select(identity, scratch).named("line"));
    graph.finish()
}

/// A bit that is set by one event and cleared by another, which wins.
fn flag<'g>(graph: &'g Graph, name: &str, set: Signal<'g>, clear: Signal<'g>) -> Signal<'g> {
    let flag = graph.data_register(name, 1);
    flag.next((*flag | set) & !clear);
    flag.value()
}

/// The address of a line of the DSM, which is a page.
pub(super) fn dsm_page_line<'g>(dsm: Signal<'g>, number: Signal<'g>) -> Signal<'g> {
    dsm.drop_low(number.width()).concat(number)
}
