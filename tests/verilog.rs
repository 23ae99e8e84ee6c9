//! The Verilog printer: a pipeline, a module with state, and an array of instances, held by golden files.

use std::sync::Arc;

use contact_afu::hdl::verilog::{Style, emit};
use contact_afu::hdl::{Graph, Module, Reset};
use expect_test::expect_file;

/// One copy of an array: adds its number to a shared value where it is chosen.
fn slot() -> Arc<Module> {
    let graph = Graph::new("slot");
    graph.about("adds its own number to the value where it is chosen");
    let index = graph.input("index", 7);
    let chosen = graph.input("chosen", 7);
    let value = graph.input("value", 7);
    let sum = (index + value).named("sum");
    graph.output("result", sum.gate(index.equals(chosen)).delay(1));
    graph.finish().unwrap()
}

fn top() -> Arc<Module> {
    let graph = Graph::new("top");
    graph.about("a counter, a delay line, a memory and an array");
    let count = graph.parameter("SCPUS", 10, 1..=64, 7);
    let enable = graph.input("enable", 1);
    let data = graph.input("data", 12);
    let position = graph.register("position", 4, 0);
    let wrapped = position.is(11).named("wrapped");
    position.next_if(enable, wrapped.select(position.same(0), position.plus(1)));
    let store = graph.memory("store", 12, 12);
    store.write(enable, position.value(), data);
    graph.output("stored", store.read(position.value()));
    graph.output("late", data.delay(9));
    graph.output("later", data.delay(79));
    let slots = graph.array("slots", &slot(), count, &[("chosen", data.low(7)), ("value", data.slice(5, 7))]);
    graph.output("result", slots.output("result"));
    graph.output("last", count.equals(data.low(7)));
    graph.finish().unwrap()
}

#[test]
fn golden_slot() {
    expect_file!["golden/slot.v"].assert_eq(&emit(&slot(), &Style::default()));
}

#[test]
fn golden_top() {
    let style = Style { header: vec!["contact-afu test".to_owned()], ..Style::default() };
    expect_file!["golden/top.v"].assert_eq(&emit(&top(), &style));
}

#[test]
fn golden_top_asynchronous_reset() {
    let style = Style { reset: Reset { asynchronous: true, active_low: true }, header: vec![] };
    let text = emit(&top(), &style);
    assert!(text.contains("always @(posedge clk or negedge rst_n) begin\n    if (!rst_n) begin"), "{text}");
    assert!(!text.contains(" rst "), "{text}");
}
