//! The registers, their AXI4-Lite slave, and the job that they describe.
//!
//! The soft reset aborts the job and waits for every response. It resets no other part, so no request is withdrawn, and
//! the epoch that separates late responses from those of the next job goes on.

use std::sync::Arc;

use super::map::{self, Register};
use super::port::{ControlInputs, ControlOutputs, REGISTER_ADDRESS_BITS};
use crate::afu::port::{JobInputs, JobOutputs, outputs};
use crate::afu::{ADDRESS_BITS, COUNT_BITS, EPOCH_BITS, JobError, Spec};
use crate::config::Results;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Bits of a word, and of a 32-bit cycle count.
const WORD_BITS: u32 = 32;
/// Bits of a byte address within a line.
const BYTE_BITS: u32 = 6;

/// Builds the module `axi_control`.
pub(super) fn control(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("axi_control");
    graph.about("registers behind an AXI4-Lite slave, with the protocol ap_ctrl_hs");
    let bus = ControlInputs::of(spec).map(|port| port.input(&graph));
    let told = JobOutputs::of(spec).map(|port| graph.input(&format!("core_{}", port.name), port.bits));
    let failures = ["read", "write"].map(|channel| Failure {
        happens: graph.input(&format!("{channel}_failed"), 1),
        response: graph.input(&format!("{channel}_response"), 2),
        address: graph.input(&format!("{channel}_address"), ADDRESS_BITS),
        epoch: graph.input(&format!("{channel}_epoch"), EPOCH_BITS),
    });
    let [read_idle, write_idle] = ["read_idle", "write_idle"].map(|name| graph.input(name, 1));
    let [line_read, line_written] = ["line_read", "line_written"].map(|name| graph.input(name, 1));
    let [read_unasked, write_unasked] = ["read_unasked", "write_unasked"].map(|name| graph.input(name, 1));
    let constant = |width: u32, value: u128| graph.constant(width, value);

    // Nothing is taken while registers are still in reset.
    let awake = graph.constant(1, 1).registered("awake");
    let writes = Writes::new(&graph, &bus, awake);
    let reads = Reads::new(&graph, &bus, awake);

    // The job.
    let start_bit = graph.register("ap_start", 1, 0);
    let runs = graph.register("job_runs", 1, 0);
    let soft = graph.register("soft_reset", 1, 0);
    let outstanding = (!(read_idle & write_idle)).registered("outstanding");
    let start = (*start_bit & !*runs & !*soft).named("start_job");
    let ends = (*runs & told.done).named("job_ends");
    runs.next(start | (*runs & !ends));
    let sets_start = writes.bit(map::CONTROL, 0);
    start_bit.next((sets_start | (*start_bit & !ends)) & !*soft);
    // It ends when no job runs and memory owes nothing, two cycles after it began at the earliest.
    let sets_soft = writes.bit(map::SOFT_RESET, 0);
    let is_soft = soft.value().registered("soft_reset_before");
    let ended_soft = (*soft & is_soft & !*runs & !outstanding & read_idle & write_idle).named("soft_reset_ends");
    soft.next(sets_soft | (*soft & !ended_soft));

    // A read of the control register clears what it showed.
    let clears = reads.of(map::CONTROL).named("control_read");
    let event = |name: &str| {
        let flag = graph.register(name, 1, 0);
        flag.next(ends | (*flag & !clears));
        flag.value()
    };
    let (done, ready) = (event("ap_done"), event("ap_ready"));
    let ended = graph.register("ended", 1, 0);
    ended.next(!start & (*ended | ends));

    // Interrupts.
    let enable = writes.word(&graph, map::GLOBAL_INTERRUPT_ENABLE, "interrupt_global", 1);
    let enabled = writes.word(&graph, map::INTERRUPT_ENABLE, "interrupt_enable", 2);
    let pending: Vec<_> = (0..2)
        .map(|bit| {
            let flag = graph.register(&format!("interrupt_pending_{bit}"), 1, 0);
            let toggled = *flag ^ writes.bit(map::INTERRUPT_STATUS, bit);
            flag.next(toggled | (ends & enabled.bit(bit)));
            flag.value()
        })
        .collect();
    let interrupt = (enable & (pending[0] | pending[1])).registered("interrupt_level");

    // Arguments.
    let argument = |register: Register| {
        let words: Vec<_> = (0..register.words)
            .map(|word| {
                let at = Register { offset: register.offset + 4 * word, ..register };
                let name =
                    if register.words == 1 { register.name.to_owned() } else { format!("{}_{word}", register.name) };
                writes.word(&graph, at, &name, WORD_BITS)
            })
            .rev()
            .collect();
        Signal::join(&words)
    };
    let [source, destination, count] = [map::SOURCE, map::DESTINATION, map::COUNT].map(argument);
    let [mode, watchdog, scratch] = [map::MODE, map::WATCHDOG, map::SCRATCH].map(argument);
    let only_hits = spec.config.results == Results::Hits;
    let room = argument(map::DESTINATION_LINES);
    let job = JobInputs::of(spec);
    let others = job.others.map(|_| argument(map::OTHERS));
    // A mode with a higher bit is the highest one, which is unknown.
    let mode_bits = job.mode.bits;
    let folded = mode.low(mode_bits) | mode.drop_low(mode_bits).any().repeat(mode_bits);

    // The number of a job gives its epoch.
    let jobs = graph.register("jobs", WORD_BITS, 0);
    jobs.next_if(start, jobs.plus(1));
    let epoch = graph.register("job_epoch", EPOCH_BITS, 0);
    epoch.next_if(start, jobs.low(EPOCH_BITS));

    // The first failure of the job.
    let failed = graph.register("failed", 2, 0);
    let response = graph.data_register("failed_response", 2);
    let address = graph.data_register("failed_address", ADDRESS_BITS);
    let [read, write] = failures;
    let [read_fails, write_fails] = [&read, &write].map(|failure| failure.happens & failure.epoch.equals(*epoch));
    let first = ((read_fails | write_fails) & !failed.any()).named("first_failure");
    let channel = read_fails.select(constant(2, 1), constant(2, 2));
    failed.next_if(start | first, channel.gate(!start));
    response.next_if(first, read_fails.select(read.response, write.response));
    address.next_if(first, read_fails.select(read.address, write.address));

    // Responses that nothing waits for: what memory does from now on cannot be trusted.
    let is_unasked = (read_unasked | write_unasked).named("answered_unasked");
    let unasked = graph.register("unasked", WORD_BITS, 0);
    unasked.next_if(is_unasked, unasked.plus(1));
    let distrusted = graph.register("job_distrusted", 1, 0);
    distrusted.next(!start & (*distrusted | (*runs & is_unasked)));
    let distrust = constant(JobError::BITS, JobError::Response.code().into()).gate(*distrusted);
    let error = told.error.any().select(told.error, distrust).named("job_error");

    // Latencies, in cycles since the start.
    let since = graph.data_register("since_start", WORD_BITS);
    since.next(start.select(since.same(0), since.plus(1)));
    let first_cycle = |happens: Signal<'_>, name: &str| {
        let seen = graph.register(&format!("{name}_seen"), 1, 0);
        seen.next(!start & (*seen | (*runs & happens)));
        let cycles = graph.data_register(&format!("first_{name}"), WORD_BITS);
        cycles.next_if(start | !*seen, since.gate(happens & !start));
        cycles.value()
    };
    let (first_read, first_write) = (first_cycle(line_read, "read"), first_cycle(line_written, "write"));

    let control_word =
        fields(&graph, &[(map::START, *start_bit), (map::DONE, done), (map::IDLE, !*runs), (map::READY, ready)]);
    let status_word = fields(
        &graph,
        &[(map::BUSY, *runs), (map::ENDED, *ended), (map::OUTSTANDING, outstanding), (map::ERROR, error.gate(*ended))],
    );
    let failure_word = fields(&graph, &[(map::CHANNEL, *failed), (map::RESPONSE, response.gate(failed.any()))]);
    let pending_word = pending[1].concat(pending[0]);
    let failure_address = address.gate(failed.any()).concat(constant(BYTE_BITS, 0));
    let mut values = vec![
        (map::CONTROL, control_word),
        (map::GLOBAL_INTERRUPT_ENABLE, enable),
        (map::INTERRUPT_ENABLE, enabled),
        (map::INTERRUPT_STATUS, pending_word),
        (map::SOURCE, source),
        (map::DESTINATION, destination),
        (map::COUNT, count),
        (map::DESTINATION_LINES, room),
        (map::MODE, mode),
        (map::WATCHDOG, watchdog),
        (map::STATUS, status_word),
        (map::FAILURE, failure_word),
        (map::FAILURE_ADDRESS, failure_address),
        (map::CONTACTS, told.contacts),
        (map::INVALID, told.invalid),
        (map::FIRST_INVALID, told.first_invalid),
        (map::JOBS, *jobs),
        (map::CYCLES_BUSY, told.cycles_busy),
        (map::CYCLES_INPUT, told.cycles_input),
        (map::CYCLES_OUTPUT, told.cycles_output),
        (map::FIRST_READ, first_read),
        (map::FIRST_WRITE, first_write),
        (map::IDENTITY, constant(128, map::AFU_ID)),
        (map::MAP_VERSION, constant(WORD_BITS, map::VERSION.into())),
        (map::UNASKED, *unasked),
        (map::CAPABILITY, told.capability),
        (map::SOFT_RESET, *soft),
        (map::SCRATCH, scratch),
    ];
    values.extend(others.map(|others| (map::OTHERS, others)));
    values.extend(told.candidates.map(|candidates| (map::CANDIDATES, candidates)));
    values.sort_by_key(|(register, _)| register.offset);
    let offsets = values.iter().map(|(register, _)| register.offset);
    let all = map::registers(spec.config.input).map(|register| register.offset);
    debug_assert!(offsets.eq(all), "every register has its value");
    let read_word = reads.select(&graph, &values);

    let answers = ControlOutputs {
        s_axi_control_awready: writes.address_ready,
        s_axi_control_wready: writes.data_ready,
        s_axi_control_bvalid: writes.answered,
        s_axi_control_bresp: constant(2, 0),
        s_axi_control_arready: reads.ready,
        s_axi_control_rvalid: reads.answered,
        s_axi_control_rdata: read_word,
        s_axi_control_rresp: constant(2, 0),
        interrupt,
    };
    outputs(&graph, answers.named());
    graph.output("start", start);
    graph.output("source", source.drop_low(BYTE_BITS));
    graph.output("destination", destination.drop_low(BYTE_BITS));
    if only_hits {
        graph.output("destination_lines", room.low(COUNT_BITS));
    }
    graph.output("count", count);
    if let Some(others) = others {
        graph.output("others", others);
    }
    graph.output("mode", folded);
    graph.output("epoch", jobs.low(EPOCH_BITS));
    graph.output("watchdog", watchdog);
    graph.output("abort_job", *soft);
    graph.finish()
}

/// A failed access of one direction.
struct Failure<'g> {
    happens: Signal<'g>,
    response: Signal<'g>,
    address: Signal<'g>,
    epoch: Signal<'g>,
}

/// A word of these fields, with zeros between them.
fn fields<'g>(graph: &'g Graph, parts: &[(map::Field, Signal<'g>)]) -> Signal<'g> {
    let mut word = graph.constant(WORD_BITS, 0);
    for (field, value) in parts {
        let value = value.extend(WORD_BITS - field.low);
        word = word | if field.low == 0 { value } else { value.concat(graph.constant(field.low, 0)) };
    }
    word
}

/// The bits of a byte offset that choose a word.
fn word_of(address: Signal<'_>) -> Signal<'_> {
    address.drop_low(2)
}

/// The channels AW, W and B of the slave. Address and data arrive in any order; a write happens when both are there.
struct Writes<'g> {
    address_ready: Signal<'g>,
    data_ready: Signal<'g>,
    answered: Signal<'g>,
    happens: Signal<'g>,
    word: Signal<'g>,
    data: Signal<'g>,
    bytes: Signal<'g>,
}

impl<'g> Writes<'g> {
    fn new(graph: &'g Graph, bus: &ControlInputs<Signal<'g>>, awake: Signal<'g>) -> Self {
        let answered = graph.register("write_answered", 1, 0);
        let happens = graph.wire("register_written", 1);
        let held = |name: &str, valid: Signal<'g>| {
            let held = graph.register(&format!("{name}_held"), 1, 0);
            let ready = awake & !*held;
            let takes = (valid & ready).named(&format!("{name}_taken"));
            held.next(takes | (*held & !happens));
            (ready, held.value(), takes)
        };
        let (address_ready, address_held, takes_address) = held("write_address", bus.s_axi_control_awvalid);
        let (data_ready, data_held, takes_data) = held("write_data", bus.s_axi_control_wvalid);
        happens.drive(address_held & data_held & !*answered);
        answered.next(happens | (*answered & !bus.s_axi_control_bready));
        let word = graph.data_register("write_word", REGISTER_ADDRESS_BITS - 2);
        word.next_if(takes_address, word_of(bus.s_axi_control_awaddr));
        let data = graph.data_register("write_value", WORD_BITS);
        data.next_if(takes_data, bus.s_axi_control_wdata);
        let bytes = graph.data_register("write_bytes", WORD_BITS / 8);
        bytes.next_if(takes_data, bus.s_axi_control_wstrb);
        Self { address_ready, data_ready, answered: answered.value(), happens, word: *word, data: *data, bytes: *bytes }
    }

    /// True if the first word of a register is written in this cycle.
    fn of(&self, register: Register) -> Signal<'g> {
        self.happens & self.word.is((register.offset / 4).into())
    }

    /// True if a 1 is written to a bit of the first word of a register.
    fn bit(&self, register: Register, bit: u32) -> Signal<'g> {
        self.of(register) & self.bytes.bit(bit / 8) & self.data.bit(bit)
    }

    /// The low bits of a register that keeps what is written to it.
    fn word(&self, graph: &'g Graph, register: Register, name: &str, bits: u32) -> Signal<'g> {
        let kept = graph.register(name, bits, 0);
        let written = self.of(register);
        let parts: Vec<_> = (0..bits.div_ceil(8))
            .map(|byte| {
                let (low, width) = (8 * byte, 8.min(bits - 8 * byte));
                self.bytes.bit(byte).select(self.data.slice(low, width), kept.slice(low, width))
            })
            .rev()
            .collect();
        kept.next_if(written, Signal::join(&parts));
        kept.value()
    }
}

/// The channels AR and R of the slave, one read at a time.
struct Reads<'g> {
    ready: Signal<'g>,
    answered: Signal<'g>,
    happens: Signal<'g>,
    word: Signal<'g>,
}

impl<'g> Reads<'g> {
    fn new(graph: &'g Graph, bus: &ControlInputs<Signal<'g>>, awake: Signal<'g>) -> Self {
        let busy = graph.register("read_busy", 1, 0);
        let ready = awake & !*busy;
        let takes = (bus.s_axi_control_arvalid & ready).named("read_taken");
        let happens = takes.registered("register_read");
        let answered = graph.register("read_answered", 1, 0);
        let leaves = (*answered & bus.s_axi_control_rready).named("read_leaves");
        answered.next(happens | (*answered & !leaves));
        busy.next(takes | (*busy & !leaves));
        let word = graph.data_register("read_word", REGISTER_ADDRESS_BITS - 2);
        word.next_if(takes, word_of(bus.s_axi_control_araddr));
        Self { ready, answered: answered.value(), happens, word: *word }
    }

    /// True if the first word of a register is read in this cycle.
    fn of(&self, register: Register) -> Signal<'g> {
        self.happens & self.word.is((register.offset / 4).into())
    }

    /// The word that is read, registered.
    fn select(&self, graph: &'g Graph, values: &[(Register, Signal<'g>)]) -> Signal<'g> {
        let mut all = graph.constant(WORD_BITS, 0);
        for (register, value) in values {
            let value = value.extend(WORD_BITS * register.words);
            for word in 0..register.words {
                let number = register.offset / 4 + word;
                let part = value.slice(WORD_BITS * word, WORD_BITS);
                all = all | part.gate(self.word.is(number.into()));
            }
            all = all.named(&format!("through_{}", register.name));
        }
        let shown = graph.data_register("read_value", WORD_BITS);
        shown.next_if(self.happens, all);
        shown.value()
    }
}
