//! Control: takes a job, watches it, ends it. A job is done when its last write is acknowledged. On an abort, an
//! error response or an unexpected response, control stops requests, waits for outstanding responses, and ends the
//! job with an error. It waits as long as the watchdog allows, or [`DRAIN_CYCLES`] without a watchdog. Then it gives
//! up the outstanding requests. A request that is on the port by then stays there until the link accepts it, even
//! during later jobs; no other request follows it.

use std::sync::Arc;

use crate::config::Input;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::counter::cycles;
use super::port::{JobInputs, JobOutputs};
use super::{ADDRESS_BITS, COUNT_BITS, EPOCH_BITS, JobError, Spec};

/// Cycles without a response after which a job that is being stopped ends, if it has no watchdog.
pub const DRAIN_CYCLES: u32 = 1 << 16;

/// Cycles from what another part tells to control's knowing it.
pub(super) const CYCLES_TO_HEAR: u32 = 1;
/// Cycles from `start` high to the first cycle in which the parts run.
pub(super) const CYCLES_TO_RUN: u32 = 2;
/// Cycles from the end of all work, as the parts tell it, to `done`.
pub(super) const CYCLES_TO_DONE: u32 = 2;
/// Cycles, a power of two, after which all parts have stopped and control has heard it.
const CYCLES_TO_STOP: u32 = 8;

/// Spheres of the second set, at most: a hit numbers them with 16 bits.
const MOST_OTHERS: u32 = 1 << 16;

/// The parts that are told with a register of their own that a job begins.
const PARTS: [&str; 5] = ["collector", "feeder", "credits", "packer", "dispatcher"];
/// The same if spheres come in.
const PARTS_OF_SPHERES: [&str; 6] = ["collector", "loader", "deciders", "hits", "packer", "dispatcher"];

/// Builds the module `contact_afu_control`.
pub(super) fn control(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_control");
    graph.about("takes a job, watches it, ends it");

    let job = JobInputs::of(spec);
    let [start, source, destination, count, mode, epoch, watchdog, abort] =
        [&job.start, &job.source, &job.destination, &job.count, &job.mode, &job.epoch, &job.watchdog, &job.abort_job]
            .map(|port| port.input(&graph));
    let told = JobOutputs::of(spec);
    // What other parts tell comes from registers, and most of it is registered first.
    let begin = graph.register("begin_job", 1, 0);
    let input = |name: &str| graph.input(name, 1);
    let heard = |name: &str| input(name).registered(&format!("{name}_heard"));
    let [packed, dispatched] = ["packer_done", "dispatched"].map(input);
    let [none_inside, filled] = ["none_inside", "filled"].map(heard);
    let [read_failed, write_failed] = ["read_failed", "write_failed"].map(input);
    let [read_answered, write_answered] = ["read_answered", "write_answered"].map(input);
    let [read_responded, write_responded] = ["read_responded", "write_responded"].map(input);
    let answered = (read_answered | write_answered).named("response");
    let response = answered.registered("response_heard");
    // A response that answers no request. What arrives as a job completes is used only after the next one begins.
    let unexpected = (read_responded & !read_answered) | (write_responded & !write_answered);
    let unexpected = unexpected.named("unexpected");
    let begins = graph.wire("begins", 1);
    let unexpected = (unexpected & !begins).registered("unexpected_heard");
    let link_idle_now = (input("read_idle") & input("write_idle")).named("link_idle");
    let link_idle = link_idle_now.registered("link_idle_heard");
    let [waits_for_input, waits_for_output] = ["waits_for_input", "waits_for_output"].map(input);

    let running = graph.register("running", 1, 0);
    let draining = graph.register("draining", 1, 0);
    let done = graph.register("done", 1, 0);
    let error = graph.register("error", JobError::BITS, 0);
    let waits = graph.register("waits_to_begin", 1, 0);
    let run = graph.register("run", 1, 0);
    // A copy steers what control decides, one the values of a job, and one the wide addresses.
    let is_busy = graph.wire("is_busy", 1);
    let copies = is_busy.copies("busy", 3);
    let (busy, keeps_values, keeps_addresses) = (copies[0], copies[1], copies[2]);
    let accept = (start & !busy).named("accept");
    // One copy for each count of cycles.
    let first_cycles = accept.copies("first_cycle", 3);
    let takes_values = (start & !keeps_values).named("takes_values");

    // The job is held from its start; everything downstream begins one cycle later. The addresses are wide, so they
    // are loaded in every cycle without a job and do not depend on `start`. So are numbers that
    // matter only while a job runs.
    let job_source = graph.data_register("job_source", ADDRESS_BITS);
    job_source.next_if(!keeps_addresses, source);
    let job_destination = graph.data_register("job_destination", ADDRESS_BITS);
    job_destination.next_if(!keeps_addresses, destination);
    let job_epoch = graph.register("job_epoch", EPOCH_BITS, 0);
    job_epoch.next_if(takes_values, epoch);
    let job_watchdog = graph.register("job_watchdog", COUNT_BITS, 0);
    let has_watchdog = graph.register("has_watchdog", 1, 0);
    // A job without a watchdog that is to end gets one.
    let needs_watchdog = (*draining & !*has_watchdog).registered("needs_watchdog");
    has_watchdog.next(accept.select(watchdog.any(), *has_watchdog | needs_watchdog));
    let drain_cycles = watchdog.same(u128::from(DRAIN_CYCLES));
    job_watchdog.next_if(!keeps_values | needs_watchdog, needs_watchdog.select(drain_cycles, watchdog));
    let takes_spheres = spec.config.input == Input::Spheres;
    let (lines, has_unknown_mode, is_too_large) = match &job.others {
        Some(port) => spheres(&graph, spec, [takes_values, count, mode], port.input(&graph)),
        None => (pairs(spec, count), mode.any(), graph.constant(1, 0)),
    };
    let job_lines = graph.register("job_lines", COUNT_BITS, 0);
    job_lines.next_if(!keeps_values, lines);

    let stopping = graph.register("cycles_draining", CYCLES_TO_STOP.ilog2(), 0);
    let stopped = stopping.all().named("stopped");
    stopping.next(stopped.select(*stopping, stopping.plus(1)).gate(*draining));

    // Watchdog: cycles since the last response while a request is outstanding. The count restarts when the job is to
    // end. The register does not make a timely response late.
    let silence = graph.register("silence", COUNT_BITS, 0);
    let quiet = (response | link_idle.registered("link_idle_before")).named("link_is_alive");
    let restarts = graph.register("silence_restarts", 1, 1);
    silence.next(restarts.select(silence.same(0), silence.plus(1)));
    // It is compared one cycle before it is used: it will be above the watchdog's cycles.
    let is_over = (!*restarts & *has_watchdog & silence.at_least(*job_watchdog)).registered("silence_is_over");
    let expires = (busy & !quiet & is_over).named("expires");
    let expired = expires.registered("expired");

    // The end.
    let complete = graph.register("completes", 1, 0);
    // What is no job is refused one cycle after its start.
    let refuses = (accept & (has_unknown_mode | is_too_large)).registered("refuses");
    let has_unknown_mode = has_unknown_mode.delay(1).named("has_unknown_mode");
    let is_too_large = is_too_large.delay(1).named("is_too_large");
    // What ends a job early, in order of precedence. A refusal comes before all: it is known as the job begins to run.
    // The next three are known with their code from a register.
    let code_of = |error: JobError| graph.constant(JobError::BITS, error.code().into());
    let none = code_of(JobError::Aborted).same(0);
    let told_causes = [(write_failed, JobError::Write), (read_failed, JobError::Read), (abort, JobError::Aborted)];
    let told_cause = told_causes.into_iter().fold(none, |other, (fails, error)| fails.select(code_of(error), other));
    let told_cause = told_cause.gate(*running).registered("told_cause");
    let watched = unexpected.select(code_of(JobError::Response), expired.select(code_of(JobError::Watchdog), none));
    let cause = told_cause.any().select(told_cause, watched);
    let refusal = (is_too_large & !has_unknown_mode).select(code_of(JobError::Table), code_of(JobError::Mode));
    let cause = refuses.select(refusal, cause).named("cause");
    let fails = (*running & (abort | read_failed | write_failed)) | expires;
    let fails = fails.registered("fails");
    let failing = (*running & (fails | unexpected | refuses) & !*complete).named("failing");
    // A job that fails now does not complete in the next cycle.
    let goes_on = (*running & !*complete & !failing).named("goes_on");
    complete.next(*run & packed & dispatched & link_idle_now & goes_on);
    let complete = *complete;
    // This error takes precedence, because the host must know that late responses and late writes may still come.
    let gives_up = (busy & expired & !complete).named("gives_up");
    let given_up = graph.register("given_up", 1, 0);
    let is_given_up = (!accept & (*given_up | gives_up)).named("is_given_up");
    given_up.next(is_given_up);
    // The parts are stopped some cycles later.
    let drained = (*draining & stopped & none_inside & (link_idle | *given_up)).named("drained");
    running.next(accept | goes_on);
    is_busy.drive(accept | (busy & !complete & !drained));
    // A job begins once the delay lines are filled, and runs one cycle later. Each part has a copy of the beginning.
    // While one waits nothing is outstanding, so only a registered cause ends it.
    let still_waits = (*waits & !fails).named("still_waits");
    begins.drive((accept | still_waits) & filled);
    begin.next(begins);
    let names = if takes_spheres { &PARTS_OF_SPHERES[..] } else { &PARTS };
    let parts = begins.copies("begin_job", names.len() as u32);
    // Request ports drop what is behind their request after a reset, when a job begins, and while one is given up.
    let drops = graph.register("drops_requests", 1, 1);
    drops.next(begins | is_given_up);
    let keeps_waiting = (*waits & !failing).named("keeps_waiting");
    waits.next((accept | keeps_waiting) & !filled);
    run.next((*run | *begin) & goes_on);
    draining.next(failing | (*draining & !drained));
    restarts.next(answered | link_idle | failing | !is_busy);
    done.next(!accept & (*done | complete | drained));
    let failed = failing.select(cause, *error).named("failed");
    let mut ended = failed;
    if let Some(port) = &job.destination_lines {
        let overflowed = graph.input("overflowed", 1);
        ended = (complete & overflowed).select(error.same(JobError::Overflow.code().into()), failed);
        // The room for results in memory, for the dispatcher.
        let lines = port.input(&graph);
        let job_lines = graph.register("job_destination_lines", COUNT_BITS, 0);
        job_lines.next_if(!keeps_values, lines);
        graph.output("job_destination_lines", job_lines.value());
    }
    let ended = gives_up.select(error.same(JobError::Watchdog.code().into()), ended).named("ended");
    // A job is accepted if no running job could end. This condition is last in the expression because it is known
    // last.
    error.next(ended.gate(!accept));

    // The counts begin one cycle after the start, and include that cycle, in which nothing waits yet.
    let [counts_input, counts_output] = [("counts_input", waits_for_input), ("counts_output", waits_for_output)]
        .map(|(name, waits)| (accept | (waits & *run)).registered(name));
    let counts =
        [(told.cycles_busy, busy, 1), (told.cycles_input, counts_input, 0), (told.cycles_output, counts_output, 0)];
    for ((port, counts, first), restart) in counts.into_iter().zip(&first_cycles) {
        graph.output(port.name, cycles(&graph, port.name, port.bits, [*restart, counts], first));
    }
    graph.output("busy", busy);
    graph.output("done", done.value());
    graph.output("error", error.value());
    for (part, begin) in names.iter().zip(parts) {
        graph.output(&format!("begin_{part}"), begin);
    }
    graph.output("run", run.value());
    graph.output("drops_requests", drops.value());
    graph.output("job_source", job_source.value());
    graph.output("job_destination", job_destination.value());
    graph.output("job_epoch", job_epoch.value());
    graph.output("lines", job_lines.value());
    if spec.config.input == Input::Direct {
        // The last pair's place in its line.
        let bits = spec.layout().pairs_per_line().ilog2();
        let last_place = graph.data_register("last_place", bits.max(1));
        let fewer = count.low(bits.max(1)).minus(1);
        last_place.next_if(takes_values, if bits == 0 { fewer.same(0) } else { fewer });
        graph.output("last_place", last_place.value());
    }
    graph.finish()
}

/// The source lines of a job of pairs.
fn pairs<'g>(spec: &Spec, count: Signal<'g>) -> Signal<'g> {
    let per_line = spec.layout().pairs_per_line();
    let rounded = count.extend(COUNT_BITS + 1).plus(u128::from(per_line - 1)).named("rounded_count");
    rounded.drop_low(per_line.ilog2()).extend(COUNT_BITS + 1).low(COUNT_BITS)
}

/// The source lines of a job of spheres, whether its mode is unknown, and whether a set is too large. Mode 0 is one
/// set, 1 are two sets, 2 is a second set against the table as it is. Both sets begin at a row, which is four lines.
fn spheres<'g>(
    graph: &'g Graph,
    spec: &Spec,
    [takes, count, mode]: [Signal<'g>; 3],
    others: Signal<'g>,
) -> (Signal<'g>, Signal<'g>, Signal<'g>) {
    let keeps = mode.is(2).named("mode_keeps_table");
    let has_others = (mode.is(1) | keeps).named("mode_has_others");
    // A job with more spheres than `most` is refused before it reads a line, so these sums have no more bits.
    let rows = |spheres: Signal<'g>, most: u32| {
        let bits = most.ilog2() + 1;
        spheres.low(bits).extend(bits + 1).plus(15).drop_low(4).extend(MOST_OTHERS.ilog2() - 2)
    };
    let own = rows(count, spec.config.search.table).gate(!keeps).named("rows_of_table");
    let of_others = rows(others, MOST_OTHERS).gate(has_others).named("rows_of_others");
    let lines = (own + of_others).append_zeros(2).extend(COUNT_BITS);
    for (name, value) in
        [("has_others", has_others), ("keeps_table", keeps), ("job_count", count), ("job_others", others)]
    {
        let register = graph.register(name, value.width(), 0);
        register.next_if(takes, value);
        graph.output(name, register.value());
    }
    let exceeds = |spheres: Signal<'g>, most: u32| spheres.greater_than(spheres.same(most.into()));
    let is_too_large =
        (!keeps & exceeds(count, spec.config.search.table)) | (has_others & exceeds(others, MOST_OTHERS));
    (lines, mode.drop_low(2).any() | mode.low(2).all(), is_too_large.named("is_too_large"))
}
