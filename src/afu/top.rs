//! The accelerator as a whole: the controller's parts, the array of SCPUs, and the line port as the top.

use std::sync::Arc;

use crate::config;
use crate::count::counted;
use crate::hdl::{BuildErrors, Graph, Module, Signal};
use crate::record::Capability;

use super::control::control;
use super::port::{JobInputs, JobOutputs, ReadInputs, ReadOutputs, WriteInputs, WriteOutputs, outputs};
use super::results::{OfHits, Parts, Results, Room};
use super::{MAX_SCPUS, SCPU_BITS, Spec};
use super::{collector, credits, dispatcher, feeder, resolver, slot, status};

/// The top over the plain line port, around an SCPU. With `--decide` it is one that decides, and `resolving` the one
/// that computes contacts.
pub(super) fn line_top(
    spec: &Spec,
    unit: &Arc<Module>,
    resolving: Option<&Arc<Module>>,
) -> Result<Arc<Module>, BuildErrors> {
    let deciding = spec.deciding();
    // The specification of the slots, and of what gives them pairs and takes their results.
    let of_slots = deciding.as_ref().unwrap_or(spec);
    let lanes = spec.lanes();
    let slot_latency = slot::latency(of_slots, unit.latency);
    let has_records = of_slots.layout().result_bits() > 0;
    let only_hits = spec.config.results == config::Results::Hits;
    let places = Room::of(of_slots, slot_latency, resolving.map(|scpu| (spec, &**scpu)));

    let control = control(spec)?;
    let credits = credits::credits(of_slots, places.results, slot_latency)?;
    let collector = collector::collector(spec)?;
    let feeder = feeder::feeder(of_slots)?;
    let name = if deciding.is_some() { "decider_slot" } else { "scpu_slot" };
    let slot = slot::slot(of_slots, name, unit)?;
    let results = Parts::new(spec, places, resolving)?;
    let dispatcher = dispatcher::dispatcher(spec, places.lines)?;

    let graph = Graph::new("contact_afu");
    let scpus = if let Some(deciding) = &deciding {
        let (deciders, resolvers) = (deciding.config.scpus, resolver::units(spec));
        graph.about(format!(
            "collision-detection accelerator: a controller, {}, and {} for the pairs that touch",
            counted(deciders.into(), "decider"),
            counted(resolvers.into(), "SCPU")
        ));
        graph.constant(SCPU_BITS, deciders.into())
    } else {
        graph.about("collision-detection accelerator: a controller and SCPUS sphere collision processing units");
        graph.about(format!("an SCPU's latency is {} cycles, and one more for each SCPU in the chain", unit.latency));
        graph.parameter("SCPUS", spec.config.scpus, 1..=MAX_SCPUS, SCPU_BITS)
    };
    // SCPUs that never have a turn are not built.
    let in_turn = match of_slots.full_rate() {
        Some(multiple) if multiple < MAX_SCPUS => graph.rounded_down("SCPUS_IN_TURN", scpus, multiple),
        _ => scpus,
    };
    let job = JobInputs::of(spec).map(|port| port.input(&graph));
    let reads = ReadInputs::of(spec).map(|port| port.input(&graph));
    let writes = WriteInputs::of(spec).map(|port| port.input(&graph));

    // Signals that flow back. Control and credits hear from all other parts.
    let wire = |name: &'static str, width: u32| (name, graph.wire(name, width));
    let told_to_control = ["read_failed", "write_failed", "read_responded", "write_responded", "read_answered"]
        .into_iter()
        .chain(["write_answered", "read_idle", "write_idle", "packer_done", "dispatched", "none_inside", "filled"])
        .chain(["waits_for_input", "waits_for_output"])
        .chain(only_hits.then_some("overflowed"));
    let told_to_control: Vec<_> = told_to_control.map(|name| wire(name, 1)).collect();
    let freed = if only_hits {
        wire("places_freed", credits::freed_bits(of_slots, places.results))
    } else {
        wire("line_left", 1)
    };
    let told_to_credits =
        vec![wire("entered", spec.group_bits()), wire("emerged", spec.group_bits()), wire("all_given", 1), freed];
    let (_, may_enter) = wire("may_enter", 1);
    let (_, taken) = wire("line_taken", 1);
    let (_, head) = wire("line_place", spec.max_outstanding.ilog2());
    let accepts = only_hits.then(|| wire("dispatcher_accepts", 1).1);

    let control_inputs = [job.named(), told_to_control.clone()].concat();
    let control = graph.instance("control", &control, &control_inputs);
    let begin = |part: &str| control.output(&format!("begin_{part}"));
    let run = control.output("run");
    let drops = control.output("drops_requests");
    let job_epoch = control.output("job_epoch");

    let mut credits_inputs = told_to_credits.clone();
    credits_inputs.extend([("start", begin("credits")), ("run", run), ("scpus", in_turn)]);
    let credits = graph.instance("credits", &credits, &credits_inputs);
    may_enter.drive(credits.output("may_enter"));

    let mut collector_inputs = reads.named();
    collector_inputs.extend([
        ("start", begin("collector")),
        ("run", run),
        ("drops_requests", drops),
        ("source", control.output("job_source")),
        ("lines", control.output("lines")),
        ("epoch", job_epoch),
        ("taken", taken),
        ("place", head),
    ]);
    let collector = graph.instance("collector", &collector, &collector_inputs);
    let feeder = graph.instance(
        "feeder",
        &feeder,
        &[
            ("start", begin("feeder")),
            ("run", run),
            ("scpus", in_turn),
            ("lines", control.output("lines")),
            ("last_place", control.output("last_place")),
            ("line_comes", collector.output("line_comes")),
            ("line", collector.output("line")),
            ("may_enter", may_enter),
        ],
    );
    taken.drive(feeder.output("taken"));
    head.drive(feeder.output("head"));

    // Pairs and results pass from slot to slot; the first one gets pairs from the feeder, and no results.
    let kinds = ["record", "contact", "invalid"].into_iter().filter(|kind| has_records || *kind != "record");
    let passing: Vec<String> =
        (0..lanes).flat_map(|lane| kinds.clone().map(move |kind| format!("{kind}_{lane}"))).collect();
    let passing = passing.into_iter().map(|name| {
        let width = slot.port(&format!("{name}_in")).map_or(1, |(_, port)| port.width);
        (name, graph.constant(width, 0))
    });
    let (carries, pairs) = (feeder.output("carries"), feeder.output("pairs"));
    let passed_on = ["targets", "names"].map(|name| (name, feeder.output(name)));
    let first = [("carries", carries), ("pairs", pairs)]
        .into_iter()
        .chain(passed_on)
        .chain([("leaves", graph.constant(lanes, 0))]);
    let passing: Vec<_> = first.map(|(name, signal)| (name.to_owned(), signal)).chain(passing).collect();
    let passed = match &deciding {
        Some(deciding) => slot::row(&graph, "decider", &slot, deciding.config.scpus, passing),
        None => slot::chain(&graph, "slots", &slot, in_turn, passing),
    };
    let leaves = passed.iter().find(|(name, _)| name == "leaves").map_or(carries, |(_, leaves)| *leaves);
    let lane_outputs: Vec<_> = passed.into_iter().filter(|(name, _)| name.contains('_')).collect();
    let all = Results {
        begin: begin("packer"),
        all_emerged: credits.output("all_emerged"),
        filled: credits.output("filled"),
        leaves,
        lanes: &lane_outputs,
    };
    let of_hits = accepts.map(|accepts| OfHits { run, accepts, enters: carries, pairs });
    let packed_results = results.instances(&graph, spec, &all, of_hits);
    let packer = packed_results.packer;
    let mut dispatcher_inputs = writes.named();
    dispatcher_inputs.extend([
        ("start", begin("dispatcher")),
        ("run", run),
        ("drops_requests", drops),
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
    for (name, wire) in told_to_control.into_iter().chain(told_to_credits) {
        wire.drive(match name {
            "packer_done" => packer.output("done"),
            "dispatched" => dispatcher.output("empty"),
            "none_inside" | "filled" => credits.output(name),
            "waits_for_input" | "waits_for_output" | "entered" | "all_given" => feeder.output(name),
            "emerged" => status::number(&graph, leaves),
            "places_freed" => packed_results.places_freed.unwrap_or(leaves),
            _ => match name.split_once('_') {
                Some(("read", told)) => collector.output(told),
                Some(("write", told)) => dispatcher.output(told),
                _ => dispatcher.output(name),
            },
        });
    }

    let told = JobOutputs {
        busy: control.output("busy"),
        done: control.output("done"),
        error: control.output("error"),
        contacts: packed_results.status.output("contacts"),
        candidates: None,
        invalid: packed_results.status.output("invalid"),
        first_invalid: packed_results.status.output("first_invalid"),
        cycles_busy: control.output("cycles_busy"),
        cycles_input: control.output("cycles_input"),
        cycles_output: control.output("cycles_output"),
        capability: capability(&graph, spec, scpus, unit.latency + resolving.map_or(0, |scpu| scpu.latency)),
    };
    outputs(&graph, told.named());
    outputs(&graph, ReadOutputs::of(spec).map(|port| collector.output(port.name)).named());
    outputs(&graph, WriteOutputs::of(spec).map(|port| dispatcher.output(port.name)).named());
    graph.finish()
}

/// Properties that the host may rely on: see [`Capability`]. The parameter, if there is one, gives the number of SCPUs.
fn capability<'g>(graph: &'g Graph, spec: &Spec, scpus: Signal<'g>, latency: u32) -> Signal<'g> {
    let word = u128::from(Capability::new(&spec.config, latency).bits());
    if spec.config.has_deciders() {
        return graph.constant(64, word);
    }
    let constant = |low: u32, width: u32| graph.constant(width, word >> low & ((1 << width) - 1));
    Signal::join(&[constant(32, 32), constant(16, 16), constant(8, 8), scpus.extend(8)])
}
