//! The collector: reads the source lines of a job, as many at once as there is room for, and passes them on in order.
//!
//! A line's slot in the reorder memory is the low part of its number and of its request's tag. The upper part of the
//! tag is the job's epoch, which identifies responses to an earlier job, so that they are dropped.
//!
//! A line arrives [two cycles](super::lines) after it was offered, whatever is taken in the meantime.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module};

use super::awaited::{Port, awaited};
use super::counter::{Countdown, all_used, up_down};
use super::in_order::{self, Arrival, goes_in_order};
use super::lines::{Access, line_memory};
use super::port::{ReadInputs, ReadOutputs, outputs};
use super::{ADDRESS_BITS, COUNT_BITS, EPOCH_BITS, Spec};

/// Cycles from the first cycle in which it runs to its first request.
pub(super) const CYCLES_TO_REQUEST: u32 = 2;
/// Cycles from a response to the offer of its line, if it is the next in order.
pub(super) const CYCLES_TO_LINE: u32 = in_order::CYCLES_TO_COME + 1;

/// Builds the module `contact_afu_collector`.
pub(super) fn collector(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_collector");
    graph.about("reads source lines ahead, puts out-of-order responses back in order");
    let slots = spec.max_outstanding;
    let slot_bits = slots.ilog2();

    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let source = graph.input("source", ADDRESS_BITS);
    let lines = graph.input("lines", COUNT_BITS);
    let epoch = graph.input("epoch", EPOCH_BITS);
    let take = graph.input("take", 1);
    let link = ReadInputs::of(spec).map(|port| port.input(&graph));

    // Requests: one for each free slot, in order of lines.
    let remaining = Countdown::new(&graph, "lines_to_request", COUNT_BITS);
    let next_address = graph.data_register("next_address", ADDRESS_BITS);
    let next_slot = graph.register("next_slot", slot_bits, 0);
    let reserved = graph.register("reserved", slot_bits + 1, 0);
    let request_valid = graph.register("rd_req_valid", 1, 0);
    let request_address = graph.data_register("rd_req_address", ADDRESS_BITS);
    let request_tag = graph.data_register("rd_req_tag", spec.tag_bits());

    let port_free = (!*request_valid | link.rd_req_ready).named("port_free");
    // One cycle ahead, it is known whether a request may be made.
    let may_ask = graph.register("may_ask", 1, 0);
    let issue = (*may_ask & port_free).named("issue");
    request_valid.next(issue | (*request_valid & !link.rd_req_ready));
    request_address.next_if(issue, next_address.value());
    request_tag.next_if(issue, epoch.concat(next_slot.value()));
    let some_left = remaining.connect(start, lines, issue);
    next_address.next_if(start | issue, start.select(source, next_address.plus(1)));
    next_slot.next_if(start | issue, start.select(next_slot.same(0), next_slot.plus(1)));
    // A slot is free one cycle after its line was taken.
    let taken = (take & !start).registered("taken");
    up_down(reserved, start, issue, taken);
    may_ask.next(run & some_left & !all_used(reserved, issue, taken));

    // Responses go into the slot that the tag names. A response that no request waits for overwrites a line there and
    // ends the job.
    let response_epoch = link.rd_rsp_tag.high(EPOCH_BITS).named("response_epoch");
    let response = (link.rd_rsp_valid & response_epoch.equals(epoch)).named("is_current");
    let response_slot = link.rd_rsp_tag.low(slot_bits).named("response_slot");
    let arrival = Arrival { valid: response, slot: response_slot };
    let port = Port { valid: request_valid.value(), ready: link.rd_req_ready, slot: request_tag.low(slot_bits) };
    let answers = awaited(&graph, slots, [start, run], &port, &arrival, link.rd_rsp_error);
    let outstanding = graph.register("outstanding", slot_bits + 1, 0);
    up_down(outstanding, start, issue, answers.answered);

    // Lines are offered in order, up to two ahead of the line that is taken. So an offer never depends on what is taken
    // in the same cycle.
    let line_valid = graph.register("line_valid", 1, 0);
    let two_valid = graph.register("two_valid", 1, 0);
    let offers = goes_in_order(&graph, slots, start, response_slot, answers.answered, !*two_valid);
    two_valid.next(!start & !take & (*two_valid | (*line_valid & offers)));
    line_valid.next(!start & (offers | *two_valid | (*line_valid & !take)));
    let head = graph.register("head", slot_bits, 0);
    head.next_if(start | take, start.select(head.same(0), head.plus(1)));
    let always = graph.constant(1, 1);
    let access = Access {
        write: response,
        write_index: response_slot,
        line: link.rd_rsp_data,
        read: always,
        read_index: head.value(),
        advance: always,
    };
    let line = line_memory(&graph, spec, "reorder", slots, &access)?;

    let requests = ReadOutputs {
        rd_req_valid: request_valid.value(),
        rd_req_address: request_address.value(),
        rd_req_tag: request_tag.value(),
    };
    outputs(&graph, requests.named());
    graph.output("line_valid", line_valid.value());
    graph.output("line", line);
    graph.output("answered", answers.answered);
    graph.output("failed", answers.failed);
    graph.output("unexpected", answers.unexpected);
    graph.output("idle", !outstanding.any() & !*request_valid & !*may_ask);
    graph.finish()
}
