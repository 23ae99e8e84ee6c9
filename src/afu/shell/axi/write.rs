//! Writes: bursts on the channels AW and W, an acknowledgement of each line out of the responses of the channel B.
//!
//! Lines wait in a memory until their burst is closed, so a burst that has begun never waits for the core, and an abort
//! leaves none without its data. W does not wait for AW. All bursts have one ID, so responses arrive in their order.

use std::sync::Arc;

use super::burst::{Bursts, Lines, beats, bursts, length, most_lines};
use super::port::BYTE_ADDRESS_BITS;
use crate::afu::counter::up_down;
use crate::afu::{ADDRESS_BITS, Spec};
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Builds the module `axi_write`.
pub(super) fn write(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("axi_write");
    graph.about("merges writes of lines into bursts, and acknowledges each line");
    let (tag_bits, slots) = (spec.tag_bits(), spec.max_outstanding);
    let index_bits = slots.ilog2();
    let valid = graph.input("wr_valid", 1);
    let address = graph.input("wr_address", ADDRESS_BITS);
    let tag = graph.input("wr_tag", tag_bits);
    let line = graph.input("wr_data", spec.line_bits);
    let awready = graph.input("awready", 1);
    let wready = graph.input("wready", 1);
    let bvalid = graph.input("bvalid", 1).registered("bvalid_heard");
    let response = graph.input("bresp", 2).delay(1).named("bresp_heard");

    // Lines that were taken and not acknowledged yet.
    let count = graph.register("lines_taken", index_bits + 1, 0);
    let awvalid = graph.register("awvalid", 1, 0);
    let next_valid = graph.register("next_burst", 1, 0);
    let may_close = (!*awvalid & !*next_valid).named("may_close");
    let lines = Lines { valid, address, has_room: !count.msb(), may_close, response: bvalid };
    let Bursts { ready, accepted, closes, first, more, answered, none_in_flight } = bursts(&graph, spec, &lines);
    awvalid.next(closes | (*awvalid & !awready));
    let awaddr = graph.data_register("awaddr", BYTE_ADDRESS_BITS);
    awaddr.next_if(closes, first.concat(graph.constant(BYTE_ADDRESS_BITS - ADDRESS_BITS, 0)));
    let awlen = graph.data_register("awlen", 8);
    awlen.next_if(closes, length(&graph, spec, more));

    // The lines, and their tags, in order.
    let tail = graph.register("tail", index_bits, 0);
    tail.next_if(accepted, tail.plus(1));
    let store = graph.memory("stored", slots, spec.line_bits);
    store.write(accepted, *tail, line);
    let tags = graph.memory("taken", slots, tag_bits);
    tags.write(accepted, *tail, tag);

    // The channel W: the burst whose beats leave, and the next one.
    let next_more = graph.data_register("next_burst_more", most_lines(spec).ilog2());
    next_more.next_if(closes, more);
    let active = graph.register("burst_leaves", 1, 0);
    let wvalid = graph.register("wvalid", 1, 0);
    let sends = (*active & (!*wvalid | wready)).named("beat_leaves");
    let head = graph.register("head", index_bits, 0);
    let (part, line_ends) = Beats::of(spec).next(&graph, sends);
    let left = graph.data_register("lines_left", most_lines(spec).ilog2());
    let line_leaves = (sends & line_ends).named("line_leaves");
    let burst_ends = (line_ends & !left.any()).named("burst_ends");
    let begins = (*next_valid & (!*active | (sends & burst_ends))).named("burst_begins_to_leave");
    active.next(begins | (*active & !(sends & burst_ends)));
    next_valid.next(closes | (*next_valid & !begins));
    left.next_if(begins | line_leaves, begins.select(*next_more, left.minus(1)));
    let next_head = line_leaves.select(head.plus(1), *head).named("next_head");
    head.next(next_head);
    let leaving = store.read(next_head).named("leaving");
    wvalid.next(sends | (*wvalid & !wready));
    let wdata = graph.data_register("wdata", spec.config.bus);
    wdata.next_if(sends, part(leaving));
    let wlast = graph.data_register("wlast", 1);
    wlast.next_if(sends, burst_ends);

    // The channel B: responses wait in order, and each acknowledges the lines of its burst, one per cycle.
    let sent = graph.memory("sent", slots, ADDRESS_BITS + most_lines(spec).ilog2());
    let sent_tail = graph.register("sent_tail", index_bits, 0);
    sent_tail.next_if(closes, sent_tail.plus(1));
    sent.write(closes, *sent_tail, first.concat(more));
    let responses = graph.memory("responses", slots, 2);
    let response_tail = graph.register("response_tail", index_bits, 0);
    response_tail.next_if(answered, response_tail.plus(1));
    responses.write(answered, *response_tail, response);
    // A response is in its memory's output two cycles after it was written.
    let waiting = graph.register("responses_waiting", index_bits + 1, 0);
    let acknowledges = graph.register("acknowledges", 1, 0);
    let acknowledged = graph.data_register("lines_to_acknowledge", most_lines(spec).ilog2());
    let turns = (waiting.any() & (!*acknowledges | !acknowledged.any())).named("response_turns");
    up_down(waiting, graph.constant(1, 0), answered.registered("answered_before"), turns);
    let response_head = graph.register("response_head", index_bits, 0);
    let next_response = turns.select(response_head.plus(1), *response_head).named("next_response");
    response_head.next(next_response);
    let burst = sent.read(next_response).named("burst");
    let outcome = responses.read(next_response).named("outcome");
    acknowledges.next(turns | (*acknowledges & acknowledged.any()));
    let more_bits = most_lines(spec).ilog2();
    let burst_lines = burst.low(more_bits);
    acknowledged.next(turns.select(burst_lines, acknowledged.minus(1)));
    let failure = graph.data_register("failure", 2);
    failure.next_if(turns, outcome.gate(outcome.bit(1)));
    let failed_address = graph.data_register("failed_address", ADDRESS_BITS);
    failed_address.next_if(turns, burst.drop_low(more_bits));
    let first_line = turns.registered("first_line");
    let tag_head = graph.register("tag_head", index_bits, 0);
    let next_tag = acknowledges.select(tag_head.plus(1), *tag_head).named("next_tag");
    tag_head.next(next_tag);
    let oldest = tags.read(next_tag).named("oldest");
    up_down(count, graph.constant(1, 0), accepted, *acknowledges);

    graph.output("wr_ready", ready);
    graph.output("awvalid", awvalid.value());
    graph.output("awaddr", awaddr.value());
    graph.output("awlen", awlen.value());
    graph.output("wvalid", wvalid.value());
    graph.output("wdata", wdata.value());
    graph.output("wlast", wlast.value());
    graph.output("rsp_valid", acknowledges.value().registered("acknowledged"));
    graph.output("rsp_tag", oldest.delay(1));
    graph.output("rsp_error", failure.any().delay(1));
    graph.output("failed", (first_line & failure.any()).registered("burst_failed"));
    graph.output("failed_response", failure.delay(1));
    graph.output("failed_address", failed_address.delay(1));
    graph.output("unasked", (bvalid & none_in_flight).registered("response_unasked"));
    graph.output("idle", (!count.any()).named("none_taken"));
    graph.finish()
}

/// How a line leaves in beats.
struct Beats {
    number: u32,
    bus: u32,
}

impl Beats {
    fn of(spec: &Spec) -> Self {
        Self { number: beats(spec), bus: spec.config.bus }
    }

    /// Which part of a line is the present beat, and whether it is the line's last. A beat leaves where `sends` is set.
    fn next<'g>(
        self,
        graph: &'g Graph,
        sends: Signal<'g>,
    ) -> (impl FnOnce(Signal<'g>) -> Signal<'g> + use<'g>, Signal<'g>) {
        let Self { number, bus } = self;
        let counter = (number > 1).then(|| graph.register("beat_number", number.ilog2(), 0));
        let mut ends = graph.constant(1, 1);
        if let Some(counter) = counter {
            counter.next_if(sends, counter.plus(1));
            ends = counter.all().named("line_ends");
        }
        let part = move |line: Signal<'g>| {
            let mut parts: Vec<_> = (0..number).map(|beat| line.slice(beat * bus, bus)).collect();
            for bit in 0..number.ilog2() {
                let select = counter.map(|counter| counter.bit(bit));
                parts =
                    parts.chunks(2).map(|two| select.map_or(two[0], |select| select.select(two[1], two[0]))).collect();
            }
            parts[0]
        };
        (part, ends)
    }
}
