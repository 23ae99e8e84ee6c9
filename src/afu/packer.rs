//! The packer: takes the results of a cycle in order of pairs, packs them into lines, counts what they are.

use std::sync::Arc;

use crate::hdl::{Errors, Graph, Module, Signal};

use super::{COUNT_BITS, Spec};

/// From a group to the line that it fills.
pub(super) const CYCLES_TO_LINE: u32 = 1;
/// As many more for a last line that is not full.
pub(super) const CYCLES_TO_FLUSH: u32 = 1;

/// Builds the module `contact_afu_packer`.
pub(super) fn packer(spec: &Spec) -> Result<Arc<Module>, Errors> {
    let graph = Graph::new("contact_afu_packer");
    graph.about("packs results into destination lines, counts contacts and invalid pairs");
    let layout = spec.layout();
    let (lanes, group_bits, record_bits) = (spec.lanes(), spec.group_bits(), layout.contact_bits());
    let per_line = layout.contacts_per_line();
    let place_bits = per_line.ilog2().max(1);

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

    // The line being filled, and a group shifted to the first free place in it.
    let filling = graph.register("filling", spec.line_bits, 0);
    let place = graph.register("place", place_bits, 0);
    records.reverse();
    let mut shifted = Signal::join(&records).extend(spec.line_bits + (lanes - 1) * record_bits);
    for bit in 0..place_bits {
        let step = record_bits << bit;
        if step < shifted.width() {
            let moved = shifted.low(shifted.width() - step).append_zeros(step);
            shifted = place.bit(bit).select(moved, shifted);
        }
    }
    let merged = (filling.extend(shifted.width()) | shifted.named("shifted")).named("merged");
    let sum_bits = place_bits.max(group_bits) + 1;
    let next_place = (place.extend(sum_bits) + group.extend(sum_bits)).named("next_place");
    let full = next_place.at_least(next_place.same(u128::from(per_line))).named("full");
    let over = if lanes == 1 { filling.same(0) } else { merged.drop_low(spec.line_bits).extend(spec.line_bits) };

    // After the last pair the line in hand goes out as it is, its unused part zero.
    let emerged = graph.register("emerged", COUNT_BITS, 0);
    emerged.next(start.select(emerged.same(0), emerged.value() + group.extend(COUNT_BITS)));
    let all_out = emerged.equals(count).named("all_out");
    let flush = (all_out & place.any() & !group.any()).named("flush");
    let emptied = (start | flush).named("emptied");
    let kept = full.select(over, merged.low(spec.line_bits));
    filling.next(emptied.select(filling.same(0), kept));
    let wrapped = full.select(next_place.minus(u128::from(per_line)), next_place).named("wrapped_place");
    place.next(emptied.select(place.same(0), wrapped.low(place_bits)));
    let line_valid = graph.register("line_valid", 1, 0);
    line_valid.next(!start & (full | flush));
    graph.output("line_valid", line_valid.value());
    graph.output("line", merged.low(spec.line_bits).delay(1).named("line"));
    graph.output("done", all_out & !place.any() & !*line_valid);

    // Counters for the status.
    let contact_count = graph.register("contact_count", COUNT_BITS, 0);
    let invalid_count = graph.register("invalid_count", COUNT_BITS, 0);
    let first_invalid = graph.register("first_invalid_pair", COUNT_BITS, u128::from(u32::MAX));
    contact_count.next(start.select(contact_count.same(0), contact_count.value() + ones(&graph, &contacts)));
    invalid_count.next(start.select(invalid_count.same(0), invalid_count.value() + ones(&graph, &invalids)));
    let none_yet = !invalid_count.any();
    let mut first = emerged.plus(u128::from(lanes - 1));
    for lane in (0..lanes - 1).rev() {
        first = invalids[lane as usize].select(emerged.plus(u128::from(lane)), first);
    }
    let some = invalids.iter().fold(graph.constant(1, 0), |any, bit| any | *bit).named("some_invalid");
    let updated = (some & none_yet).select(first, *first_invalid);
    first_invalid.next(start.select(first_invalid.same(u128::from(u32::MAX)), updated));
    graph.output("contacts", contact_count.value());
    graph.output("invalid", invalid_count.value());
    graph.output("first_invalid", first_invalid.value());
    graph.finish()
}

/// How many of the bits are set.
fn ones<'g>(graph: &'g Graph, bits: &[Signal<'g>]) -> Signal<'g> {
    let width = bits.len().ilog2() + 1;
    let sum = bits.iter().fold(graph.constant(width, 0), |sum, bit| sum + bit.extend(width));
    sum.extend(COUNT_BITS)
}
