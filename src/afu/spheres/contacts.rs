//! What stands behind the hits: the SCPUs that compute their contacts, or nothing.

use std::sync::Arc;

use super::resolver::resolver;
use super::waiting::waiting_hits;
use super::{Sizes, hits};
use crate::afu::{Spec, resolver as units};
use crate::hdl::{BuildErrors, Graph, Instantiated, Module, Signal};

/// Lines that the dispatcher holds if only numbers come back.
pub(super) const LINES: u32 = 32;

/// What leaves for the packer, and what the hits are told.
pub(super) struct Behind<'g> {
    /// One bit: a row that is searched has ended.
    pub(super) row_ends: Signal<'g>,
    /// One bit: hits may leave; `None` if they wait for nothing but room in a line.
    pub(super) may_leave: Option<Signal<'g>>,
    /// Which records come.
    pub(super) carries: Signal<'g>,
    /// One bit: the last record is out.
    pub(super) all_out: Signal<'g>,
    /// The records.
    pub(super) records: Vec<Signal<'g>>,
    /// Lines that the dispatcher holds.
    pub(super) lines: u32,
}

/// The hits of a job and the spheres that they speak of.
pub(super) struct Found<'a, 'g> {
    /// The module `hits`.
    pub(super) hits: &'a Instantiated<'g>,
    /// Hits that leave it in a cycle.
    pub(super) lanes: u32,
    /// The job begins, in the parts from the hits on.
    pub(super) begins: Signal<'g>,
    /// The job begins and runs, and the dispatcher accepts lines.
    pub(super) job: [Signal<'g>; 3],
    /// What writes the spheres: inputs of a resolver.
    pub(super) writes: &'a [(&'a str, Signal<'g>)],
}

/// Numbers alone come back.
pub(super) fn numbers<'g>(found: &Found<'_, 'g>) -> Behind<'g> {
    let Found { hits, lanes, .. } = found;
    Behind {
        row_ends: hits.output("row_ends"),
        may_leave: None,
        carries: hits.output("carries"),
        all_out: hits.output("all_out"),
        records: (0..*lanes).map(|lane| hits.output(&format!("record_{lane}"))).collect(),
        lines: LINES,
    }
}

/// Contacts come back, in the order of their hits, from as many SCPUs side by side as the configuration has.
pub(super) fn contacts<'g>(
    graph: &'g Graph,
    spec: &Spec,
    sizes: &Sizes,
    scpu: &Arc<Module>,
    found: &Found<'_, 'g>,
) -> Result<Behind<'g>, BuildErrors> {
    let Found { hits, lanes, begins, job: [start, run, accepts], writes } = found;
    let side_by_side = units::lanes(spec);
    let may_resolve = graph.wire("may_resolve", 1);
    let waiting = if side_by_side == 1 {
        None
    } else {
        let mut inputs = vec![("start", *begins), ("may_leave", may_resolve)];
        inputs.extend([("comes", hits.output("carries")), ("row_comes_to_end", hits.output("row_ends"))]);
        let names: Vec<_> = (0..*lanes).map(|lane| (format!("hit_{lane}"), format!("record_{lane}"))).collect();
        inputs.extend(names.iter().map(|(name, record)| (name.as_str(), hits.output(record))));
        Some(graph.instance("waiting_hits", &waiting_hits(sizes, side_by_side)?, &inputs))
    };
    let (from, to_number) = match &waiting {
        None => (*hits, hits::cycles_to_numbers(sizes.compared)),
        Some(waiting) => (waiting, units::BACKLOG_TO_NUMBER),
    };
    let carries = from.output("carries");
    let unit = resolver(spec, sizes, scpu, to_number - 1)?;
    let mut resolvers = Vec::new();
    for lane in 0..side_by_side {
        let numbers = from.output(&format!("record_{lane}"));
        let mut inputs = vec![("start", *begins), ("carries", carries.bit(lane)), ("numbers", numbers)];
        inputs.extend_from_slice(writes);
        let name = if side_by_side == 1 { "resolver".to_owned() } else { format!("resolver_{lane}") };
        resolvers.push(graph.instance(&name, &unit, &inputs));
    }
    let about = [*start, *run, carries, hits.output("all_out"), *accepts];
    let contacts = units::resolved(graph, spec, scpu, &resolvers, about);
    may_resolve.drive(contacts.may_leave);
    Ok(Behind {
        row_ends: from.output("row_ends"),
        may_leave: Some(waiting.map_or(may_resolve, |waiting| waiting.output("has_room"))),
        carries: contacts.comes,
        all_out: contacts.all_out,
        records: contacts.records,
        lines: units::lines(spec, scpu, to_number),
    })
}
