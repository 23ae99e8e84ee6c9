//! The packer: takes records in order and packs them into lines. If a record comes back for every pair, it also
//! counts contacts and invalid pairs; with `--results hits`, the [sieve](super::sieve) counts them.

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::gather::{self, gather};
use super::{Spec, status};

/// Cycles from the records of a group to the line that they fill.
pub(super) fn cycles_to_line(spec: &Spec) -> u32 {
    gather::CYCLES * if per_word(spec).is_some() { 2 } else { 1 }
}

/// Additional cycles for a last line that is not full. A last word of its own is known to have left a cycle later.
pub(super) fn cycles_to_flush(spec: &Spec) -> u32 {
    if per_word(spec).is_some() { 4 } else { 3 }
}

/// Cycles until a job without pairs is known to be complete.
pub(super) const CYCLES_TO_NOTHING: u32 = 2;
/// Records of fewer bits are gathered in words of this many bits first.
const WORD_BITS: u32 = 32;

/// The number of records in a word, if records are gathered in words first.
fn per_word(spec: &Spec) -> Option<u32> {
    let record_bits = spec.layout().contact_bits();
    (record_bits < WORD_BITS && spec.line_bits > WORD_BITS).then(|| WORD_BITS / record_bits)
}

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
    let (lanes, record_bits) = (spec.lanes(), spec.layout().contact_bits());

    let start = graph.input("start", 1);
    let all_emerged = graph.input("all_emerged", 1);
    let results = status::results(&graph, lanes);
    let mut records = Vec::new();
    let mut contacts = Vec::new();
    let mut invalids = Vec::new();
    for lane in 0..lanes {
        records.push(graph.input(&format!("record_{lane}"), record_bits));
        contacts.push(results.of(lane, "contact"));
        invalids.push(results.of(lane, "invalid"));
    }
    // The count is as late as the search for the first invalid lane, so a register stands between it and the slots.
    let group_before = results.group.registered("group_here").registered("group_before");
    let emerged_before = status::emerged(&graph, start, group_before);
    fill(&graph, spec, start, results.leaves, records, all_emerged);
    status::count(&graph, start, emerged_before, &contacts, &invalids);
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
    let carries = (0..spec.leaving()).rev().map(|lane| group.greater_than(group.same(lane.into())));
    let carries = carries.reduce(Signal::concat).unwrap_or(group).named("carries");
    fill(&graph, spec, start, carries, records, all_out);
    graph.finish()
}

/// Pairs of numbers in order, at most `lanes` in a cycle, each a record. The lanes that carry one are known one cycle
/// before it arrives. `all_out` is set when no more will arrive.
pub(super) fn of_pairs(spec: &Spec, lanes: u32) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_packer");
    graph.about("packs hits into destination lines");
    let record_bits = spec.layout().contact_bits();
    let start = graph.input("start", 1);
    let carries = graph.input("carries", lanes);
    let records = (0..lanes).map(|lane| graph.input(&format!("record_{lane}"), record_bits)).collect();
    let all_out = graph.input("all_out", 1);
    fill(&graph, spec, start, carries, records, all_out);
    graph.finish()
}

/// Packs `records` (as wide as in a line) and gives the outputs `line_valid`, `line` and `done`.
fn fill<'g>(
    graph: &'g Graph,
    spec: &Spec,
    start: Signal<'g>,
    mut carries: Signal<'g>,
    mut records: Vec<Signal<'g>>,
    mut all_out: Signal<'g>,
) {
    let layout = spec.layout();
    let mut per_line = layout.contacts_per_line();
    if let ([record], 1) = (&records[..], per_line) {
        // A record fills a line, so nothing is gathered.
        let comes = (!start & carries).registered("line_comes");
        let line_valid = (!start & comes).registered("line_valid");
        graph.output("line_valid", line_valid);
        graph.output("line", record.delay(1).named("line"));
        graph.output("done", (!start & all_out & !comes & !line_valid).registered("done"));
        return;
    }
    if let Some(per_word) = per_word(spec) {
        let words = gather(graph, "word_", start, carries, &records, per_word, all_out);
        (carries, records, all_out) = (words.comes, vec![words.line], words.all_out);
        per_line = spec.line_bits / WORD_BITS;
    }
    let lines = gather(graph, "", start, carries, &records, per_line, all_out);
    let line_valid = (!start & lines.comes).registered("line_valid");
    graph.output("line_valid", line_valid);
    graph.output("line", lines.line);
    graph.output("done", (!start & lines.all_out & !line_valid).registered("done"));
}
