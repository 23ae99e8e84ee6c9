//! Reads: bursts on the channel AR, lines out of the beats of the channel R.
//!
//! All bursts have one ID, so beats arrive in the order of the lines. The tags of the lines that are on their way wait
//! in that order, with their addresses; each has its epoch. A line of a job that was given up comes with its own tag,
//! and the core drops it.

use std::sync::Arc;

use super::burst::{Bursts, Lines, beats, bursts, length};
use super::port::BYTE_ADDRESS_BITS;
use crate::afu::counter::{Outstanding, oldest_place};
use crate::afu::{ADDRESS_BITS, Spec};
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Builds the module `axi_read`.
pub(super) fn read(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("axi_read");
    graph.about("merges reads of lines into bursts, and lines out of their beats");
    let (tag_bits, bus) = (spec.tag_bits(), spec.config.bus);
    let valid = graph.input("rd_valid", 1);
    let address = graph.input("rd_address", ADDRESS_BITS);
    let tag = graph.input("rd_tag", tag_bits);
    let arready = graph.input("arready", 1);
    let heard = |name: &str, width: u32| graph.input(name, width).delay(1).named(&format!("{name}_heard"));
    let rvalid = graph.input("rvalid", 1).registered("rvalid_heard");
    let (data, response, last) = (heard("rdata", bus), heard("rresp", 2), heard("rlast", 1));

    // Lines that were asked for and have not come yet.
    let expected = Outstanding::new(&graph, "lines_expected", spec.max_outstanding.ilog2() + 1);
    let arvalid = graph.register("arvalid", 1, 0);
    let beat = (rvalid & expected.any()).named("beat");
    let last_beat = (beat & last).named("last_beat");
    // A line is complete with its last beat.
    let (line, complete) = assembled(&graph, beats(spec), beat, data);
    let lines = Lines { valid, address, in_hand: expected, done: complete, may_close: !*arvalid, response: last_beat };
    let Bursts { ready, accepted, closes, first, more, .. } = bursts(&graph, spec, &lines);
    arvalid.next(closes | (*arvalid & !arready));
    let araddr = graph.data_register("araddr", BYTE_ADDRESS_BITS);
    araddr.next_if(closes, first.concat(graph.constant(BYTE_ADDRESS_BITS - ADDRESS_BITS, 0)));
    let arlen = graph.data_register("arlen", 8);
    arlen.next_if(closes, length(&graph, spec, more));

    let failure = graph.register("failure", 2, 0);
    let is_failed = response.bit(1);
    let worst = failure.any().select(*failure, response.gate(is_failed)).named("worst");
    failure.next_if(beat, worst.gate(!complete));

    let index_bits = spec.max_outstanding.ilog2();
    let tags = graph.memory("expected", spec.max_outstanding, ADDRESS_BITS + tag_bits);
    let tail = graph.register("tail", index_bits, 0);
    tail.next_if(accepted, tail.plus(1));
    tags.write(accepted, *tail, address.concat(tag));
    let oldest = tags.read(oldest_place(&graph, "head", index_bits, complete)).named("oldest");

    let failed = complete & worst.any();
    graph.output("rd_ready", ready);
    graph.output("arvalid", arvalid.value());
    graph.output("araddr", araddr.value());
    graph.output("arlen", arlen.value());
    graph.output("rsp_valid", complete.registered("line_complete"));
    graph.output("rsp_tag", oldest.low(tag_bits).delay(1));
    graph.output("rsp_data", line.delay(1));
    graph.output("rsp_error", failed.delay(1));
    graph.output("failed", failed.registered("line_failed"));
    graph.output("failed_response", worst.delay(1));
    graph.output("failed_address", oldest.drop_low(tag_bits).delay(1));
    graph.output("unasked", (rvalid & !expected.any()).registered("beat_unasked"));
    graph.output("idle", (!expected.any()).named("none_expected"));
    graph.finish()
}

/// The line of which `data` is the present beat, and whether that beat completes it.
fn assembled<'g>(graph: &'g Graph, beats: u32, beat: Signal<'g>, data: Signal<'g>) -> (Signal<'g>, Signal<'g>) {
    if beats == 1 {
        return (data, beat);
    }
    let number = graph.register("beat_number", beats.ilog2(), 0);
    number.next_if(beat, number.plus(1));
    let before = graph.data_register("beats_before", (beats - 1) * data.width());
    let line = data.concat(*before).named("line");
    before.next_if(beat, line.drop_low(data.width()));
    (line, (beat & number.all()).named("complete"))
}
