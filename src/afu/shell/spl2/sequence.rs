//! The sequence of a transaction: reads the context, polls the control memory, starts the core's job, and at its end
//! writes counters, fence and status; then it polls for the next job.

use std::sync::Arc;

use crate::config::{Input, Results};
use crate::hdl::{BuildErrors, Graph, Module, Signal};
use crate::spheres::ROW;

use super::map::{self, control, latency, performance, pointers, status};
use super::registers::dsm_page_line;
use super::words::{MDATA_BITS, NUMBER_BITS, is_own};
use crate::afu::port::{JobInputs, JobOutputs};
use crate::afu::{ADDRESS_BITS, COUNT_BITS, JobError, Spec};

/// Bits of a byte address within a line.
const BYTE_BITS: u32 = 6;
/// Spheres in a line.
const SPHERES_PER_LINE: usize = 4;
/// Bits of a 32-bit cycle count.
const CYCLE_BITS: u32 = 32;

/// Builds the module `spl2_sequence`.
pub(super) fn sequence(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("spl2_sequence");
    graph.about("reads the context, polls the control memory, runs jobs, writes counters and status");
    let constant = |width: u32, value: u128| graph.constant(width, value);

    let dsm_line = graph.input("dsm_line", ADDRESS_BITS);
    let dsm_valid = graph.input("dsm_valid", 1);
    let written_context = graph.input("context_line", ADDRESS_BITS);
    let context_valid = graph.input("context_valid", 1);
    let context_written = graph.input("context_written", 1);
    let read_granted = graph.input("rd_granted", 1);
    let read_number = graph.input("read_number", NUMBER_BITS);
    let response_valid = graph.input("rsp_valid", 1);
    let response_mdata = graph.input("rsp_mdata", MDATA_BITS);
    // One cycle after the other two.
    let arrives = graph.input("rsp_data", spec.line_bits);
    let received = arrives.delay(1).named("received");
    let write_granted = graph.input("wr_granted", 1);
    let told = JobOutputs::of(spec);
    let core_done = graph.input("core_done", 1);
    let core_error = graph.input("core_error", told.error.bits);
    let core_read = graph.input("core_read_answered", 1);
    let core_write = graph.input("core_write_asked", 1);
    let candidates = told.candidates.map(|port| port.input(&graph));
    let core_words = [told.contacts, told.invalid, told.first_invalid].map(|port| port.input(&graph));
    let core_cycles = [told.cycles_busy, told.cycles_input, told.cycles_output].map(|port| port.input(&graph));
    let capability = told.capability.input(&graph);

    // The states of the sequence, in order. No context is known. The context is being read. The control memory is
    // polled for a job. The job's lines are counted, those of two sets in two cycles, and then compared with those of
    // the buffers. The job is started if there are enough lines: a cycle later the core is told to. The core works,
    // while the control memory is polled for an abort. DSM line 4, DSM line 5, the fence and the status are written.
    let state = |name: &str| graph.register(name, 1, 0);
    let idle = graph.register("at_idle", 1, 1);
    let [context, poll, measure, compare, begin, run] =
        ["at_context", "at_poll", "at_measure", "at_compare", "at_start", "at_run"].map(state);
    let [latencies, counters, fence, report] = ["at_latency", "at_performance", "at_fence", "at_status"].map(state);
    let (at_context, at_poll, at_start, at_run) = (*context, *poll, *begin, *run);
    let (at_latency, at_performance, at_fence, at_status) = (*latencies, *counters, *fence, *report);

    // The shell's own reads, one at a time. If a response is overdue, the read is repeated.
    let waiting = graph.register("waiting", 1, 0);
    let expected = graph.data_register("expected", NUMBER_BITS);
    // A response is compared with the outstanding read before it is used. One that arrives as the next read is granted
    // belongs to an earlier read, from before a reset.
    let response = received.delay(1).named("compared");
    let own = is_own(response_mdata, expected.value()).delay(1).named("has_own_number")
        & (response_valid & *waiting).delay(1).named("comes_in_time");
    let own = own.delay(1).named("is_own");
    let answered = graph.register("answered", 1, 0);
    answered.next(own & *waiting & !*answered);
    let answered = answered.value();
    let age = graph.data_register("age", map::RETRY_CYCLES.ilog2() + 1);
    age.next(read_granted.select(age.same(0), age.plus(1)));
    let overdue = (*waiting & age.msb()).named("overdue");
    expected.next_if(read_granted, read_number);
    waiting.next(read_granted | (*waiting & !answered & !overdue));
    let pause_bits = map::RUNNING_POLL_CYCLES.max(map::IDLE_POLL_CYCLES).ilog2() + 1;
    let pause = graph.register("pause", pause_bits, 0);
    let pauses = pause.any().named("pauses");
    let may_ask = (!*waiting & !read_granted & !pauses).named("may_ask");
    let is_due = graph.register("context_due", 1, 0);
    let holds = (at_poll & *is_due).registered("holds_for_context");
    let asks = ((at_context | (at_poll & !holds) | at_run) & may_ask).registered("asks");

    // The context is read again between jobs if its address was written again. So everything that a job reads and
    // writes, including its status, belongs to one context. No request is in flight then: none is made while polling
    // holds, and a grant is heard in time.
    let is_quiet = (holds & !asks & !read_granted & !*waiting).registered("holds_and_is_quiet");
    let switches = (at_poll & is_quiet).named("switches");
    let reads_context = ((*idle & context_valid) | switches).named("reads_context");
    is_due.next(context_written | (*is_due & !reads_context));
    let context_line = graph.data_register("job_context_line", ADDRESS_BITS);
    context_line.next_if(reads_context, written_context);
    let got_context = (at_context & answered).named("got_context");
    // Registers take every response while its line is awaited: what they have then has no meaning. So no logic stands
    // between their enable and the state, and the last response is the right one.
    let line_of = |field: map::Field| field.of(response).drop_low(BYTE_BITS);
    let source = graph.data_register("source_line", ADDRESS_BITS);
    source.next_if(at_context, line_of(pointers::SOURCE));
    let destination = graph.data_register("destination_line", ADDRESS_BITS);
    destination.next_if(at_context, line_of(pointers::DESTINATION));
    let lines = graph.data_register("buffer_lines", COUNT_BITS);
    lines.next_if(at_context, pointers::LINES.of(response));

    // The control memory: a job is new if its number is not the last one's.
    let some_job = graph.register("some_job", 1, 0);
    let job_sequence = graph.data_register("job_sequence", 32);
    let starts = !differs(control::START.of(arrives), constant(32, map::START_WORD.into()), "start_word");
    let is_other = differs(control::SEQUENCE.of(arrives), *job_sequence, "sequence");
    let is_new = (!*some_job | is_other).named("is_new");
    let got_job = (at_poll & answered & starts & is_new).named("got_job");
    some_job.next(*some_job | got_job);
    // The last job's number is compared until then.
    job_sequence.next_if(*measure, control::SEQUENCE.of(response).delay(1).named("sequence_then"));
    let job_count = graph.data_register("job_count", COUNT_BITS);
    job_count.next_if(at_poll, control::COUNT.of(response));
    let mode = control::MODE.of(response);
    let mode_bits = JobInputs::of(spec).mode.bits;
    let job_mode = graph.data_register("job_mode", mode_bits);
    // A mode with a higher bit is an unknown one. Pairs have only mode 0.
    let higher = control::MODE.of(arrives).drop_low(mode_bits).extend(32);
    let higher = differs(higher, constant(32, 0), "higher_mode");
    let takes_spheres = spec.config.input == Input::Spheres;
    let unknown = if takes_spheres { higher.repeat(mode_bits) } else { higher.extend(mode_bits) };
    let folded = mode.low(mode_bits) | unknown;
    job_mode.next_if(at_poll, folded);
    let job_others = JobInputs::of(spec).others.map(|_| {
        let others = graph.data_register("job_others", COUNT_BITS);
        others.next_if(at_poll, control::OTHERS.of(response));
        others.value()
    });
    let job_watchdog = graph.data_register("job_watchdog", COUNT_BITS);
    job_watchdog.next_if(at_poll, control::WATCHDOG.of(response));
    let abort = graph.register("abort", 1, 0);
    let has_abort = differs(control::ABORT.of(arrives), constant(32, 0), "abort_word");
    let aborts = (answered & has_abort & (got_job | at_run)).named("aborts");
    abort.next(aborts | (*abort & !got_job));
    let runs = (got_job | at_run).named("runs");
    let poll_pause = |cycles: u32| constant(pause_bits, cycles.into());
    let next_pause = runs.select(poll_pause(map::RUNNING_POLL_CYCLES), poll_pause(map::IDLE_POLL_CYCLES));
    let counted = pauses.select(pause.minus(1), *pause);
    // Polling for the next job begins as soon as one has ended.
    let set_pause = (answered & !at_context).select(next_pause, counted);
    pause.next(set_pause.gate(!at_status));

    // Lines that the job takes, of each buffer.
    let layout = spec.layout();
    let fits = |per_line: u32, more: u32, buffer: &str| {
        let rounded = job_count.extend(COUNT_BITS + 1).plus(u128::from(per_line - 1 + more * per_line));
        let rounded = rounded.named(&format!("{buffer}_count"));
        fit(rounded.drop_low(per_line.ilog2()).extend(COUNT_BITS + 1), *lines, buffer)
    };
    let source_fits = match job_others {
        None => fits(layout.pairs_per_line(), map::DATA_LINE, "source"),
        Some(others) => fit(lines_of_sets(*job_mode, *job_count, others), *lines, "source"),
    };
    // The number of lines of hits is not known in advance; the core keeps to the available room.
    let only_hits = spec.config.results == Results::Hits;
    let fits = if only_hits {
        source_fits
    } else {
        (source_fits & fits(layout.contacts_per_line(), 0, "destination")).named("fits")
    };
    let start = (at_start & fits).registered("start_job");
    let refused = graph.register("refused", 1, 0);
    let refuses = (at_start & !fits).named("refuses");
    refused.next(refuses | (*refused & !at_start));

    // Latencies, in cycles since the start.
    let since = graph.data_register("since_start", CYCLE_BITS);
    since.next(start.select(since.same(0), since.plus(1)));
    let first = |happens: Signal<'_>, name: &str| {
        let happened = happens.delay(1).named(&format!("{name}_now"));
        let seen = graph.register(&format!("{name}_seen"), 1, 0);
        seen.next(!at_start & (*seen | (at_run & happened)));
        let cycles = graph.data_register(&format!("first_{name}"), CYCLE_BITS);
        cycles.next_if(at_start | !*seen, since.gate(happened & !at_start));
        cycles.value()
    };
    let (first_read, first_write) = (first(core_read, "read"), first(core_write, "write"));

    // The lines written at the end: each field has registers that show it in the state in which its line is written.
    let [to_latency, to_performance, to_status] =
        ["to_latency", "to_performance", "to_status"].map(|name| graph.wire(name, 1));
    let ran = (!*refused).named("ran");
    let shows_latency = shows("latency", to_latency);
    let shows_sequence = shows("sequence", to_performance);
    let latency_line = map::line(
        &graph,
        spec.line_bits,
        &[
            (latency::FIRST_READ, first_read.gate(shows_latency)),
            (latency::FIRST_WRITE, first_write.gate(shows_latency)),
            (latency::SEQUENCE, job_sequence.gate(shows_latency)),
        ],
    );
    let cycles = |index: usize, name: &str| core_cycles[index].gate(shows(name, to_performance & ran));
    let performance_line = map::line(
        &graph,
        spec.line_bits,
        &[
            (performance::BUSY, cycles(0, "busy")),
            (performance::INPUT, cycles(1, "input")),
            (performance::OUTPUT, cycles(2, "output")),
            (performance::SEQUENCE, job_sequence.gate(shows_sequence)),
        ],
    );
    let (shows_status, shows_identity) = (shows("status", to_status), shows("identity", to_status));
    let shows_results = shows("results", to_status & ran);
    let shows_refusal = shows("refusal", to_status & *refused);
    let no_room = constant(JobError::BITS, JobError::Room.code().into());
    let first_invalid = core_words[2].gate(shows_results) | shows_refusal.repeat(COUNT_BITS);
    let status_line = map::line(
        &graph,
        spec.line_bits,
        &[
            (status::DONE, shows_status),
            (status::ERROR, core_error.gate(shows_results) | no_room.gate(shows_refusal)),
            (status::SEQUENCE, job_sequence.gate(shows_status)),
            (status::CONTACTS, core_words[0].gate(shows_results)),
            (status::INVALID, core_words[1].gate(shows_results)),
            (status::FIRST_INVALID, first_invalid),
            (status::VERSION, constant(32, map::VERSION.into()).gate(shows_status)),
            (status::CAPABILITY, capability.gate(shows_identity)),
            (status::AFU_ID, constant(128, map::AFU_ID).gate(shows_identity)),
        ]
        .into_iter()
        .chain(candidates.map(|candidates| (status::CANDIDATES, candidates.gate(shows_results))))
        .collect::<Vec<_>>(),
    );
    let dsm = |line: u32| dsm_page_line(dsm_line, constant(6, line.into()));
    let status_address = context_line.plus(map::STATUS_LINE.into()).delay(1).named("status_line_address");
    let to_dsm = (at_latency | at_performance).named("to_dsm");
    let shows_dsm = shows("dsm", to_latency | to_performance);
    let dsm_address = at_latency.select(dsm(map::LATENCY_LINE), dsm(map::PERFORMANCE_LINE));
    // Without a DSM there are no counters. A fence might never complete if the core gave up on a write's response.
    let gave_up = core_error.is(JobError::Watchdog.code().into()).named("gave_up");
    let fences = (at_fence & !(gave_up & ran)).named("fences");
    let written = (write_granted | (to_dsm & !dsm_valid) | (at_fence & !fences)).named("written");
    // The state is left a cycle later.
    let left = graph.register("leaves_state", 1, 0);
    left.next(written & !*left);
    let leaves = *left;
    to_latency.drive(refuses | (at_run & core_done) | (at_latency & !leaves));
    to_performance.drive((at_latency & leaves) | (at_performance & !leaves));
    to_status.drive((at_fence & leaves) | (at_status & !leaves));

    // The transitions between states.
    idle.next(*idle & !context_valid);
    context.next(reads_context | (at_context & !answered));
    poll.next(got_context | (at_status & leaves) | (at_poll & !got_job & !switches));
    measure.next(got_job);
    // The sum of the lines of two sets takes a cycle more.
    compare.next(if job_others.is_some() { measure.registered("at_sum") } else { *measure });
    begin.next(*compare);
    run.next(start | (at_run & !core_done));
    latencies.next(to_latency);
    counters.next(to_performance);
    fence.next((at_performance & leaves) | (at_fence & !leaves));
    report.next(to_status);

    // The write of a state is at the port one cycle after the state begins.
    let writes = graph.register("writes", 1, 0);
    writes.next(((to_dsm & dsm_valid) | fences | at_status) & !written & !leaves);

    graph.output("rd_valid", asks);
    graph.output(
        "rd_address",
        at_context.delay(1).named("asks_for_context").select(*context_line, source.value()).named("address"),
    );
    graph.output("start", start);
    graph.output("source", source.plus(map::DATA_LINE.into()).delay(1).named("first_pairs"));
    graph.output("destination", destination.value());
    if only_hits {
        graph.output("destination_lines", lines.value());
    }
    graph.output("count", job_count.value());
    if let Some(others) = job_others {
        graph.output("others", others);
    }
    graph.output("mode", job_mode.value());
    graph.output("watchdog", job_watchdog.value());
    graph.output("abort_job", abort.value());
    graph.output("wr_valid", writes.value());
    graph.output("wr_fence", at_fence.delay(1));
    graph.output("wr_virtual", (!to_dsm).delay(1));
    graph.output("wr_address", shows_dsm.select(dsm_address, status_address).delay(1));
    graph.output("wr_data", (latency_line | performance_line | status_line).delay(1));
    graph.finish()
}

/// Known a cycle later: whether a buffer of `lines` lines has those that are needed, which are registered first.
fn fit<'g>(needed: Signal<'g>, lines: Signal<'g>, buffer: &str) -> Signal<'g> {
    let needed = needed.delay(1).named(&format!("{buffer}_lines"));
    needed.at_most(lines.extend(needed.width())).delay(1).named(&format!("{buffer}_fits"))
}

/// The source lines of a job of spheres, a cycle later, with those in front of them. Each set is a whole number of
/// rows. Mode 0 has no second set, and mode 2 only that.
fn lines_of_sets<'g>(mode: Signal<'g>, count: Signal<'g>, others: Signal<'g>) -> Signal<'g> {
    let rows = |spheres: Signal<'g>, is_there: Signal<'g>, name: &str| {
        let rounded = spheres.extend(COUNT_BITS + 1).plus(ROW as u128 - 1);
        rounded.drop_low(ROW.ilog2()).gate(is_there).delay(1).named(name)
    };
    let (own, others) = (rows(count, !mode.is(2), "own_rows"), rows(others, mode.any(), "other_rows"));
    let bits = own.width() + 1;
    let lines = (own.extend(bits) + others.extend(bits)).append_zeros((ROW / SPHERES_PER_LINE).ilog2());
    lines.extend(lines.width() + 1).plus(map::DATA_LINE.into())
}

/// A register that shows fields of a line from the next cycle on.
fn shows<'g>(name: &str, state: Signal<'g>) -> Signal<'g> {
    state.data_copies(&format!("shows_{name}"), 1)[0]
}

/// True if a word of 32 bits differs from `other`, two cycles later: its bytes are compared first.
fn differs<'g>(word: Signal<'g>, other: Signal<'g>, name: &str) -> Signal<'g> {
    let bytes = (0..4).rev().map(|byte| !word.slice(8 * byte, 8).equals(other.slice(8 * byte, 8)));
    let bytes = Signal::join(&bytes.collect::<Vec<_>>()).delay(1).named(&format!("{name}_bytes_differ"));
    bytes.any().delay(1).named(&format!("{name}_differs"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::hdl::Evaluator;

    /// The shell's own read of this number, as `mdata`.
    fn own(number: u64) -> u64 {
        1 << NUMBER_BITS | number
    }

    /// Steps until the shell asks for a line, grants the read with this number, and says what arrives in that cycle.
    fn grant(run: &mut Evaluator, number: u64, arrives: Option<u64>) {
        for _ in 0..100 {
            run.step();
            if run.get("rd_valid") == 1 {
                run.set("rd_granted", 1);
                run.set("read_number", number.into());
                run.set("rsp_valid", u128::from(arrives.is_some()));
                run.set("rsp_mdata", arrives.unwrap_or_default().into());
                run.step();
                run.set("rd_granted", 0);
                run.set("rsp_valid", 0);
                return;
            }
        }
        panic!("the shell asks for no line");
    }

    /// The answer to a read from before a reset arrives in the cycle in which the next read is granted. It once was
    /// taken for that read's, so a job read whatever its line held.
    #[test]
    fn an_answer_from_before_a_reset_answers_no_new_read() {
        let module = sequence(&Spec::from(Config::default())).expect("a module");
        for (arrives, answered) in [(None, false), (Some(own(5)), false), (Some(own(6)), false)] {
            let mut run = Evaluator::new(&module, &[]).expect("a module");
            let poll = run.probe("at_poll").expect("a state");
            run.reset();
            run.set("context_valid", 1);
            grant(&mut run, 5, None);
            run.reset();
            grant(&mut run, 6, arrives);
            (0..10).for_each(|_| run.step());
            assert_eq!(run.read(poll) == 1, answered, "{arrives:?} arrives as read 6 is granted");
            run.set("rsp_valid", 1);
            run.set("rsp_mdata", own(6).into());
            run.step();
            run.set("rsp_valid", 0);
            (0..10).for_each(|_| run.step());
            assert_eq!(run.read(poll), 1, "the answer of read 6");
        }
    }
}
