//! The collector: reads the source lines of a job, as many at once as there is room for, and hands them on in order.
//!
//! A line's slot in the reorder memory is the low part of its number and the low part of its request's tag; the
//! upper part of the tag is the job's epoch, by which responses to an earlier job are known and dropped.

use std::sync::Arc;

use crate::hdl::{Errors, Graph, Module, Signal};

use super::{ADDRESS_BITS, COUNT_BITS, EPOCH_BITS, Spec};

/// From the first cycle in which it runs to its first request.
pub(super) const CYCLES_TO_REQUEST: u32 = 1;
/// From a response to the line offered, if it is the next in order.
pub(super) const CYCLES_TO_LINE: u32 = 2;

/// Builds the module `contact_afu_collector`.
pub(super) fn collector(spec: &Spec) -> Result<Arc<Module>, Errors> {
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
    let request_ready = graph.input("rd_req_ready", 1);
    let response_valid = graph.input("rd_rsp_valid", 1);
    let response_tag = graph.input("rd_rsp_tag", EPOCH_BITS + slot_bits);
    let response_data = graph.input("rd_rsp_data", spec.line_bits);
    let response_error = graph.input("rd_rsp_error", 1);

    // Requests: one for each free slot, in order of lines.
    let remaining = graph.register("lines_to_request", COUNT_BITS, 0);
    let next_address = graph.data_register("next_address", ADDRESS_BITS);
    let next_slot = graph.register("next_slot", slot_bits, 0);
    let reserved = graph.register("reserved", slot_bits + 1, 0);
    let request_valid = graph.register("rd_req_valid", 1, 0);
    let request_address = graph.data_register("rd_req_address", ADDRESS_BITS);
    let request_tag = graph.data_register("rd_req_tag", EPOCH_BITS + slot_bits);

    let port_free = (!*request_valid | request_ready).named("port_free");
    let slot_free = (!reserved.msb()).named("slot_free");
    let issue = (run & remaining.any() & slot_free & port_free).named("issue");
    request_valid.next(issue | (*request_valid & !request_ready));
    request_address.next_if(issue, next_address.value());
    request_tag.next_if(issue, epoch.concat(next_slot.value()));
    remaining.next(start.select(lines, issue.select(remaining.minus(1), *remaining)));
    next_address.next_if(start | issue, start.select(source, next_address.plus(1)));
    next_slot.next(start.select(next_slot.same(0), next_slot.value() + issue.extend(slot_bits)));
    reserved.next(start.select(reserved.same(0), up_down(*reserved, issue, take)));

    // Responses: into the slot the tag names.
    let response_epoch = response_tag.high(EPOCH_BITS).named("response_epoch");
    let response = (response_valid & response_epoch.equals(epoch)).named("response");
    let response_slot = response_tag.low(slot_bits).named("response_slot");
    let store = graph.memory("reorder", slots, spec.line_bits);
    store.write(response, response_slot, response_data);
    let outstanding = graph.register("outstanding", slot_bits + 1, 0);
    outstanding.next(start.select(outstanding.same(0), up_down(*outstanding, issue, response)));

    // Lines leave in order: the slot at the head, once it is filled. The memory's registered read runs one line ahead.
    let head = graph.register("head", slot_bits, 0);
    let next_head = (head.value() + take.extend(slot_bits)).named("next_head");
    head.next(start.select(head.same(0), next_head));
    let filled = graph.register("filled", slots, 0);
    let arrived = response_slot.one_hot().gate(response).named("arrived");
    let left = head.one_hot().gate(take).named("left");
    filled.next(start.select(filled.same(0), (*filled | arrived) & !left));
    let line_valid = graph.register("line_valid", 1, 0);
    line_valid.next(!start & (*filled & next_head.one_hot()).any());

    graph.output("rd_req_valid", request_valid.value());
    graph.output("rd_req_address", request_address.value());
    graph.output("rd_req_tag", request_tag.value());
    graph.output("line_valid", line_valid.value());
    graph.output("line", store.read(next_head).named("line"));
    graph.output("response", response);
    graph.output("failed", response & response_error);
    graph.output("asking", request_valid.value());
    graph.output("idle", !outstanding.any() & !*request_valid);
    graph.finish()
}

/// A counter that one event takes up and another down.
pub(super) fn up_down<'g>(count: Signal<'g>, up: Signal<'g>, down: Signal<'g>) -> Signal<'g> {
    let width = count.width();
    count + up.extend(width) - down.extend(width)
}
