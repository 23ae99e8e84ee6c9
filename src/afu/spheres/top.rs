//! The accelerator that takes spheres: the search between collector and dispatcher.

use std::sync::Arc;

use super::between::{Parts, named, parts, stage_queue};
use super::contacts::{Found, contacts, numbers};
use super::level::{Level, level};
use super::{LONG_QUEUE, QUEUE, ROW, ROW_BITS, Sizes, candidates, decider, hits, loader, near, rows};
use crate::afu::control::control;
use crate::afu::port::{JobInputs, JobOutputs, ReadInputs, ReadOutputs, WriteInputs, WriteOutputs, outputs};
use crate::afu::{Spec, collector, dispatcher, packer, resolver};
use crate::count::counted;
use crate::hdl::{BuildErrors, Error, Graph, Module, Signal};
use crate::record::Capability;

/// The top over the plain line port, around a kernel of `--contact hit` that decides, and the SCPU that computes the
/// contacts; `None` if only their numbers come back.
pub(in crate::afu) fn spheres_top(
    spec: &Spec,
    kernel: &Arc<Module>,
    scpu: Option<&Arc<Module>>,
) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu");
    graph.about("collision-detection accelerator: spheres in, the numbers of those that touch out");
    let side_by_side = resolver::lanes(spec);
    if scpu.is_some() {
        let units = side_by_side * resolver::units(spec);
        let per = match spec.config.interval {
            0 | 1 => "cycle".to_owned(),
            interval => format!("{interval} cycles"),
        };
        graph
            .about(format!("contacts are computed by {}: {units} every {per}, at most", counted(units.into(), "SCPU")));
    }
    let sizes = Sizes::of(&spec.config).map_err(|refused| {
        let place = std::panic::Location::caller();
        BuildErrors(vec![Error { module: "contact_afu".to_owned(), message: refused.to_string(), place }])
    })?;
    let job = JobInputs::of(spec).map(|port| port.input(&graph));
    let reads = ReadInputs::of(spec).map(|port| port.input(&graph));
    let writes = WriteInputs::of(spec).map(|port| port.input(&graph));
    let wire = |name: &'static str, width: u32| (name, graph.wire(name, width));
    let one = graph.constant(1, 1);

    let told_to_control = ["read_failed", "write_failed", "read_responded", "write_responded", "read_answered"]
        .into_iter()
        .chain(["write_answered", "read_idle", "write_idle", "packer_done", "dispatched"])
        .chain(["waits_for_input", "waits_for_output", "overflowed"]);
    let told: Vec<_> = told_to_control.map(|name| wire(name, 1)).collect();
    let (_, taken) = wire("line_taken", 1);
    let (_, head) = wire("line_place", spec.max_outstanding.ilog2());
    let (_, accepts) = wire("dispatcher_accepts", 1);
    // What later stages tell earlier ones.
    let (_, row_ends) = wire("row_ends", 1);
    let (_, has_room) = wire("steps_have_room", 1);

    // No delay line says when something happens, so a job may begin at once. What is inside when a job is stopped
    // neither leaves nor counts, and the next job's start removes it.
    let control_inputs = [job.named(), told.clone(), vec![("none_inside", one), ("filled", one)]].concat();
    let control = graph.instance("control", &control(spec)?, &control_inputs);
    let begin = |part: &str| control.output(&format!("begin_{part}"));
    let run = control.output("run");
    let drops = control.output("drops_requests");
    let epoch = control.output("job_epoch");
    let has_others = control.output("has_others");
    let keeps_table = control.output("keeps_table");

    let mut collector_inputs = reads.named();
    collector_inputs.extend([
        ("start", begin("collector")),
        ("run", run),
        ("drops_requests", drops),
        ("source", control.output("job_source")),
        ("lines", control.output("lines")),
        ("epoch", epoch),
        ("taken", taken),
        ("place", head),
    ]);
    let collector = graph.instance("collector", &collector::collector(spec)?, &collector_inputs);
    // It stays for a job, and the parts stand far from one another and from the control: each has a register of it.
    let one_set = (!has_others).copies("one_set", 4);
    let start = begin("loader");
    let loader = graph.instance(
        "loader",
        &loader::loader(spec, &sizes)?,
        &[
            ("start", start),
            ("run", run),
            ("count", control.output("job_count")),
            ("others", control.output("job_others")),
            ("one_set", one_set[0]),
            ("keeps_table", keeps_table),
            ("line_comes", collector.output("line_comes")),
            ("line", collector.output("line")),
            ("row_ends", row_ends),
        ],
    );
    taken.drive(loader.output("taken"));
    head.drive(loader.output("head"));
    let of_sphere = ["valid", "column", "row", "searched", "to_table"].map(|name| (name, loader.output(name)));
    let [(_, valid), (_, column), (_, row), (_, searched), (_, to_table)] = of_sphere;
    // What belongs to each sphere that is loaded in a cycle, as inputs of this name.
    let each = |output: &str, input: &str| -> Vec<(String, Signal<'_>)> {
        let outputs = sizes.of_loaded(output);
        outputs.iter().map(|name| loader.output(name)).zip(sizes.of_loaded(input)).map(|(s, name)| (name, s)).collect()
    };
    let boxes = each("box", "box");
    let table_row = row.low(sizes.row_bits);
    let write_own = (valid & searched).named("keeps_sphere");
    let write_table = (valid & to_table).named("puts_sphere_into_table");
    let mut inputs = vec![("start", start), ("keeps_table", keeps_table), ("has_others", has_others)];
    inputs.extend(of_sphere);
    inputs.extend(named(&boxes));
    let rows = graph.instance("rows", &rows::rows(&sizes)?, &inputs);

    // Groups of rows: one item a row.
    let (_, groups_takes) = wire("groups_take", 1);
    let words = stage_queue(
        &graph,
        start,
        ("row_queue", sizes.kept_rows()),
        rows.output("launches"),
        &[rows.output("launched_row"), rows.output("words"), one],
        groups_takes,
    )?;
    let queries = [
        ("table_last", rows.output("table_last")),
        ("write_query", rows.output("writes_query")),
        ("write_query_row", rows.output("row_box_row")),
        ("write_query_box", rows.output("row_box")),
    ];
    let item = Parts::of(&words);
    let (_, groups_may) = wire("groups_may_step", 1);
    let mut inputs = vec![
        ("start", start),
        ("may_step", groups_may),
        ("item_row", item.row),
        ("item_last", item.last),
        ("item_valid", item.valid),
        ("item_mask", item.mask),
        ("write", rows.output("writes_group_box")),
        ("write_column", rows.output("group_box_group").extend(ROW_BITS.max(sizes.group_bits)).low(ROW_BITS)),
        ("write_box", rows.output("group_box")),
    ];
    if sizes.top_bits > 0 {
        inputs.push(("write_word", rows.output("group_box_group").drop_low(ROW_BITS)));
    }
    inputs.push(("one_set", one_set[1]));
    inputs.extend(queries);
    let groups = graph.instance("groups", &level(spec, &sizes, Level::Groups)?, &inputs);
    groups_takes.drive(groups.output("takes"));

    // Rows of these groups.
    let (_, level_takes) = wire("group_rows_take", 1);
    let level_queue = stage_queue(
        &graph,
        start,
        ("group_queue", QUEUE),
        groups.output("put"),
        &parts(&groups, if sizes.top_bits > 0 { &["place"] } else { &[] }),
        level_takes,
    )?;
    groups_may.drive(level_queue.output("has_room"));
    let (_, level_may) = wire("group_rows_may_step", 1);
    let item = Parts::of(&level_queue);
    let mut inputs = vec![
        ("start", start),
        ("may_step", level_may),
        ("item_row", item.row),
        ("item_last", item.last),
        ("item_valid", item.valid),
        ("item_mask", item.mask),
        ("write", rows.output("writes_row_box")),
        ("write_column", rows.output("row_box_row").low(ROW_BITS)),
        ("write_word", rows.output("row_box_row").slice(ROW_BITS, sizes.group_bits)),
        ("write_box", rows.output("row_box")),
    ];
    inputs.push(("one_set", one_set[2]));
    inputs.extend(queries);
    inputs.extend(item.place.map(|place| ("item_place", place)));
    let group_rows = graph.instance("group_rows", &level(spec, &sizes, Level::Rows)?, &inputs);
    level_takes.drive(group_rows.output("takes"));

    // Spheres of the row against the boxes of those rows.
    let (_, near_takes) = wire("near_takes", 1);
    let near_queue = stage_queue(
        &graph,
        start,
        ("near_queue", LONG_QUEUE),
        group_rows.output("put"),
        &parts(&group_rows, &["place"]),
        near_takes,
    )?;
    level_may.drive(near_queue.output("has_room"));
    let (_, near_may) = wire("near_may_step", 1);
    let item = Parts::of(&near_queue);
    let mut inputs = vec![
        ("start", start),
        ("may_step", near_may),
        ("item_last", item.last),
        ("item_valid", item.valid),
        ("item_mask", item.mask),
        ("write", rows.output("writes_row_box")),
        ("item_row", item.row),
        ("write_row", rows.output("row_box_row").low(sizes.row_bits)),
        ("write_box", rows.output("row_box")),
        ("write_column", column),
        ("write_own", write_own),
        ("write_own_row", row),
    ];
    let own_boxes = each("box", "write_own_box");
    inputs.extend(named(&own_boxes));
    inputs.extend(item.place.map(|place| ("item_place", place)));
    let near = graph.instance("near", &near::near(spec, &sizes)?, &inputs);
    near_takes.drive(near.output("takes"));

    // Box against box.
    let (_, candidates_take) = wire("candidates_take", 1);
    let queue_of_near = stage_queue(
        &graph,
        start,
        ("candidate_queue", LONG_QUEUE),
        near.output("put"),
        &parts(&near, &["other", "spheres"]),
        candidates_take,
    )?;
    near_may.drive(queue_of_near.output("has_room"));
    let item = Parts::new(&queue_of_near, sizes.near_rows * sizes.turns());
    let mut inputs = vec![
        ("start", start),
        ("run", run),
        ("may_step", has_room),
        ("item_mask", item.mask),
        ("item_row", item.row),
        ("item_last", item.last),
        ("item_valid", item.valid),
        ("write", write_table),
        ("write_own", write_own),
        ("write_column", column),
        ("write_row", row),
        ("one_set", one_set[3]),
    ];
    let table_boxes = each("box", "write_box");
    inputs.extend(named(&table_boxes));
    let near_bits = sizes.near_rows * ROW;
    inputs.extend(item.place.map(|place| ("item_other", place.drop_low(near_bits))));
    inputs.extend(item.place.map(|place| ("item_near", place.low(near_bits))));
    let candidates = graph.instance("box_pairs", &candidates::candidates(spec, &sizes)?, &inputs);
    candidates_take.drive(candidates.output("takes"));
    let put = candidates.output("put");

    // The deciders, and what joins their answers.
    let own_row = candidates.output("row");
    let places = (sizes.places_bits() > 0).then(|| ("places", candidates.output("places")));
    let names = |prefix: &str| -> Vec<String> { (0..sizes.deciders).map(|d| format!("{prefix}_{d}")).collect() };
    let takes: Vec<_> = names("take_answer").iter().map(|name| graph.wire(name, 1)).collect();
    let decider = decider::decider(spec, &sizes, kernel)?;
    // Numbers go into lines as soon as there is room; contacts wait for it behind their SCPU.
    let line_has_room = (accepts & run).registered("line_has_room");
    let (_, hits_may_leave) = wire("hits_may_leave", 1);
    let mut hits_inputs = vec![
        ("start", begin("hits")),
        ("run", run),
        ("may_leave", if scpu.is_some() { hits_may_leave } else { line_has_room }),
        ("put", put),
        ("own_row", own_row),
        ("row", candidates.output("other")),
        ("last", candidates.output("last")),
        ("all_ended", loader.output("all_ended")),
    ];
    hits_inputs.extend(places);
    let (asks, valids, answers) = (names("asks"), names("answer_valid"), names("answer"));
    let spheres = each("sphere", "write_sphere");
    let kept_bits = sizes.kept_bits;
    let column_low = sizes.deciders.ilog2();
    for number in 0..sizes.deciders {
        let index = number as usize;
        let share = candidates.output(&format!("share_{number}"));
        let is_asked = share.any().named(&format!("asked_{number}"));
        // Of two spheres side by side, a decider has columns of one side.
        let side = (number % sizes.loaded) as usize;
        let low = column_low - sizes.loaded.ilog2();
        let is_mine = if low == 0 { one } else { column.low(low).is((number / sizes.loaded).into()) };
        let is_mine = (valid & is_mine).named(&format!("sphere_for_{number}"));
        let mut inputs = vec![
            ("start", begin("deciders")),
            ("put", put & is_asked),
            ("share", share),
            ("kept", own_row.low(kept_bits)),
            ("row", candidates.output("other")),
            ("take_answer", takes[index]),
            ("write_sphere_of_column", spheres[side].1),
            ("write_column", column),
            ("write_table", is_mine & to_table),
            ("write_kept", write_own),
            ("write_row", table_row),
            ("write_kept_row", row.low(kept_bits)),
        ];
        inputs.extend(places);
        inputs.extend(named(&spheres));
        let unit = graph.instance(&format!("decider_{number}"), &decider, &inputs);
        hits_inputs.push((&asks[index], is_asked));
        hits_inputs.push((&valids[index], unit.output("answer_valid")));
        hits_inputs.push((&answers[index], unit.output("answer")));
    }
    // Behind SCPUs that take one hit per cycle, or none, there is nothing to be joined.
    let lanes = if scpu.is_some() && side_by_side == 1 { 1 } else { hits::HIT_LANES };
    let hits = graph.instance("hits", &hits::hits(&sizes, lanes)?, &hits_inputs);
    for (take, name) in takes.into_iter().zip(names("take_answer")) {
        take.drive(hits.output(&name));
    }
    has_room.drive(hits.output("has_room"));
    // The contacts of the hits, if more than numbers come back.
    let mut resolver_writes = vec![
        ("write_column", column),
        ("write_table", write_table),
        ("write_table_row", table_row),
        ("write_kept", write_own),
        ("write_kept_row", row.low(kept_bits)),
    ];
    resolver_writes.extend(named(&spheres));
    let found =
        Found { hits: &hits, lanes, begins: begin("hits"), job: [start, run, accepts], writes: &resolver_writes };
    let behind = match scpu {
        Some(scpu) => contacts(&graph, spec, &sizes, scpu, &found)?,
        None => numbers(&found),
    };
    row_ends.drive(behind.row_ends);
    hits_may_leave.drive(behind.may_leave.unwrap_or(one));
    let names: Vec<_> = (0..behind.records.len()).map(|lane| format!("record_{lane}")).collect();
    let mut packer_inputs = vec![("start", begin("packer")), ("carries", behind.carries), ("all_out", behind.all_out)];
    packer_inputs.extend(names.iter().map(String::as_str).zip(behind.records));

    // Records into lines, lines into memory.
    let packer = graph.instance(
        "packer",
        &packer::of_pairs(spec, if scpu.is_some() { side_by_side } else { lanes })?,
        &packer_inputs,
    );
    let mut inputs = writes.named();
    inputs.extend([
        ("start", begin("dispatcher")),
        ("run", run),
        ("drops_requests", drops),
        ("destination", control.output("job_destination")),
        ("epoch", epoch),
        ("line_valid", packer.output("line_valid")),
        ("line", packer.output("line")),
        ("lines", control.output("job_destination_lines")),
    ]);
    let dispatcher = graph.instance("dispatcher", &dispatcher::dispatcher(spec, behind.lines)?, &inputs);
    accepts.drive(dispatcher.output("accepts"));
    for (name, wire) in told {
        wire.drive(match name {
            "packer_done" => packer.output("done"),
            "dispatched" => dispatcher.output("empty"),
            "waits_for_input" => loader.output("waits_for_input"),
            "waits_for_output" => hits.output("waits"),
            _ => match name.split_once('_') {
                Some(("read", told)) => collector.output(told),
                Some(("write", told)) => dispatcher.output(told),
                _ => dispatcher.output(name),
            },
        });
    }

    let word = u128::from(Capability::new(&spec.config, kernel.latency).bits());
    let told = JobOutputs {
        busy: control.output("busy"),
        done: control.output("done"),
        error: control.output("error"),
        contacts: hits.output("contacts"),
        candidates: Some(candidates.output("candidates")),
        invalid: loader.output("invalid"),
        first_invalid: loader.output("first_invalid"),
        cycles_busy: control.output("cycles_busy"),
        cycles_input: control.output("cycles_input"),
        cycles_output: control.output("cycles_output"),
        capability: graph.constant(64, word),
    };
    outputs(&graph, told.named());
    outputs(&graph, ReadOutputs::of(spec).map(|port| collector.output(port.name)).named());
    outputs(&graph, WriteOutputs::of(spec).map(|port| dispatcher.output(port.name)).named());
    graph.finish()
}
