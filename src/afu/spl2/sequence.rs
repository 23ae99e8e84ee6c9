//! A transaction's sequence: reads the context, polls the control memory, gives the core its job, and when that has
//! ended writes counters, fence and status; then the next.

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{Errors, Graph, Module, Signal};

use super::super::control::{ERROR_BITS, JobError, MODE_BITS};
use super::super::{ADDRESS_BITS, COUNT_BITS, Spec};
use super::map::{self, control, latency, performance, pointers, status};
use super::port::{MDATA_BITS, NUMBER_BITS, is_own};
use super::registers::dsm_page_line;

/// What the sequence is at.
#[derive(Clone, Copy)]
enum State {
    /// No context is known.
    Idle = 0,
    /// Reads the context.
    Context = 1,
    /// Polls the control memory for a job.
    Poll = 2,
    /// Counts the job's lines.
    Measure = 3,
    /// Starts the job, if there are lines enough.
    Start = 4,
    /// The core is at work; polls for an abort.
    Run = 5,
    /// Writes DSM line 4.
    Latency = 6,
    /// Writes DSM line 5.
    Performance = 7,
    /// Sends the fence.
    Fence = 8,
    /// Writes the status.
    Status = 9,
}

const STATE_BITS: u32 = 4;
/// Bits of a byte address within a line.
const BYTE_BITS: u32 = 6;
/// Bits of a 32-bit cycle count.
const CYCLE_BITS: u32 = 32;

/// Builds the module `spl2_sequence`.
pub(super) fn sequence(spec: &Spec) -> Result<Arc<Module>, Errors> {
    let graph = Graph::new("spl2_sequence");
    graph.about("reads the context, polls the control memory, runs jobs, writes counters and status");
    let constant = |width: u32, value: u128| graph.constant(width, value);

    let dsm_line = graph.input("dsm_line", ADDRESS_BITS);
    let dsm_valid = graph.input("dsm_valid", 1);
    let context_line = graph.input("context_line", ADDRESS_BITS);
    let context_valid = graph.input("context_valid", 1);
    let read_granted = graph.input("rd_granted", 1);
    let read_number = graph.input("read_number", NUMBER_BITS);
    let response_valid = graph.input("rsp_valid", 1);
    let response_mdata = graph.input("rsp_mdata", MDATA_BITS);
    let response = graph.input("rsp_data", spec.line_bits);
    let write_granted = graph.input("wr_granted", 1);
    let core_done = graph.input("core_done", 1);
    let core_error = graph.input("core_error", ERROR_BITS);
    let core_read = graph.input("core_read_answered", 1);
    let core_write = graph.input("core_write_asked", 1);
    let core_words = ["contacts", "invalid", "first_invalid"].map(|name| graph.input(name, COUNT_BITS));
    let core_cycles = ["cycles_busy", "cycles_input", "cycles_output"].map(|name| graph.input(name, 64));
    let capability = graph.input("capability", 64);

    let state = graph.register("state", STATE_BITS, State::Idle as u128);
    let at = |wanted: State, name: &str| state.is(wanted as u128).named(name);
    let at_idle = at(State::Idle, "at_idle");
    let at_context = at(State::Context, "at_context");
    let at_poll = at(State::Poll, "at_poll");
    let at_measure = at(State::Measure, "at_measure");
    let at_start = at(State::Start, "at_start");
    let at_run = at(State::Run, "at_run");
    let at_latency = at(State::Latency, "at_latency");
    let at_performance = at(State::Performance, "at_performance");
    let at_fence = at(State::Fence, "at_fence");
    let at_status = at(State::Status, "at_status");

    // The shell's own reads, one at a time. A response that is overdue is given up and asked for again.
    let waiting = graph.register("waiting", 1, 0);
    let expected = graph.data_register("expected", NUMBER_BITS);
    let answered = (response_valid & *waiting & is_own(response_mdata, expected.value())).named("answered");
    let age = graph.data_register("age", map::RETRY_CYCLES.ilog2() + 1);
    age.next(read_granted.select(age.same(0), age.plus(1)));
    let overdue = (*waiting & age.msb()).named("overdue");
    expected.next_if(read_granted, read_number);
    waiting.next(read_granted | (*waiting & !answered & !overdue));
    let pause_bits = map::RUNNING_POLL_CYCLES.max(map::IDLE_POLL_CYCLES).ilog2() + 1;
    let pause = graph.register("pause", pause_bits, 0);
    let asks = ((at_context | at_poll | at_run) & !*waiting & !pause.any()).named("asks");

    // The context.
    let got_context = (at_context & answered).named("got_context");
    let line_of = |field: map::Field| field.of(response).drop_low(BYTE_BITS);
    let source = graph.data_register("source_line", ADDRESS_BITS);
    source.next_if(got_context, line_of(pointers::SOURCE));
    let destination = graph.data_register("destination_line", ADDRESS_BITS);
    destination.next_if(got_context, line_of(pointers::DESTINATION));
    let lines = graph.data_register("buffer_lines", COUNT_BITS);
    lines.next_if(got_context, pointers::LINES.of(response));

    // The control memory: a job is new if its number is not the last one's.
    let some_job = graph.register("some_job", 1, 0);
    let job_sequence = graph.data_register("job_sequence", 32);
    let starts = control::START.of(response).is(map::START_WORD.into()).named("has_start_word");
    let is_new = (!*some_job | !control::SEQUENCE.of(response).equals(*job_sequence)).named("is_new");
    let got_job = (at_poll & answered & starts & is_new).named("got_job");
    some_job.next(*some_job | got_job);
    job_sequence.next_if(got_job, control::SEQUENCE.of(response));
    let job_count = graph.data_register("job_count", COUNT_BITS);
    job_count.next_if(got_job, control::COUNT.of(response));
    let mode = control::MODE.of(response);
    let job_mode = graph.data_register("job_mode", MODE_BITS);
    let folded = mode.low(MODE_BITS) | mode.drop_low(MODE_BITS).any().extend(MODE_BITS);
    job_mode.next_if(got_job, folded);
    let job_watchdog = graph.data_register("job_watchdog", COUNT_BITS);
    job_watchdog.next_if(got_job, control::WATCHDOG.of(response));
    let abort = graph.register("abort", 1, 0);
    let aborts = (answered & control::ABORT.of(response).any() & (got_job | at_run)).named("aborts");
    abort.next(aborts | (*abort & !got_job));
    let runs = (got_job | at_run).named("runs");
    let poll_pause = |cycles: u32| constant(pause_bits, cycles.into());
    let next_pause = runs.select(poll_pause(map::RUNNING_POLL_CYCLES), poll_pause(map::IDLE_POLL_CYCLES));
    let counted = pause.any().select(pause.minus(1), *pause);
    pause.next((answered & !at_context).select(next_pause, counted));

    // Lines that the job takes, of each buffer.
    let layout = spec.layout();
    let fits = |per_line: u32, more: u32, name: &str| {
        let rounded = job_count.extend(COUNT_BITS + 1).plus(u128::from(per_line - 1));
        let needed = rounded.drop_low(per_line.ilog2()).extend(COUNT_BITS + 1).plus(more.into());
        needed.delay(1).named(name).at_most(lines.extend(COUNT_BITS + 1))
    };
    let source_fits = fits(layout.pairs_per_line(), map::DATA_LINE, "source_lines");
    let destination_fits = fits(layout.contacts_per_line(), 0, "destination_lines");
    // How many lines contacts alone will take nobody knows: the core keeps to the room there is.
    let only_hits = spec.config.results == Results::Hits;
    let fits = if only_hits { source_fits } else { (source_fits & destination_fits).named("fits") };
    let start = (at_start & fits).named("start");
    let refused = graph.register("refused", 1, 0);
    refused.next((at_start & !fits) | (*refused & !at_start));

    // Latencies, in cycles since the start.
    let since = graph.data_register("since_start", CYCLE_BITS);
    since.next(start.select(since.same(0), since.plus(1)));
    let read_seen = graph.register("read_seen", 1, 0);
    read_seen.next(!at_start & (*read_seen | (at_run & core_read)));
    let first_read = graph.data_register("first_read", CYCLE_BITS);
    let write_seen = graph.register("write_seen", 1, 0);
    write_seen.next(!at_start & (*write_seen | (at_run & core_write)));
    let first_write = graph.data_register("first_write", CYCLE_BITS);
    let none = since.same(0);
    first_read.next_if(at_start | !*read_seen, at_start.select(none, since.plus(1).gate(core_read)));
    first_write.next_if(at_start | !*write_seen, at_start.select(none, since.plus(1).gate(core_write)));

    // What is written at the end.
    let latency_line = map::line(
        &graph,
        spec.line_bits,
        &[
            (latency::FIRST_READ, first_read.value()),
            (latency::FIRST_WRITE, first_write.value()),
            (latency::SEQUENCE, job_sequence.value()),
        ],
    );
    let ran = (!*refused).named("ran");
    let performance_line = map::line(
        &graph,
        spec.line_bits,
        &[
            (performance::BUSY, core_cycles[0].gate(ran)),
            (performance::INPUT, core_cycles[1].gate(ran)),
            (performance::OUTPUT, core_cycles[2].gate(ran)),
            (performance::SEQUENCE, job_sequence.value()),
        ],
    );
    let no_room = constant(ERROR_BITS, JobError::Room as u128);
    let status_line = map::line(
        &graph,
        spec.line_bits,
        &[
            (status::DONE, constant(1, 1)),
            (status::ERROR, ran.select(core_error, no_room)),
            (status::SEQUENCE, job_sequence.value()),
            (status::CONTACTS, core_words[0].gate(ran)),
            (status::INVALID, core_words[1].gate(ran)),
            (status::FIRST_INVALID, core_words[2] | (*refused).repeat(COUNT_BITS)),
            (status::VERSION, constant(32, map::VERSION.into())),
            (status::CAPABILITY, capability),
            (status::AFU_ID, constant(128, map::AFU_ID)),
        ],
    );
    let dsm = |line: u32| dsm_page_line(dsm_line, constant(6, line.into()));
    let status_address = context_line.plus(map::STATUS_LINE.into());
    let to_dsm = (at_latency | at_performance).named("to_dsm");
    let dsm_address = at_latency.select(dsm(map::LATENCY_LINE), dsm(map::PERFORMANCE_LINE));
    let dsm_data = at_latency.select(latency_line, performance_line);
    // Without a DSM there are no counters; and a fence might never pass the write whose response the core gave up on.
    let gave_up = core_error.is(JobError::Watchdog as u128).named("gave_up");
    let fences = (at_fence & !(gave_up & ran)).named("fences");
    let written = (write_granted | (to_dsm & !dsm_valid) | (at_fence & !fences)).named("written");

    // From state to state.
    let beginning = [
        (at_idle & context_valid, State::Context),
        (got_context, State::Poll),
        (got_job, State::Measure),
        (at_measure, State::Start),
        (start, State::Run),
        (at_start & !fits, State::Latency),
    ];
    let end = [
        (at_run & core_done, State::Latency),
        (at_latency & written, State::Performance),
        (at_performance & written, State::Fence),
        (at_fence & written, State::Status),
        (at_status & written, State::Poll),
    ];
    let begun = beginning.into_iter().fold(*state, step_to).named("next_of_beginning");
    state.next(end.into_iter().fold(begun, step_to).named("next_state"));

    graph.output("rd_valid", asks);
    graph.output("rd_address", at_context.select(context_line, source.value()).named("address"));
    graph.output("start", start);
    graph.output("source", source.plus(map::DATA_LINE.into()).named("first_pairs"));
    graph.output("destination", destination.value());
    if only_hits {
        graph.output("destination_lines", lines.value());
    }
    graph.output("count", job_count.value());
    graph.output("mode", job_mode.value());
    graph.output("watchdog", job_watchdog.value());
    graph.output("abort_job", abort.value());
    graph.output("wr_valid", (to_dsm & dsm_valid) | fences | at_status);
    graph.output("wr_fence", at_fence);
    graph.output("wr_virtual", !to_dsm);
    graph.output("wr_address", to_dsm.select(dsm_address, status_address));
    graph.output("wr_data", to_dsm.select(dsm_data, status_line));
    graph.finish()
}

/// A state if its condition holds, else what was next before.
fn step_to<'g>(next: Signal<'g>, (condition, to): (Signal<'g>, State)) -> Signal<'g> {
    condition.select(next.same(to as u128), next)
}
