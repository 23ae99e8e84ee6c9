//! The sieve, for `--results hits`: gives each contact its pair's number, moves the contacts of a cycle together in
//! order, and counts contacts and invalid pairs.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::{Spec, status};

/// A contact with the number of lanes that it still has to move.
#[derive(Clone, Copy)]
struct Lane<'g> {
    valid: Signal<'g>,
    /// Number of lanes that it still has to move.
    distance: Signal<'g>,
    entry: Signal<'g>,
}

/// Register ranks: one after each step of the compaction, at least one.
pub(super) fn ranks(lanes: u32) -> u32 {
    lanes.ilog2().max(1)
}

/// Builds the module `contact_afu_sieve`.
pub(super) fn sieve(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_sieve");
    graph.about("numbers contacts, moves those of a cycle together, counts contacts and invalid pairs");
    let (lanes, group_bits, result_bits) = (spec.lanes(), spec.group_bits(), spec.layout().result_bits());

    let start = graph.input("start", 1);
    let all_emerged = graph.input("all_emerged", 1);
    let results = status::results(&graph, lanes);
    let group = results.group.registered("group_here");
    let mut records = Vec::new();
    let mut contacts = Vec::new();
    let mut invalids = Vec::new();
    for lane in 0..lanes {
        if result_bits > 0 {
            records.push(graph.input(&format!("record_{lane}"), result_bits));
        }
        contacts.push(results.of(lane, "contact"));
        invalids.push(results.of(lane, "invalid"));
    }
    let emerged = status::emerged(&graph, start, group);

    // Each contact moves by the number of lanes before it without a contact.
    let steps = lanes.ilog2();
    let distance_bits = steps.max(1);
    let mut distance = graph.constant(distance_bits, 0);
    let mut hits = graph.constant(group_bits, 0);
    let mut row = Vec::new();
    for lane in 0..lanes {
        let index = lane as usize;
        let number = emerged.plus(u128::from(lane)).named(&format!("number_{lane}"));
        let entry = records.get(index).map_or(number, |record| record.concat(number));
        row.push(Lane { valid: contacts[index], distance, entry });
        distance = (distance + (!contacts[index]).extend(distance_bits)).named(&format!("gaps_to_{lane}"));
        hits = (hits + contacts[index].extend(group_bits)).named(&format!("hits_to_{lane}"));
    }
    // The lowest bit of all distances comes first, so that no contact moves onto another.
    for step in 0..steps {
        row = (0..row.len()).map(|lane| moved(&row, lane, step)).collect();
    }
    if steps == 0 {
        row[0].entry = row[0].entry.delay(1);
    }

    // The number of contacts travels beside them; the number of pairs without contact is known at once.
    let mut put = hits;
    let mut on_its_way = graph.constant(1, 0);
    for rank in 0..ranks(lanes) {
        put = put.gate(!start).registered(&format!("hits_rank_{rank}"));
        on_its_way = on_its_way | put.any();
    }
    graph.output("put", put);
    for (lane, contact) in row.iter().enumerate() {
        graph.output(&format!("entry_{lane}"), contact.entry);
    }
    if spec.config.decide > 0 {
        // Who keeps the pairs wants to know how many are decided, and whether a hit among them is still here.
        graph.output("emerged", emerged);
        graph.output("none_here", !on_its_way);
    } else {
        graph.output("dropped", (group - hits).gate(!start).registered("dropped_pairs"));
    }
    graph.output("all_out", all_emerged & !on_its_way);
    status::count(&graph, start, emerged.delay(1).named("emerged_before"), &contacts, &invalids);
    graph.finish()
}

/// The content of a lane after a step of the compaction: the contact that is `2^step` lanes further if it moves that
/// far, otherwise the lane's own contact if it stays.
fn moved<'g>(row: &[Lane<'g>], lane: usize, step: u32) -> Lane<'g> {
    let own = row[lane];
    let stays = own.valid & !own.distance.bit(step);
    let (valid, distance, entry) = match row.get(lane + (1 << step)) {
        None => (stays, own.distance, own.entry),
        Some(other) => {
            let comes = (other.valid & other.distance.bit(step)).named(&format!("comes_to_{lane}_in_{step}"));
            let of = |other, own| comes.select(other, own);
            (comes | stays, of(other.distance, own.distance), of(other.entry, own.entry))
        }
    };
    Lane { valid: valid.delay(1), distance: distance.delay(1), entry: entry.delay(1) }
}
