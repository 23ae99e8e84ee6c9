//! The dispatcher: keeps finished lines, writes them in order, and waits for every acknowledgement.
//!
//! A tag is the job's epoch and a slot; slots are used in turn, each again only after its acknowledgement.
//!
//! Where only contacts come back, nobody knows beforehand how many lines there will be: the host says how many it has
//! room for, and those beyond are dropped and told.

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{Errors, Graph, Module};

use super::collector::up_down;
use super::{ADDRESS_BITS, COUNT_BITS, EPOCH_BITS, Spec};

/// From a line to its write request: stored, at the head, registered.
pub(super) const CYCLES_TO_REQUEST: u32 = 3;
/// From an acknowledgement to its being counted.
pub(super) const CYCLES_TO_IDLE: u32 = 1;

/// Builds the module `contact_afu_dispatcher`, with room for `depth` (a power of two) lines.
pub(super) fn dispatcher(spec: &Spec, depth: u32) -> Result<Arc<Module>, Errors> {
    let graph = Graph::new("contact_afu_dispatcher");
    graph.about("keeps finished lines, writes them in order, waits for every acknowledgement");
    let slots = spec.max_outstanding;
    let slot_bits = slots.ilog2();
    let place_bits = depth.ilog2();

    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let destination = graph.input("destination", ADDRESS_BITS);
    let epoch = graph.input("epoch", EPOCH_BITS);
    let line_valid = graph.input("line_valid", 1);
    let line = graph.input("line", spec.line_bits);
    let request_ready = graph.input("wr_req_ready", 1);
    let response_valid = graph.input("wr_rsp_valid", 1);
    let response_tag = graph.input("wr_rsp_tag", EPOCH_BITS + slot_bits);
    let response_error = graph.input("wr_rsp_error", 1);
    let bounded = spec.config.results == Results::Hits;

    // Finished lines wait in a memory; its registered read runs one line ahead. It cannot overflow: a pair enters
    // an SCPU only when its result has a place here.
    let store = graph.memory("finished", depth, spec.line_bits);
    let tail = graph.register("tail", place_bits, 0);
    let head = graph.register("head", place_bits, 0);
    let stored = graph.register("stored", place_bits + 1, 0);
    let ready = graph.register("ready", 1, 0);
    let take = graph.wire("take", 1);
    store.write(line_valid, tail.value(), line);
    tail.next(start.select(tail.same(0), tail.value() + line_valid.extend(place_bits)));
    let next_head = (head.value() + take.extend(place_bits)).named("next_head");
    head.next(start.select(head.same(0), next_head));
    let left = (stored.value() - take.extend(place_bits + 1)).named("left");
    let next_stored = start.select(stored.same(0), left + line_valid.extend(place_bits + 1));
    stored.next(next_stored);
    ready.next(!start & left.any());

    // Write requests.
    let next_address = graph.data_register("next_address", ADDRESS_BITS);
    let next_slot = graph.register("next_slot", slot_bits, 0);
    let busy = graph.register("busy_slots", slots, 0);
    let request_valid = graph.register("wr_req_valid", 1, 0);
    let request_address = graph.data_register("wr_req_address", ADDRESS_BITS);
    let request_tag = graph.data_register("wr_req_tag", EPOCH_BITS + slot_bits);
    let request_data = graph.data_register("wr_req_data", spec.line_bits);
    let slot_free = (!(*busy & next_slot.one_hot()).any()).named("slot_free");
    let port_free = (!*request_valid | request_ready).named("port_free");
    take.drive(run & *ready & slot_free & port_free);
    let send = if bounded {
        let lines = graph.input("lines", COUNT_BITS);
        let room = graph.register("lines_of_room", COUNT_BITS, 0);
        let fits = room.any().named("fits");
        let send = (take & fits).named("send");
        room.next(start.select(lines, room.value() - send.extend(COUNT_BITS)));
        let overflowed = graph.register("overflowed", 1, 0);
        overflowed.next(!start & (*overflowed | take & !fits));
        graph.output("overflowed", overflowed.value());
        // The packer hears a few cycles before the memory is full: lines are still on their way then.
        let accepts = graph.register("accepts", 1, 0);
        accepts.next(!next_stored.high(2).any());
        graph.output("accepts", accepts.value());
        send
    } else {
        take
    };
    request_valid.next(send | (*request_valid & !request_ready));
    request_address.next_if(send, next_address.value());
    request_tag.next_if(send, epoch.concat(next_slot.value()));
    request_data.next_if(send, store.read(next_head).named("oldest"));
    next_address.next_if(start | send, start.select(destination, next_address.plus(1)));
    next_slot.next(start.select(next_slot.same(0), next_slot.value() + send.extend(slot_bits)));

    // Acknowledgements, in any order.
    let response_epoch = response_tag.high(EPOCH_BITS).named("response_epoch");
    let response = (response_valid & response_epoch.equals(epoch)).named("response");
    let taken = next_slot.one_hot().gate(send).named("taken");
    let freed = response_tag.low(slot_bits).one_hot().gate(response).named("freed");
    busy.next(start.select(busy.same(0), (*busy | taken) & !freed));
    let outstanding = graph.register("outstanding", slot_bits + 1, 0);
    outstanding.next(start.select(outstanding.same(0), up_down(*outstanding, send, response)));

    graph.output("wr_req_valid", request_valid.value());
    graph.output("wr_req_address", request_address.value());
    graph.output("wr_req_tag", request_tag.value());
    graph.output("wr_req_data", request_data.value());
    if !bounded {
        graph.output("take", take);
    }
    graph.output("response", response);
    graph.output("failed", response & response_error);
    graph.output("asking", request_valid.value());
    graph.output("idle", !outstanding.any() & !*request_valid);
    graph.output("empty", !stored.any());
    graph.finish()
}
