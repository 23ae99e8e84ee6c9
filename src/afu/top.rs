//! The accelerator as a whole: the controller's parts, the array of SCPUs, and the line port as the top.

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{BuildErrors, Graph, Module, Signal};
use crate::record::Capability;

use super::control::control;
use super::port::{JobInputs, JobOutputs, ReadInputs, ReadOutputs, WriteInputs, WriteOutputs, outputs};
use super::results::{Parts, Room};
use super::{MAX_SCPUS, SCPU_BITS, Spec};
use super::{collector, dispatcher, feeder, slot};

/// Register ranks around the slots: results are registered after they were or-ed together.
pub(super) const RANKS_AFTER: u32 = 1;

/// The top over the plain line port, around an SCPU.
pub(super) fn line_top(spec: &Spec, unit: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let (lanes, group_bits) = (spec.lanes(), spec.group_bits());
    let slot_latency = slot::latency(unit.latency);
    let has_records = spec.layout().result_bits() > 0;
    let only_hits = spec.config.results == Results::Hits;
    let places = Room::of(spec, slot_latency);

    let control = control(spec, places.results)?;
    let collector = collector::collector(spec)?;
    let feeder = feeder::feeder(spec)?;
    let slot = slot::slot(spec, unit)?;
    let results = Parts::new(spec, places)?;
    let dispatcher = dispatcher::dispatcher(spec, places.lines)?;

    let graph = Graph::new("contact_afu");
    graph.about("collision-detection accelerator: a controller and SCPUS sphere collision processing units");
    graph.about(format!("an SCPU's latency is {} cycles", unit.latency));
    let scpus = graph.parameter("SCPUS", spec.config.scpus, 1..=MAX_SCPUS, SCPU_BITS);
    // SCPUs that never have a turn are not built.
    let in_turn = match spec.full_rate() {
        Some(multiple) if multiple < MAX_SCPUS => graph.rounded_down("SCPUS_IN_TURN", scpus, multiple),
        _ => scpus,
    };
    let job = JobInputs::of(spec).map(|port| port.input(&graph));
    let reads = ReadInputs::of(spec).map(|port| port.input(&graph));
    let writes = WriteInputs::of(spec).map(|port| port.input(&graph));

    // Signals that flow back. Control receives signals from all other parts.
    let wire = |name: &str, width: u32| graph.wire(name, width);
    let (read_failed, write_failed) = (wire("read_failed", 1), wire("write_failed", 1));
    let (response, unexpected, link_idle) = (wire("response", 1), wire("unexpected", 1), wire("link_idle", 1));
    let (packed, dispatched) = (wire("packer_done", 1), wire("dispatched", 1));
    let (entered, emerged) = (wire("entered", group_bits), wire("emerged", group_bits));
    let (line_left, take) = if only_hits {
        (wire("places_free_again", group_bits + 1), wire("take_line", 1))
    } else {
        (wire("line_left", 1), wire("take_line", 1))
    };
    let accepts = only_hits.then(|| wire("dispatcher_accepts", 1));
    let overflowed = only_hits.then(|| wire("overflowed", 1));
    let (waits_for_input, waits_for_output) = (wire("waits_for_input", 1), wire("waits_for_output", 1));
    let mut control_inputs = job.named();
    control_inputs.extend([
        ("read_failed", read_failed),
        ("write_failed", write_failed),
        ("unexpected", unexpected),
        ("response", response),
        ("link_idle", link_idle),
        ("packer_done", packed),
        ("dispatched", dispatched),
        ("entered", entered),
        ("emerged", emerged),
        (if only_hits { "places_freed" } else { "line_left" }, line_left),
        ("waits_for_input", waits_for_input),
        ("waits_for_output", waits_for_output),
    ]);
    control_inputs.extend(overflowed.map(|overflowed| ("overflowed", overflowed)));
    let control = graph.instance("control", &control, &control_inputs);
    let begin = control.output("begin_job");
    let run = control.output("run");
    let job_epoch = control.output("job_epoch");
    let job_count = control.output("job_count");

    let mut collector_inputs = reads.named();
    collector_inputs.extend([
        ("start", begin),
        ("run", run),
        ("source", control.output("job_source")),
        ("lines", control.output("lines")),
        ("epoch", job_epoch),
        ("take", take),
    ]);
    let collector = graph.instance("collector", &collector, &collector_inputs);
    let feeder = graph.instance(
        "feeder",
        &feeder,
        &[
            ("start", begin),
            ("run", run),
            ("scpus", in_turn),
            ("lines", control.output("lines")),
            ("last_place", control.output("last_place")),
            ("line_valid", collector.output("line_valid")),
            ("line", collector.output("line")),
            ("may_enter", control.output("may_enter")),
        ],
    );
    take.drive(feeder.output("take"));
    entered.drive(feeder.output("entered"));
    waits_for_input.drive(feeder.output("waits_for_input"));
    waits_for_output.drive(feeder.output("waits_for_output"));

    // A group's size and first SCPU are delayed beside the SCPUs, so that the results are identified when they leave.
    // They arrive one cycle before the pairs, and leave one cycle before the results.
    let group = feeder.output("issue_group");
    let turn = feeder.output("issue_turn");
    let (group_out, turn_out) = alongside(&graph, group, turn, slot_latency);
    let mut slot_inputs = vec![
        ("scpus", in_turn),
        ("in_turn", turn),
        ("pairs", feeder.output("issue_pairs")),
        ("out_group", group_out),
        ("out_turn", turn_out),
    ];
    if spec.config.interval > 1 {
        slot_inputs.push(("in_group", group));
    }
    let slots = graph.array("slots", &slot, in_turn, &slot_inputs);
    // The slots' results arrive one cycle after `group_out`, and are registered once more after the or. So their number
    // is known one cycle ahead.
    let group_done = group_out.registered("group_done");
    let kinds = ["record", "contact", "invalid"].into_iter().filter(|kind| has_records || *kind != "record");
    let lane_outputs: Vec<(String, Signal<'_>)> = (0..lanes)
        .flat_map(|lane| kinds.clone().map(move |what| format!("{what}_{lane}")))
        .map(|name| (name.clone(), slots.output(&name).delay(RANKS_AFTER)))
        .collect();
    let packed_results = results.instances(&graph, [begin, job_count, group_done], &lane_outputs, accepts);
    let packer = packed_results.packer;
    let mut dispatcher_inputs = writes.named();
    dispatcher_inputs.extend([
        ("start", begin),
        ("run", run),
        ("destination", control.output("job_destination")),
        ("epoch", job_epoch),
        ("line_valid", packer.output("line_valid")),
        ("line", packer.output("line")),
    ]);
    if only_hits {
        dispatcher_inputs.push(("lines", control.output("job_destination_lines")));
    }
    let dispatcher = graph.instance("dispatcher", &dispatcher, &dispatcher_inputs);
    accepts.into_iter().for_each(|wire| wire.drive(dispatcher.output("accepts")));
    overflowed.into_iter().for_each(|wire| wire.drive(dispatcher.output("overflowed")));
    read_failed.drive(collector.output("failed"));
    write_failed.drive(dispatcher.output("failed"));
    response.drive(collector.output("answered") | dispatcher.output("answered"));
    unexpected.drive(collector.output("unexpected") | dispatcher.output("unexpected"));
    link_idle.drive(collector.output("idle") & dispatcher.output("idle"));
    packed.drive(packer.output("done"));
    dispatched.drive(dispatcher.output("empty"));
    emerged.drive(group_done);
    line_left.drive(packed_results.places_freed.unwrap_or_else(|| dispatcher.output("line_left")));

    let told = JobOutputs {
        busy: control.output("busy"),
        done: control.output("done"),
        error: control.output("error"),
        contacts: packed_results.status.output("contacts"),
        invalid: packed_results.status.output("invalid"),
        first_invalid: packed_results.status.output("first_invalid"),
        cycles_busy: control.output("cycles_busy"),
        cycles_input: control.output("cycles_input"),
        cycles_output: control.output("cycles_output"),
        capability: capability(&graph, spec, scpus, unit.latency),
    };
    outputs(&graph, told.named());
    outputs(&graph, ReadOutputs::of(spec).map(|port| collector.output(port.name)).named());
    outputs(&graph, WriteOutputs::of(spec).map(|port| dispatcher.output(port.name)).named());
    graph.finish()
}

/// Group size and turn, `cycles` ago. The content of a delay line is not reset, so group sizes count only once the line
/// has been filled since reset.
fn alongside<'g>(graph: &'g Graph, group: Signal<'g>, turn: Signal<'g>, cycles: u32) -> (Signal<'g>, Signal<'g>) {
    let age_bits = cycles.ilog2() + 1;
    let age = graph.register("cycles_since_reset", age_bits, 0);
    let settled = age.is(u128::from(cycles)).named("settled");
    age.next(settled.select(*age, age.plus(1)));
    let travelled = group.concat(turn).named("travels").delay(cycles).named("travelled");
    let group_out = travelled.high(group.width()).gate(settled).named("group_out");
    (group_out, travelled.low(turn.width()).named("turn_out"))
}

/// Properties that the host may rely on: see [`Capability`]. The parameter gives the number of SCPUs.
fn capability<'g>(graph: &'g Graph, spec: &Spec, scpus: Signal<'g>, latency: u32) -> Signal<'g> {
    let word = u128::from(Capability::new(&spec.config, latency).bits());
    let constant = |low: u32, width: u32| graph.constant(width, word >> low & ((1 << width) - 1));
    Signal::join(&[constant(32, 32), constant(16, 16), constant(8, 8), scpus.extend(8)])
}
