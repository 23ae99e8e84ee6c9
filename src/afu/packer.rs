//! The packer: takes records in order and packs them into lines. If a record comes back for every pair, it also counts
//! contacts and invalid pairs; with `--results hits`, the [sieve](super::sieve) counts them.

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::{COUNT_BITS, Spec, status};

/// Cycles from the records of a group to the line that they fill: shifted into place, merged.
pub(super) const CYCLES_TO_LINE: u32 = 2;
/// Additional cycles for a last line that is not full.
pub(super) const CYCLES_TO_FLUSH: u32 = 2;
/// Cycles until a job without pairs is known to be complete.
pub(super) const CYCLES_TO_NOTHING: u32 = 1;

/// Builds the module `contact_afu_packer`.
pub(super) fn packer(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    match spec.config.results {
        Results::All => of_all(spec),
        Results::Hits => of_hits(spec),
    }
}

/// Results of a cycle in the order of the pairs, one record each.
fn of_all(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_packer");
    graph.about("packs results into destination lines, counts contacts and invalid pairs");
    let (lanes, group_bits, record_bits) = (spec.lanes(), spec.group_bits(), spec.layout().contact_bits());

    let start = graph.input("start", 1);
    let count = graph.input("count", COUNT_BITS);
    let group = graph.input("group", group_bits);
    let mut records = Vec::new();
    let mut contacts = Vec::new();
    let mut invalids = Vec::new();
    for lane in 0..lanes {
        records.push(graph.input(&format!("record_{lane}"), record_bits));
        contacts.push(graph.input(&format!("contact_{lane}"), 1));
        invalids.push(graph.input(&format!("invalid_{lane}"), 1));
    }
    let (emerged, all_out) = status::emerged(&graph, start, group, count);
    fill(&graph, spec, start, group, records, all_out);
    status::count(&graph, start, emerged.delay(1).named("emerged_before"), &contacts, &invalids);
    graph.finish()
}

/// Contacts of a cycle in the order of pairs. Each is a record with its number, which arrives one cycle after the
/// number of contacts. `all_out` is set when no more will arrive.
fn of_hits(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_packer");
    graph.about("packs contacts into destination lines");
    let layout = spec.layout();
    let entry_bits = spec.entry_bits();

    let start = graph.input("start", 1);
    let group = graph.input("group", spec.leaving_bits());
    let records: Vec<_> = (0..spec.leaving())
        .map(|lane| graph.input(&format!("record_{lane}"), entry_bits).extend(layout.contact_bits()))
        .collect();
    let all_out = graph.input("all_out", 1);
    if layout.contacts_per_line() == 1 {
        // A record fills a line, so nothing is gathered.
        let comes = (!start & group).registered("line_comes");
        let line_valid = (!start & comes).registered("line_valid");
        graph.output("line_valid", line_valid);
        graph.output("line", records[0].delay(1).named("line"));
        graph.output("done", all_out & !comes & !line_valid);
    } else {
        fill(&graph, spec, start, group, records, all_out);
    }
    graph.finish()
}

/// Packs the first `group` of `records` (as wide as in a line) after those before them, and gives the outputs
/// `line_valid`, `line` and `done`. The records arrive one cycle after their number, at most as many in a cycle as
/// share a line. After `all_out`, the line in hand leaves.
fn fill<'g>(
    graph: &'g Graph,
    spec: &Spec,
    start: Signal<'g>,
    group: Signal<'g>,
    mut records: Vec<Signal<'g>>,
    all_out: Signal<'g>,
) {
    let layout = spec.layout();
    let (lanes, record_bits, per_line) = (records.len() as u32, layout.contact_bits(), layout.contacts_per_line());
    let place_bits = per_line.ilog2().max(1);

    // The place of a group is decided before its records arrive.
    let place = graph.register("place", place_bits, 0);
    let sum_bits = place_bits.max(group.width()) + 1;
    let next_place = (place.extend(sum_bits) + group.extend(sum_bits)).named("next_place");
    let fills = next_place.at_least(next_place.same(u128::from(per_line))).named("fills");
    // After the last record, the line in hand leaves as it is, with zeros in its unused part.
    let flushes = (all_out & place.any() & !group.any()).named("flushes");
    let wrapped = fills.select(next_place.minus(u128::from(per_line)), next_place).named("wrapped_place");
    place.next((start | flushes).select(place.same(0), wrapped.low(place_bits)));
    let went = (!start & (fills | flushes)).registered("went");
    let goes = (!start & went).registered("goes");
    let full = fills.delay(2).named("full");
    let emptied = (start | flushes).delay(2).named("emptied");
    let first_place = place.delay(1).named("first_place");

    // A group is shifted to its place in the line, and a cycle later merged with what is in the line.
    let filling = graph.register("filling", spec.line_bits, 0);
    records.reverse();
    let mut shifted = Signal::join(&records).extend(spec.line_bits + (lanes - 1) * record_bits);
    for bit in 0..place_bits {
        let step = record_bits << bit;
        if step < shifted.width() {
            let moved = shifted.low(shifted.width() - step).append_zeros(step);
            shifted = first_place.bit(bit).select(moved, shifted).named(&format!("moved_by_{}", 1 << bit));
        }
    }
    let merged = (filling.extend(shifted.width()) | shifted.delay(1).named("shifted")).named("merged");
    let over = if lanes == 1 { filling.same(0) } else { merged.drop_low(spec.line_bits).extend(spec.line_bits) };
    let kept = full.select(over, merged.low(spec.line_bits));
    filling.next(emptied.select(filling.same(0), kept));
    let line_valid = (!start & goes).registered("line_valid");
    graph.output("line_valid", line_valid);
    graph.output("line", merged.low(spec.line_bits).delay(1).named("line"));
    graph.output("done", all_out & !place.any() & !went & !goes & !line_valid);
}
