//! The dispatcher: keeps finished lines, writes them in order, and waits for every acknowledgement.
//!
//! A tag is the job's epoch and a slot. Slots are used in turn, and each is reused only after its acknowledgement.
//!
//! With `--results hits`, the number of lines is not known in advance. The host says how many it has room for; the rest
//! are dropped as they come, and the job ends with an error.

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{BuildErrors, Graph, Module};

use super::awaited::{self, Arrival, awaited};
use super::counter::{Countdown, Level, from_zero, up_down};
use super::in_order::goes_in_order;
use super::lines::{self, Access, line_memory};
use super::port::{WriteInputs, WriteOutputs, outputs};
use super::{ADDRESS_BITS, COUNT_BITS, EPOCH_BITS, Spec};

/// Cycles from a line to its write request: stored, at the head, in the memory's register at the port.
pub(super) const CYCLES_TO_REQUEST: u32 = 3;
/// Cycles from an acknowledgement until it is counted.
pub(super) const CYCLES_TO_IDLE: u32 = 1 + awaited::CYCLES_TO_ANSWER + 2;

/// Builds the module `contact_afu_dispatcher`, with room for `depth` (a power of two) lines.
pub(super) fn dispatcher(spec: &Spec, depth: u32) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_dispatcher");
    graph.about("keeps finished lines, writes them in order, waits for every acknowledgement");
    let slots = spec.max_outstanding;
    let slot_bits = slots.ilog2();
    let place_bits = depth.ilog2();

    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let drops = graph.input("drops_requests", 1);
    let destination = graph.input("destination", ADDRESS_BITS);
    let epoch = graph.input("epoch", EPOCH_BITS);
    let finished = graph.input("line_valid", 1);
    let line = graph.input("line", spec.line_bits);
    let link = WriteInputs::of(spec).map(|port| port.input(&graph));
    let bounded = spec.config.results == Results::Hits;

    // A line that the host has no room for is not stored.
    let comes = if bounded {
        let lines = graph.input("lines", COUNT_BITS);
        let room = Countdown::new(&graph, "lines_of_room", COUNT_BITS);
        let fits = room.any;
        let comes = (finished & fits).named("comes");
        room.connect(start, lines, comes);
        let overflowed = graph.register("overflowed", 1, 0);
        overflowed.next(!start & (*overflowed | finished & !fits));
        graph.output("overflowed", overflowed.value());
        comes
    } else {
        finished
    };

    // Finished lines wait in a memory; the oldest one has been read already. It cannot overflow: a pair enters an SCPU
    // only when its result has a place here. A line that was read is counted as stored for one more cycle.
    let tail = graph.data_register("tail", place_bits);
    let head = graph.data_register("head", place_bits);
    let stored = Level::new(&graph, "stored", place_bits + 1, 0);
    let read_valid = graph.register("read_valid", 1, 0);
    let may_go = graph.wire("may_go", 1);
    let goes = (may_go & *read_valid).named("goes");
    let read = (!*read_valid | may_go).named("read");
    let take = (read & *stored.any).named("take");
    from_zero(tail, start, comes, tail.plus(1));
    from_zero(head, start, take, head.plus(1));
    stored.connect(start, comes, take);
    let next_read_valid = !start & (take | (*read_valid & !goes));
    read_valid.next(next_read_valid);

    // Write requests. Whether one may be sent is decided one cycle ahead.
    let free = Level::new(&graph, "free", slot_bits + 1, slots.into());
    let may_send = graph.register("may_send", 1, 0);
    let valid = graph.register("wr_req_valid", 1, 0);
    let moves = (!*valid | link.wr_req_ready).named("wr_req_moves");
    may_go.drive(*may_send & moves);
    // A request that is at the port when its job is given up stays until it is taken, even during the next job.
    let next_valid = (goes & !drops) | !moves;
    valid.next(next_valid);
    let of_job = graph.register("wr_req_of_job", 1, 0);
    of_job.next(!start & (moves | *of_job));
    let accepted = *valid & link.wr_req_ready & *of_job;
    let slot = graph.data_register("wr_req_slot", slot_bits);

    // Acknowledgements, in any order.
    let clears = awaited::clears(&graph, start);
    let arrival = Arrival::new(slots, [link.wr_rsp_valid, link.wr_rsp_tag, epoch]);
    let error = link.wr_rsp_error.delay(1).named("response_error");
    let answers = awaited(&graph, slots, [start, clears, run], [accepted, slot.value()], &arrival, error);
    let freed = goes_in_order(&graph, "freed", slots, [start, clears], arrival.slot, answers.answered);
    let next_may_send = run & free.connect(start, freed, goes).at(goes).named("some_free");
    may_send.next(next_may_send);
    let outstanding = graph.register("outstanding", slot_bits + 1, 0);
    up_down(outstanding, start, *free.counted, answers.answered);

    // The line at the port is in the memory's own register, which takes what comes next whenever the port is free.
    // What decides it stands beside each part of the memory.
    let beside = |name, state, next| lines::steering(spec, depth, name, [state, next]);
    let holds = beside("port_holds", *valid, next_valid);
    let was_read = beside("was_read", *read_valid, next_read_valid);
    let sends = beside("sends", *may_send, next_may_send);
    let advance: Vec<_> = (holds.iter().enumerate())
        .map(|(part, holds)| (!*holds | link.wr_req_ready).named(&format!("advances_{part}")))
        .collect();
    let reads = was_read.iter().zip(&sends).zip(&advance).enumerate();
    let read: Vec<_> = reads
        .map(|(part, ((was, sends), moves))| (!*was | (*sends & *moves)).named(&format!("reads_{part}")))
        .collect();
    let access = Access {
        write: &[comes],
        write_index: tail.value(),
        line,
        read: &read,
        read_index: head.value(),
        advance: &advance,
    };
    let request_data = line_memory(&graph, spec, "finished", depth, &access)?;

    // Address and tag are counted at the port, as requests leave. A job's first are there before its first line, once
    // no request of an earlier job is.
    let counts = (advance[0] & (holds[0] | !*of_job)).named("counts_request");
    let request_address = graph.data_register("wr_req_address", ADDRESS_BITS);
    request_address.next_if(counts, of_job.select(request_address.plus(1), destination));
    slot.next_if(counts, slot.plus(1).gate(*of_job));
    let request_epoch = graph.data_register("wr_req_epoch", EPOCH_BITS);
    request_epoch.next_if(counts, epoch);
    let request_tag = request_epoch.concat(*slot);

    let requests = WriteOutputs {
        wr_req_valid: valid.value(),
        wr_req_address: request_address.value(),
        wr_req_tag: request_tag,
        wr_req_data: request_data,
    };
    outputs(&graph, requests.named());
    if bounded {
        // The packer is stopped a few cycles before the memory is full, because lines are still in flight.
        graph.output("accepts", (!stored.count.high(2).any()).registered("accepts"));
    } else {
        graph.output("line_left", stored.counted.value());
    }
    graph.output("answered", answers.answered);
    graph.output("failed", answers.failed);
    graph.output("responded", answers.responded);
    // It is busy in the cycle in which a request reaches the port, and in the next one.
    graph.output("idle", (!outstanding.any() & !*valid & !goes & !*free.counted).registered("idle"));
    graph.output("empty", (!start & !*stored.any & !*read_valid).registered("empty"));
    graph.finish()
}
