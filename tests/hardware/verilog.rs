//! The Verilog printer: a pipeline, a module with state, and a chain of instances, compared with golden files.

use std::sync::Arc;

use contact_afu::hdl::verilog::{Memories, Style, emit};
use contact_afu::hdl::{Evaluator, Graph, Module, Reset};
use expect_test::expect_file;

/// One copy of a chain: answers with its number added to a shared value if it is selected, else passes on what comes.
fn slot() -> Arc<Module> {
    let graph = Graph::new("slot");
    graph.about("adds its own number to the value where it is chosen, else passes on");
    let index = graph.input("index", 7);
    let chosen = graph.input("chosen", 7);
    let value = graph.input("value", 7);
    let sum = (index + value).named("sum");
    let passed = graph.input("result_in", 7);
    graph.output("result_out", index.equals(chosen).select(sum, passed).delay(1));
    graph.finish().unwrap()
}

fn top() -> Arc<Module> {
    let graph = Graph::new("top");
    graph.about("a counter, a delay line, a memory and a chain");
    let count = graph.parameter("SCPUS", 10, 1..=64, 7);
    let in_fours = graph.rounded_down("SCPUS_IN_FOURS", count, 4);
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
    let inputs = [("chosen", data.low(7)), ("value", data.slice(5, 7)), ("result_in", graph.constant(7, 0))];
    graph.output("result", graph.chain("slots", &slot(), in_fours, &inputs).output("result_out"));
    graph.output("last", count.equals(data.low(7)));
    graph.finish().unwrap()
}

#[test]
fn golden_slot() {
    expect_file!["../golden/slot.v"].assert_eq(&emit(&slot(), &Style::default()));
}

#[test]
fn golden_top() {
    let style = Style { header: vec!["contact-afu test".to_owned()], ..Style::default() };
    expect_file!["../golden/top.v"].assert_eq(&emit(&top(), &style));
}

/// Copies beyond the rounded number do not exist, so what comes in comes out.
#[test]
fn a_chain_has_a_rounded_number_of_copies_and_a_register_each() {
    for (scpus, copies) in [(3, 3), (4, 4), (7, 4), (8, 8), (10, 8), (64, 64)] {
        let mut run = Evaluator::new(&top(), &[("SCPUS", scpus)]).unwrap();
        run.set("enable", 0);
        for index in 0..64 {
            let data = 0x800 | index;
            run.set("data", data);
            // The result of a copy passes the copies behind it, a register each.
            let behind = if index < copies { copies - index } else { copies };
            for cycle in 0..behind {
                assert_eq!(run.get("result"), 0, "{scpus}, {index}, {cycle}");
                run.step();
                run.set("data", 0x87F);
            }
            let sum = (index + (data >> 5)) & 127;
            assert_eq!(run.get("result"), if index < copies { sum } else { 0 }, "{scpus}, {index}");
            run.step();
        }
    }
    assert!(Evaluator::new(&top(), &[("SCPUS_IN_FOURS", 4)]).is_err(), "computed");
}

#[test]
fn golden_top_asynchronous_reset() {
    let style = Style { reset: Reset { asynchronous: true, active_low: true }, ..Style::default() };
    let text = emit(&top(), &style);
    assert!(text.contains("always @(posedge clk or negedge rst_n) begin\n    if (!rst_n) begin"), "{text}");
    assert!(!text.contains(" rst "), "{text}");
}

/// M20K is a block of some Intel families. An iCE40 has no memories made of look-up tables.
#[test]
fn a_memory_asks_for_what_the_family_has() {
    let graph = Graph::new("memories");
    let (small, large) = (graph.input("few_words", 12).delay(16), graph.input("many_words", 12).delay(300));
    graph.output("from_small", small);
    graph.output("from_large", large);
    let module = graph.finish().unwrap();
    let attributes = |memories| {
        let text = emit(&module, &Style { memories, ..Style::default() });
        text.lines().filter(|line| line.contains("(*")).map(|line| line.trim().to_owned()).collect::<Vec<_>>()
    };
    let small = r#"(* ram_style = "distributed", ramstyle = "MLAB, no_rw_check" *)"#;
    assert_eq!(attributes(Memories::Any), [small, r#"(* ram_style = "block", ramstyle = "no_rw_check" *)"#]);
    let [small, large] = [r#"(* ram_style = "distributed" *)"#, r#"(* ram_style = "block", no_rw_check *)"#];
    assert_eq!(attributes(Memories::BlocksAndLuts), [small, large]);
    assert_eq!(attributes(Memories::Blocks), [large]);
}

#[test]
fn a_top_that_resets_itself_has_no_reset_port() {
    let counter = Graph::new("counter");
    let count = counter.register("count", 4, 9);
    count.next(count.plus(1));
    counter.output("value", *count);
    let graph = Graph::new("board");
    let (reset_n, soft_reset) = (graph.input("reset_n", 1), graph.input("soft_reset", 1));
    graph.reset_by(!reset_n | soft_reset);
    let unit = graph.instance("unit", &counter.finish().unwrap(), &[]);
    graph.output("value", unit.output("value"));
    // State of its own, which another register resets.
    let own = graph.register("own", 4, 9);
    own.next(own.plus(1));
    graph.output("own_value", *own);
    let board = graph.finish().unwrap();
    expect_file!["../golden/board.v"].assert_eq(&emit(&board, &Style::default()));
    let low = emit(&board, &Style { reset: Reset { asynchronous: false, active_low: true }, ..Style::default() });
    assert!(low.contains(".rst_n (~in_reset_unit)") && low.contains("assign rst_n = ~in_reset;"), "{low}");
    let mut run = Evaluator::new(&board, &[]).unwrap();
    run.set("reset_n", 1);
    let mut seen = Vec::new();
    for cycle in 0..6 {
        run.set("soft_reset", u128::from(cycle == 2));
        run.step();
        assert_eq!(run.get("own_value"), run.get("value"), "both are reset in one cycle");
        seen.push(run.get("value"));
    }
    assert_eq!(seen, [10, 11, 12, 9, 10, 11], "a cycle after the signal, the register's");
}
