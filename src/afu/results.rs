//! From the slots' results to the dispatcher: the modules that keep them, number them and pack them into lines.

use std::sync::Arc;

use crate::config;
use crate::hdl::{BuildErrors, Graph, Instantiated, Module, Signal};

use super::feeder::room_to_enter;
use super::{Spec, backlog, feeder, packer, resolver, sieve};

/// If only contacts come back, half of the dispatcher's lines are reserved for lines that are in flight when it stops
/// the packer. There are up to six.
const LEAST_LINES_OF_HITS: u32 = 16;

/// The room for results.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Results that fit, counted from the entry of their pair: in the dispatcher's lines, or in the backlog.
    pub(super) results: u32,
    /// Lines that the dispatcher holds.
    pub(super) lines: u32,
}

impl Room {
    /// Enough room for every pair in slots of this specification and latency; behind deciders, the places of pairs that
    /// are decided or wait for the SCPUs that are `resolving`.
    pub(super) fn of(spec: &Spec, slot_latency: u32, resolving: Option<(&Spec, &Module)>) -> Self {
        let layout = spec.layout();
        let slot_latency = slot_latency + spec.max_hops;
        // Results that are in the SCPUs or wait for their write request, and some more to bridge a stall of the link.
        let in_flight = (feeder::CYCLES_TO_ISSUE + slot_latency + spec.dispatch_cycles) * spec.lanes();
        let least_lines = spec.dispatch_cycles.next_power_of_two();
        match spec.config.results {
            config::Results::All => {
                let lines = in_flight.div_ceil(layout.contacts_per_line()) + spec.dispatch_cycles / 2;
                // A line that waits for more records must not block them.
                let least = (room_to_enter(spec) + layout.contacts_per_line()).div_ceil(layout.contacts_per_line());
                let lines = lines.max(least).next_power_of_two().max(least_lines);
                Self { results: lines * layout.contacts_per_line(), lines }
            }
            config::Results::Hits => match resolving {
                Some((spec, scpu)) => Self {
                    results: resolver::places(spec, in_flight),
                    lines: resolver::lines(spec, scpu, resolver::BACKLOG_TO_NUMBER),
                },
                None => Self {
                    results: in_flight.max(room_to_enter(spec)).next_power_of_two(),
                    lines: least_lines.max(LEAST_LINES_OF_HITS),
                },
            },
        }
    }
}

/// The modules.
pub(super) struct Parts {
    packer: Arc<Module>,
    before: Option<[Arc<Module>; 2]>,
    /// Behind deciders, around the SCPU that computes contacts.
    resolver: Option<[Arc<Module>; 2]>,
}

/// What the first of them gets: the beginning of a job, whether all its pairs have left the slots, whether the delay
/// lines are filled, and the slots' outputs by name, which arrive one cycle after `leaves` says on which lanes.
pub(super) struct Results<'a, 'g> {
    pub(super) begin: Signal<'g>,
    pub(super) all_emerged: Signal<'g>,
    pub(super) filled: Signal<'g>,
    pub(super) leaves: Signal<'g>,
    pub(super) lanes: &'a [(String, Signal<'g>)],
}

/// What else these get if only contacts come back.
pub(super) struct OfHits<'g> {
    pub(super) run: Signal<'g>,
    /// True while the dispatcher has room.
    pub(super) accepts: Signal<'g>,
    /// The lanes on which pairs enter.
    pub(super) enters: Signal<'g>,
    /// The pairs on these lanes, one cycle later.
    pub(super) pairs: Signal<'g>,
}

/// Their instances, as far as other parts use them.
pub(super) struct Packed<'g> {
    /// Outputs lines, and signals when the last has left.
    pub(super) packer: Instantiated<'g>,
    /// Outputs the counts of the status.
    pub(super) status: Instantiated<'g>,
    /// Places that are free again, if only contacts come back.
    pub(super) places_freed: Option<Signal<'g>>,
}

impl Parts {
    /// The modules with this room; behind deciders, around the SCPU that computes contacts.
    pub(super) fn new(spec: &Spec, room: Room, resolving: Option<&Arc<Module>>) -> Result<Self, BuildErrors> {
        let deciding = spec.deciding();
        let resolver = match resolving {
            Some(scpu) => Some([resolver::of_pairs(spec, scpu, room.results)?, scpu.clone()]),
            None => None,
        };
        let before = match spec.config.results {
            config::Results::All => None,
            config::Results::Hits => {
                let leaving = if resolver.is_some() { 1 } else { spec.leaving() };
                let spec = deciding.as_ref().unwrap_or(spec);
                Some([sieve::sieve(spec)?, backlog::backlog(spec, room.results, leaving)?])
            }
        };
        let packer = if resolver.is_some() { packer::of_pairs(spec, 1)? } else { packer::packer(spec)? };
        Ok(Self { packer, before, resolver })
    }

    /// The instances.
    pub(super) fn instances<'g>(
        &self,
        graph: &'g Graph,
        spec: &Spec,
        results: &Results<'_, 'g>,
        of_hits: Option<OfHits<'g>>,
    ) -> Packed<'g> {
        let start = ("start", results.begin);
        let mut inputs = vec![start, ("all_emerged", results.all_emerged)];
        inputs.extend([("filled", results.filled), ("leaves", results.leaves)]);
        inputs.extend(results.lanes.iter().map(|(name, signal)| (name.as_str(), *signal)));
        let (Some([sieve, backlog]), Some(OfHits { run, accepts, enters, pairs })) = (&self.before, of_hits) else {
            let packer = graph.instance("packer", &self.packer, &inputs);
            return Packed { status: packer.clone(), packer, places_freed: None };
        };
        let outputs = |module: &Module, kind: &str| -> Vec<String> {
            let ports = module.ports.iter().filter(|port| port.output && port.name.starts_with(kind));
            ports.map(|port| port.name.clone()).collect()
        };
        let sieve_out = graph.instance("sieve", sieve, &inputs);
        let entries = outputs(sieve, "entry_");
        let may_leave = graph.wire("may_leave", 1);
        let mut inputs = vec![start, ("put", sieve_out.output("put")), ("may_leave", may_leave)];
        inputs.extend(entries.iter().map(|name| (name.as_str(), sieve_out.output(name))));
        let backlog_out = graph.instance("backlog", backlog, &inputs);
        let empty = backlog_out.output("empty");
        let all_out = (sieve_out.output("all_out") & empty).named("all_out");
        if let Some([resolver, scpu]) = &self.resolver {
            let carries = backlog_out.output("group");
            let inputs = [
                start,
                ("carries", carries),
                ("number", backlog_out.output("record_0")),
                ("enters", enters),
                ("pairs", pairs),
                ("decided", sieve_out.output("emerged")),
                ("none_waits", sieve_out.output("none_here") & empty),
            ];
            let resolver = graph.instance("resolver", resolver, &inputs);
            let about = [results.begin, run, carries, all_out, accepts];
            let contacts = resolver::resolved(graph, spec, scpu, std::slice::from_ref(&resolver), about);
            may_leave.drive(contacts.may_leave);
            let (carries, record) = (contacts.comes, contacts.records[0]);
            let inputs = [start, ("carries", carries), ("record_0", record), ("all_out", contacts.all_out)];
            let packer = graph.instance("packer", &self.packer, &inputs);
            return Packed { packer, status: sieve_out, places_freed: Some(resolver.output("freed")) };
        }
        may_leave.drive(accepts);
        let records = outputs(backlog, "record_");
        let mut inputs = vec![start, ("group", backlog_out.output("group")), ("all_out", all_out)];
        inputs.extend(records.iter().map(|name| (name.as_str(), backlog_out.output(name))));
        let packer = graph.instance("packer", &self.packer, &inputs);
        let dropped = sieve_out.output("dropped");
        let width = dropped.width() + 1;
        let freed = (dropped.extend(width) + backlog_out.output("group").extend(width)).named("places_freed");
        Packed { packer, status: sieve_out, places_freed: Some(freed) }
    }
}
