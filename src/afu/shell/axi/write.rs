//! Writes: bursts on the channels AW and W, an acknowledgement of each line out of the responses of the channel B.
//!
//! Lines wait in a memory until their burst is closed, so a burst that has begun never waits for the core, and an abort
//! leaves none without its data. W does not wait for AW. All bursts have one ID, so responses arrive in their order.

use std::sync::Arc;

use super::burst::{Bursts, Lines, beats, bursts, length, most_lines};
use super::port::BYTE_ADDRESS_BITS;
use crate::afu::counter::{Outstanding, oldest_place};
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
    let acknowledges = graph.register("acknowledges", 1, 0);
    let in_hand = Outstanding::new(&graph, "lines_taken", index_bits + 1);
    let awvalid = graph.register("awvalid", 1, 0);
    let next_valid = graph.register("next_burst", 1, 0);
    let may_close = (!*awvalid & !*next_valid).named("may_close");
    let lines = Lines { valid, address, in_hand, done: *acknowledges, may_close, response: bvalid };
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

    // The channel W: the burst whose lines leave, and the next one. A line passes a register between the memory, whose
    // output comes late, and the choice of a beat.
    let next_more = graph.data_register("next_burst_more", most_lines(spec).ilog2());
    next_more.next_if(closes, more);
    let active = graph.register("burst_leaves", 1, 0);
    let present = graph.register("line_present", 1, 0);
    let wvalid = graph.register("wvalid", 1, 0);
    let sends = (*present & (!*wvalid | wready)).named("beat_leaves");
    let (part, line_ends) = Beats::of(spec).next(&graph, sends);
    let line_leaves = (sends & line_ends).named("line_leaves");
    let fetches = (*active & (!*present | line_leaves)).named("line_fetched");
    present.next(fetches | (*present & !line_leaves));
    let left = graph.data_register("lines_left", most_lines(spec).ilog2());
    let fetches_last = (fetches & !left.any()).named("last_line_fetched");
    let begins = (*next_valid & (!*active | fetches_last)).named("burst_begins_to_leave");
    active.next(begins | (*active & !fetches_last));
    next_valid.next(closes | (*next_valid & !begins));
    left.next_if(begins | fetches, begins.select(*next_more, left.minus(1)));
    let oldest_line = store.read(oldest_place(&graph, "head", index_bits, fetches)).named("oldest_line");
    let leaving = graph.data_register("leaving", spec.line_bits);
    leaving.next_if(fetches, oldest_line);
    let is_last = graph.data_register("leaving_is_last", 1);
    is_last.next_if(fetches, !left.any());
    wvalid.next(sends | (*wvalid & !wready));
    let wdata = graph.data_register("wdata", spec.config.bus);
    wdata.next_if(sends, part(*leaving));
    let wlast = graph.data_register("wlast", 1);
    wlast.next_if(sends, line_ends & *is_last);

    // The channel B: responses wait in order, and each acknowledges the lines of its burst, one per cycle.
    let sent = graph.memory("sent", slots, ADDRESS_BITS + most_lines(spec).ilog2());
    let sent_tail = graph.register("sent_tail", index_bits, 0);
    sent_tail.next_if(closes, sent_tail.plus(1));
    sent.write(closes, *sent_tail, first.concat(more));
    let responses = graph.memory("responses", slots, 2);
    let response_tail = graph.register("response_tail", index_bits, 0);
    response_tail.next_if(answered, response_tail.plus(1));
    responses.write(answered, *response_tail, response);
    // A response is in its memory's output two cycles after it was written, and two after the one before it has had
    // its turn.
    let waiting = Outstanding::new(&graph, "responses_waiting", index_bits + 1);
    let acknowledged = graph.data_register("lines_to_acknowledge", most_lines(spec).ilog2());
    let turned = graph.register("response_turned", 1, 0);
    let turns = (waiting.any() & !*turned & (!*acknowledges | !acknowledged.any())).named("response_turns");
    turned.next(turns);
    waiting.connect(answered.registered("answered_before"), turns);
    let response_head = graph.register("response_head", index_bits, 0);
    response_head.next_if(turns, response_head.plus(1));
    let burst = sent.read(*response_head).named("burst");
    let outcome = responses.read(*response_head).named("outcome");
    acknowledges.next(turns | (*acknowledges & acknowledged.any()));
    let more_bits = most_lines(spec).ilog2();
    let burst_lines = burst.low(more_bits);
    acknowledged.next(turns.select(burst_lines, acknowledged.minus(1)));
    let failure = graph.data_register("failure", 2);
    failure.next_if(turns, outcome.gate(outcome.bit(1)));
    let failed_address = graph.data_register("failed_address", ADDRESS_BITS);
    failed_address.next_if(turns, burst.drop_low(more_bits));
    let first_line = turns.registered("first_line");
    let oldest = tags.read(oldest_place(&graph, "tag_head", index_bits, *acknowledges)).named("oldest");

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
    graph.output("idle", (!in_hand.any()).named("none_taken"));
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
