//! The backlog: a queue of contacts between the sieve, which finds up to one contact per lane and cycle, and the
//! packer, which takes up to one line per cycle. It cannot overflow: a pair enters an SCPU only when there is a place
//! here for its contact.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::Spec;
use super::banks::{Turn, rotate};

/// Builds the module `contact_afu_backlog` with `places` (a power of two) places and one bank per lane. At most
/// `leaving` (a power of two) contacts leave in a cycle.
pub(super) fn backlog(spec: &Spec, places: u32, leaving: u32) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_backlog");
    graph.about("keeps contacts, in their order, until the packer takes them");
    let (lanes, entry_bits) = (spec.lanes(), spec.entry_bits());
    let start = graph.input("start", 1);
    let put = graph.input("put", spec.group_bits());
    let entries: Vec<_> = (0..lanes).map(|lane| graph.input(&format!("entry_{lane}"), entry_bits)).collect();
    let may_leave = graph.input("may_leave", 1);

    let kept = keep(&graph, [start, may_leave], put, &entries, (places, leaving));
    let group_out = kept.group.gate(!start).registered("group_out");
    graph.output("group", group_out);
    for (lane, entry) in kept.oldest.into_iter().take(leaving as usize).enumerate() {
        // Their number is known one cycle ahead. Where none leaves, nobody looks.
        graph.output(&format!("record_{lane}"), entry.delay(2).named(&format!("leaving_{lane}")));
    }
    graph.output("empty", !kept.stored.any() & !group_out.any());
    graph.finish()
}

/// What banks keep.
pub(super) struct Kept<'g> {
    /// The number of those that leave in this cycle.
    pub(super) group: Signal<'g>,
    /// The oldest entries, as many as there are banks, the first one first. If fewer are `readable`, the others are
    /// anything.
    pub(super) oldest: Vec<Signal<'g>>,
    /// The number of all.
    pub(super) stored: Signal<'g>,
    /// The number of those that stand at the outputs of the banks or behind these.
    pub(super) readable: Signal<'g>,
}

/// Keeps entries in order, in a bank for each that may come in a cycle, with so many places together (a power of two).
/// The first `put` of `entries` come, and the first `leaving` (a power of two) leave, at most, where they may.
pub(super) fn keep<'g>(
    graph: &'g Graph,
    [start, may_leave]: [Signal<'g>; 2],
    put: Signal<'g>,
    entries: &[Signal<'g>],
    (places, leaving): (u32, u32),
) -> Kept<'g> {
    let (lanes, entry_bits) = (entries.len() as u32, entries[0].width());
    let count_bits = places.ilog2() + 1;
    let (bank_bits, rows) = (lanes.ilog2(), places / lanes);
    let stored = graph.register("stored", count_bits, 0);
    // The contents of a bank one cycle ago, which its registered read shows.
    let readable = graph.register("readable", count_bits, 0);

    let leaving_bits = leaving.ilog2() + 1;
    let many = readable.drop_low(leaving_bits - 1).any();
    let most = graph.constant(leaving_bits, u128::from(leaving));
    let group = if leaving == 1 { many } else { many.select(most, readable.low(leaving_bits)) };
    let group = group.gate(may_leave).named("leaving");
    let left = (stored.value() - group.extend(count_bits)).named("left");
    stored.next(start.select(stored.same(0), left + put.extend(count_bits)));
    readable.next(start.select(readable.same(0), left));
    // Contact j goes to bank (tail + j) mod lanes; contact j of those that leave is in bank (head + j) mod lanes.
    let bank = |name: &str, many: Signal<'g>| {
        let bank = (bank_bits > 0).then(|| graph.register(name, bank_bits, 0))?;
        bank.next(start.select(bank.same(0), *bank + many.low(bank_bits)));
        Some(bank.value())
    };
    let leave = group.extend(bank_bits + 1);
    let (tail, head) = (bank("tail_bank", put), bank("head_bank", leave));
    let turned = |row, by, turn| match by {
        Some(by) => rotate(row, by, turn),
        None => row,
    };
    let arriving =
        entries.iter().zip(0..).map(|(entry, lane)| put.greater_than(put.same(lane)).concat(*entry)).collect();
    let leaves = (0..lanes).map(|lane| leave.greater_than(leave.same(lane.into()))).collect();
    let arriving = turned(arriving, tail, Turn::Up);
    let leaves = turned(leaves, head, Turn::Up);
    let mut read = Vec::new();
    for ((bank, entry), leaves) in (0..lanes).zip(arriving).zip(leaves) {
        // Each bank has its own rows, so nothing is added between what leaves and the address of a memory.
        let row = |name: &str, first| graph.register(&format!("{name}_{bank}"), rows.ilog2(), first);
        let [tail_row, head_row, row_after] = [row("tail_row", 0), row("head_row", 0), row("row_after_head", 1)];
        let entry = entry.named(&format!("entering_bank_{bank}"));
        let leaves = leaves.named(&format!("leaves_bank_{bank}"));
        let enters = entry.msb().named(&format!("enters_bank_{bank}"));
        tail_row.next_if(start | enters, start.select(tail_row.same(0), tail_row.plus(1)));
        row_after.next_if(start | leaves, start.select(row_after.same(1), row_after.plus(1)));
        let next_row = leaves.select(*row_after, *head_row).named(&format!("next_row_{bank}"));
        head_row.next(start.select(head_row.same(0), next_row));
        let store = graph.memory(&format!("bank_{bank}"), rows, entry_bits);
        store.write(enters, *tail_row, entry.low(entry_bits));
        read.push(store.read(next_row).named(&format!("oldest_{bank}")));
    }
    let oldest = turned(read, head, Turn::Down);
    Kept { group, oldest, stored: stored.value(), readable: readable.value() }
}
