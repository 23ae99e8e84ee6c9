//! From the slots' results to the dispatcher: the modules that keep them, number them and pack them into lines.

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{BuildErrors, Graph, Instantiated, Module, Signal};

use super::feeder::room_to_enter;
use super::{Spec, backlog, feeder, packer, sieve};

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
    /// Enough room for every pair in SCPUs of this latency.
    pub(super) fn of(spec: &Spec, slot_latency: u32) -> Self {
        let layout = spec.layout();
        let slot_latency = slot_latency + spec.max_hops;
        // Results that are in the SCPUs or wait for their write request, and some more to bridge a stall of the link.
        let in_flight = (feeder::CYCLES_TO_ISSUE + slot_latency + spec.dispatch_cycles) * spec.lanes();
        let least_lines = spec.dispatch_cycles.next_power_of_two();
        match spec.config.results {
            Results::All => {
                let lines = in_flight.div_ceil(layout.contacts_per_line()) + spec.dispatch_cycles / 2;
                // A line that waits for more records must not block them.
                let least = (room_to_enter(spec) + layout.contacts_per_line()).div_ceil(layout.contacts_per_line());
                let lines = lines.max(least).next_power_of_two().max(least_lines);
                Self { results: lines * layout.contacts_per_line(), lines }
            }
            Results::Hits => {
                let results = in_flight.max(room_to_enter(spec)).next_power_of_two();
                Self { results, lines: least_lines.max(LEAST_LINES_OF_HITS) }
            }
        }
    }
}

/// The modules.
pub(super) struct Parts {
    packer: Arc<Module>,
    before: Option<[Arc<Module>; 2]>,
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
    pub(super) fn new(spec: &Spec, room: Room) -> Result<Self, BuildErrors> {
        let before = match spec.config.results {
            Results::All => None,
            Results::Hits => Some([sieve::sieve(spec)?, backlog::backlog(spec, room.results)?]),
        };
        Ok(Self { packer: packer::packer(spec)?, before })
    }

    /// The instances. `lanes` has the slots' outputs by name, which arrive one cycle after `leaves` says on which
    /// lanes. `accepts` is high while the dispatcher has room.
    pub(super) fn instances<'g>(
        &self,
        graph: &'g Graph,
        [begin, count, filled, leaves]: [Signal<'g>; 4],
        lanes: &[(String, Signal<'g>)],
        accepts: Option<Signal<'g>>,
    ) -> Packed<'g> {
        let mut inputs = vec![("start", begin), ("count", count), ("filled", filled), ("leaves", leaves)];
        inputs.extend(lanes.iter().map(|(name, signal)| (name.as_str(), *signal)));
        let (Some([sieve, backlog]), Some(accepts)) = (&self.before, accepts) else {
            let packer = graph.instance("packer", &self.packer, &inputs);
            return Packed { status: packer.clone(), packer, places_freed: None };
        };
        let outputs = |module: &Module, kind: &str| -> Vec<String> {
            let ports = module.ports.iter().filter(|port| port.output && port.name.starts_with(kind));
            ports.map(|port| port.name.clone()).collect()
        };
        let sieve_out = graph.instance("sieve", sieve, &inputs);
        let entries = outputs(sieve, "entry_");
        let mut inputs = vec![("start", begin), ("put", sieve_out.output("put")), ("may_leave", accepts)];
        inputs.extend(entries.iter().map(|name| (name.as_str(), sieve_out.output(name))));
        let backlog_out = graph.instance("backlog", backlog, &inputs);
        let records = outputs(backlog, "record_");
        let all_out = (sieve_out.output("all_out") & backlog_out.output("empty")).named("all_out");
        let mut inputs = vec![("start", begin), ("group", backlog_out.output("group")), ("all_out", all_out)];
        inputs.extend(records.iter().map(|name| (name.as_str(), backlog_out.output(name))));
        let packer = graph.instance("packer", &self.packer, &inputs);
        let dropped = sieve_out.output("dropped");
        let width = dropped.width() + 1;
        let freed = (dropped.extend(width) + backlog_out.output("group").extend(width)).named("places_freed");
        Packed { packer, status: sieve_out, places_freed: Some(freed) }
    }
}
