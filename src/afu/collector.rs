//! The collector: reads the source lines of a job, as many at once as there is room for, and announces them in order.
//!
//! A line's slot in the reorder memory is the low part of its number and of its request's tag. The upper part of the
//! tag is the job's epoch, which identifies responses to an earlier job, so that they are dropped.
//!
//! The feeder counts the announced lines and names the place that it reads. A line arrives
//! [two cycles](super::lines) after its place.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module};

use super::awaited::{self, Arrival, awaited};
use super::counter::{Countdown, Level, from_zero, up_down};
use super::in_order::{self, goes_in_order};
use super::lines::{self, Access, line_memory};
use super::port::{ReadInputs, ReadOutputs, outputs};
use super::slice::slice;
use super::{ADDRESS_BITS, COUNT_BITS, EPOCH_BITS, Spec};

/// Cycles from the first cycle in which it runs to its first request.
pub(super) const CYCLES_TO_REQUEST: u32 = 2;
/// Cycles from a response to the announcement of its line, if it is the next in order.
pub(super) const CYCLES_TO_LINE: u32 = 1 + in_order::CYCLES_TO_GO;

/// Builds the module `contact_afu_collector`.
pub(super) fn collector(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_collector");
    graph.about("reads source lines ahead, puts out-of-order responses back in order");
    let slots = spec.max_outstanding;
    let slot_bits = slots.ilog2();

    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let drops = graph.input("drops_requests", 1);
    let source = graph.input("source", ADDRESS_BITS);
    let lines = graph.input("lines", COUNT_BITS);
    let epoch = graph.input("epoch", EPOCH_BITS);
    let taken = graph.input("taken", 1);
    let place = graph.input("place", slot_bits);
    let link = ReadInputs::of(spec).map(|port| port.input(&graph));

    // Requests: one for each free slot, in order of lines.
    let remaining = Countdown::new(&graph, "lines_to_request", COUNT_BITS);
    let next_address = graph.data_register("next_address", ADDRESS_BITS);
    let next_slot = graph.data_register("next_slot", slot_bits);
    let free = Level::new(&graph, "free", slot_bits + 1, slots.into());
    // One cycle ahead, it is known whether a request may be made. One copy asks, one counts what was asked.
    let asks_next = graph.wire("asks_next", 1);
    let may_ask = asks_next.copies("may_ask", 2);
    let (asks, counts) = (may_ask[0], may_ask[1]);
    let tag = epoch.concat(next_slot.value());
    let fields = [("address", next_address.value()), ("tag", tag)];
    let port = slice(&graph, "rd_req", [start, drops], asks, &fields, link.rd_req_ready);
    let (request_address, request_tag) = (port.fields[0], port.fields[1]);
    let issue = (counts & port.has_room).named("issue");
    let some_left = remaining.connect(start, lines, issue);
    next_address.next_if(start | issue, start.select(source, next_address.plus(1)));
    from_zero(next_slot, start, issue, next_slot.plus(1));
    // A slot is free once its line was taken.
    let freed = (taken & !start).registered("freed");
    let some_free = free.connect(start, freed, issue);
    asks_next.drive(run & some_left.and(some_free).at(issue).named("some_left_and_free"));

    // Responses go into the slot that the tag names. A response that no request waits for overwrites a line there and
    // ends the job.
    let clears = awaited::clears(&graph, start);
    let arrival = Arrival::new(slots, [link.rd_rsp_valid, link.rd_rsp_tag, epoch]);
    let error = link.rd_rsp_error.delay(1).named("response_error");
    let answers =
        awaited(&graph, slots, [start, clears, run], [port.accepted, request_tag.low(slot_bits)], &arrival, error);
    let outstanding = graph.register("outstanding", slot_bits + 1, 0);
    up_down(outstanding, start, *free.counted, answers.answered);

    // Lines are announced in order.
    let comes = goes_in_order(&graph, "line_comes", slots, [start, clears], arrival.slot, answers.answered);
    let always = graph.constant(1, 1);
    let access = Access {
        write: &lines::steering(spec, slots, "response_is_current", [arrival.valid, arrival.comes]),
        write_index: arrival.slot,
        line: link.rd_rsp_data.delay(1).named("response_line"),
        read: &[always],
        read_index: place,
        advance: &[always],
    };
    let line = line_memory(&graph, spec, "reorder", slots, &access)?;

    let requests = ReadOutputs { rd_req_valid: port.valid, rd_req_address: request_address, rd_req_tag: request_tag };
    outputs(&graph, requests.named());
    graph.output("line_comes", comes);
    graph.output("line", line);
    graph.output("answered", answers.answered);
    graph.output("failed", answers.failed);
    graph.output("responded", answers.responded);
    graph.output("idle", (!outstanding.any() & port.is_empty & !counts & !*free.counted).registered("idle"));
    graph.finish()
}
