//! Invalid operations: each is recorded with names and place, all are reported together, and none panics.

use std::sync::Arc;

use contact_afu::hdl::{DelayModel, Evaluator, Graph, Module, Signal, cut};
use proptest::prelude::*;

fn inner() -> Arc<Module> {
    let g = Graph::new("inner");
    let (x, y) = (g.input("x", 4), g.input("y", 2));
    g.output("sum", x + y.extend(4));
    g.finish().unwrap()
}

/// A module for a chain, faulty if its input has other than 4 bits, or without the register.
fn link(bits: u32, registered: bool) -> Arc<Module> {
    let g = Graph::new("link");
    g.output("x_out", g.input("x_in", bits).extend(4).delay(registered.into()));
    g.finish().unwrap()
}

/// The only error of a graph after `bad` ran with an 8-bit `a`, a 5-bit `b` and a 1-bit `c`.
fn error_of(bad: impl for<'g> FnOnce(&'g Graph, Signal<'g>, Signal<'g>, Signal<'g>)) -> String {
    let g = Graph::new("broken");
    let (a, b, c) = (g.input("a", 8), g.input("b", 5), g.input("c", 1));
    bad(&g, a, b, c);
    g.output("good", a);
    let errors = g.finish().expect_err("an error on record");
    assert_eq!(errors.0.len(), 1, "{errors}");
    assert_eq!(errors.0[0].module, "broken");
    assert_eq!(errors.0[0].place.file(), file!(), "{errors}");
    errors.0[0].message.clone()
}

macro_rules! bad {
    ($message:literal, |$g:ident, $a:ident, $b:ident, $c:ident| $body:expr) => {
        let message = error_of(|$g, $a, $b, $c| {
            let _ = ($g, $a, $b, $c);
            let _ = $body;
        });
        assert_eq!(message, $message);
    };
}

#[test]
fn operations_say_which_widths_do_not_match() {
    bad!("sum: `a` has 8 bits, `b` has 5", |g, a, b, c| a + b);
    bad!("difference: `b` has 5 bits, `a` has 8", |g, a, b, c| b - a);
    bad!("and: `a` has 8 bits, `b` has 5", |g, a, b, c| a & b);
    bad!("or: `a` has 8 bits, `b` has 5", |g, a, b, c| a | b);
    bad!("exclusive or: `a` has 8 bits, `b` has 5", |g, a, b, c| a ^ b);
    bad!("equals: `a` has 8 bits, `b` has 5", |g, a, b, c| a.equals(b));
    bad!("less than: `a` has 8 bits, `b` has 5", |g, a, b, c| a.less_than(b));
    bad!("select: `a` has 8 bits, `b` has 5", |g, a, b, c| c.select(a, b));
    bad!("select: the condition `b` has 5 bits, not 1", |g, a, b, c| b.select(a, a));
    bad!("slice: 3 bits from bit 6 of `a`, which has 8", |g, a, b, c| a.slice(6, 3));
    bad!("slice: 2 bits from bit 4294967295 of `a`, which has 8", |g, a, b, c| a.slice(u32::MAX, 2));
    bad!("slice: 0 bits from bit 0 of `a`, which has 8", |g, a, b, c| a.low(0));
    bad!("extend: `a` has 8 bits, more than 5", |g, a, b, c| a.extend(5));
    bad!("one hot: `Concat of 9 bits` has 9 bits, more than 8", |g, a, b, c| a.extend(9).one_hot());
    bad!("constant 256 does not fit 8 bits", |g, a, b, c| a.is(256));
    bad!("constant 0 does not fit 0 bits", |g, a, b, c| g.constant(0, 0));
}

#[test]
fn widths_stay_sensible() {
    bad!("repeat: 0 copies of `a`, which has 8 bits", |g, a, b, c| a.repeat(0));
    bad!("repeat: 8193 copies of `a`, which has 8 bits, are more than 65536 bits", |g, a, b, c| a.repeat(8193));
    bad!("repeat: 4294967295 copies of `a`, which has 8 bits, are more than 65536 bits", |g, a, b, c| a
        .repeat(u32::MAX));
    bad!("Constant(0) would have 4294967287 bits, more than 65536", |g, a, b, c| a.extend(u32::MAX));
    bad!("Constant(0) would have 4294967295 bits, more than 65536", |g, a, b, c| a.append_zeros(u32::MAX));
    bad!("Mul would have 80000 bits, more than 65536", |g, a, b, c| {
        let wide = a.repeat(5000);
        wide * wide
    });
    bad!("port `wide` has 65537 bits, more than 65536", |g, a, b, c| g.input("wide", 65537));
}

#[test]
fn ports_names_and_parameters_are_checked() {
    bad!("port `a` is declared twice", |g, a, b, c| g.input("a", 3));
    bad!("port `a` is declared twice", |g, a, b, c| g.output("a", b));
    bad!("port `none` has no bits", |g, a, b, c| g.input("none", 0));
    bad!("port `always` is not a Verilog identifier", |g, a, b, c| g.input("always", 1));
    bad!("`2nd` is not a Verilog identifier", |g, a, b, c| (!a).named("2nd"));
    bad!("parameter `P`: default 9 or its width 4 is outside 1..=8", |g, a, b, c| g.parameter("P", 9, 1..=8, 4));
    bad!("parameter `p-q` is not a Verilog identifier", |g, a, b, c| g.parameter("p-q", 1, 1..=8, 4));
    bad!("parameter `P` is declared twice", |g, a, b, c| (
        g.parameter("P", 1, 1..=8, 4),
        g.parameter("P", 1, 1..=8, 4)
    ));
}

#[test]
fn state_is_checked() {
    bad!("register `r`: configured value 4 does not fit 2 bits", |g, a, b, c| {
        let r = g.configured_register("r", 2, 4);
        r.next(r.value());
    });
    bad!("register `r`: reset value 4 does not fit 2 bits", |g, a, b, c| {
        let r = g.register("r", 2, 4);
        r.next(a.low(2));
    });
    bad!("`r` is never driven", |g, a, b, c| g.register("r", 2, 1));
    bad!("register `r` is connected twice", |g, a, b, c| {
        let r = g.register("r", 8, 1);
        r.next(a);
        r.next(a);
    });
    bad!("register `r` has 8 bits, its next value `b` has 5", |g, a, b, c| {
        let r = g.register("r", 8, 1);
        r.next(b);
        r.next(a);
    });
    bad!("enable of register `r` has 5 bits, not 1", |g, a, b, c| g.register("r", 8, 1).next_if(b, a));
    bad!("memory `m` of 1 words of 8 bits", |g, a, b, c| g.memory("m", 1, 8));
    bad!("memory `m`: address has 8 bits, not 5, data has 8 bits, not 9", |g, a, b, c| g
        .memory("m", 32, 9)
        .write(c, a, a));
    bad!("memory `m`: read address has 8 bits, not 5", |g, a, b, c| g.memory("m", 32, 9).read(a));
    bad!("memory `m` is written twice", |g, a, b, c| {
        let memory = g.memory("m", 32, 8);
        memory.write(c, b, a);
        memory.write(c, b, a);
    });
    bad!("`w` is never driven", |g, a, b, c| g.wire("w", 2));
    bad!("drive: `w` has 2 bits, `a` has 8", |g, a, b, c| {
        let w = g.wire("w", 2);
        w.drive(a);
        w.drive(a.low(2));
    });
    bad!("drive: `w` is driven twice", |g, a, b, c| {
        let w = g.wire("w", 8);
        w.drive(a);
        w.drive(a);
    });
    bad!("drive: `a` is not a wire", |g, a, b, c| a.drive(a.plus(1)));
}

#[test]
fn instances_are_checked() {
    let inner = inner();
    bad!("instance `i`: input `y` is not connected", |g, a, b, c| g.instance("i", &inner, &[("x", a.low(4))]));
    bad!("instance `i`: input `x` of `inner` has 4 bits, `a` has 8", |g, a, b, c| g.instance(
        "i",
        &inner,
        &[("x", a), ("y", b.low(2))]
    ));
    bad!("instance `i`: `inner` has no input `z`", |g, a, b, c| g.instance(
        "i",
        &inner,
        &[("x", a.low(4)), ("y", a.low(2)), ("z", a)]
    ));
    bad!("instance `i`: input `x` is connected twice", |g, a, b, c| g.instance(
        "i",
        &inner,
        &[("x", a.low(4)), ("y", a.low(2)), ("x", a.low(4))]
    ));
    bad!("instance `i` has no output `product`", |g, a, b, c| g
        .instance("i", &inner, &[("x", a.low(4)), ("y", a.low(2))])
        .output("product"));
    bad!("instance `wire` is not a Verilog identifier", |g, a, b, c| g.instance(
        "wire",
        &inner,
        &[("x", a.low(4)), ("y", a.low(2))]
    ));
    bad!("chain `i`: `a` is not a parameter", |g, a, b, c| g.chain("i", &link(4, true), a, &[("x_in", a.low(4))]));
    bad!("chain `i`: output `x_out` of `link` is not a register's", |g, a, b, c| {
        let count = g.parameter("LINKS", 2, 1..=8, 4);
        g.chain("i", &link(4, false), count, &[("x_in", a.low(4))])
    });
    bad!("chain `i`: output `x_out` of `link` has no input to go into", |g, a, b, c| {
        let count = g.parameter("LINKS", 2, 1..=8, 4);
        g.chain("i", &link(3, true), count, &[("x_in", a.low(3))])
    });
}

#[test]
fn signals_of_another_graph_are_refused_by_everything() {
    let other = Graph::new("other");
    let (s, s4) = (other.input("stranger", 8), other.input("stranger_4", 4));
    bad!("sum: `stranger` is a signal of another graph, `other`", |g, a, b, c| a + s);
    bad!("product: `stranger` is a signal of another graph, `other`", |g, a, b, c| a * s);
    bad!("select: `stranger` is a signal of another graph, `other`", |g, a, b, c| c.select(a, s));
    bad!("join: `stranger` is a signal of another graph, `other`", |g, a, b, c| a.concat(s));
    bad!("output: `stranger` is a signal of another graph, `other`", |g, a, b, c| g.output("o", s));
    bad!("memory read: `stranger` is a signal of another graph, `other`", |g, a, b, c| g.memory("m", 256, 8).read(s));
    bad!("memory write: `stranger` is a signal of another graph, `other`", |g, a, b, c| g
        .memory("m", 256, 8)
        .write(c, s, a));
    bad!("instance: `stranger_4` is a signal of another graph, `other`", |g, a, b, c| g.instance(
        "i",
        &inner(),
        &[("x", s4), ("y", a.low(2))]
    ));
    bad!("chain: `stranger` is a signal of another graph, `other`", |g, a, b, c| g.chain(
        "i",
        &link(4, true),
        s,
        &[("x_in", a.low(4))]
    ));
    bad!("drive: `stranger` is a signal of another graph, `other`", |g, a, b, c| {
        let w = g.wire("w", 8);
        w.drive(s);
        w.drive(a);
    });
    bad!("register: `stranger` is a signal of another graph, `other`", |g, a, b, c| {
        let r = g.register("r", 8, 0);
        r.next(s);
        r.next(a);
    });
}

#[test]
fn errors_come_together_and_poison_adds_none() {
    let g = Graph::new("many");
    let (a, b) = (g.input("a", 8), g.input("b", 5));
    let first = a + b;
    let line = line!() - 1;
    let second = b.slice(9, 9);
    // A result computed from poison is poison too, without another error.
    g.output("y", (first * second).any().select(first, !first).delay(3).append_zeros(2).msb());
    g.output("z", g.wire("loose", 3));
    let errors = g.finish().unwrap_err();
    let text = errors.to_string();
    assert_eq!(errors.0.len(), 3, "{text}");
    assert!(text.starts_with(&format!("many: sum: `a` has 8 bits, `b` has 5 ({}:{line})\n", file!())), "{text}");
    assert_eq!(errors.0[0].place.line() + 2, errors.0[1].place.line());
    assert!(errors.0[2].message.contains("`loose` is never driven"), "{text}");
}

#[test]
fn loops_are_found() {
    let g = Graph::new("looped");
    let (around, x) = (g.wire("around", 4), g.input("x", 4));
    around.drive((around + x).named("more"));
    g.output("y", around);
    let text = g.finish().unwrap_err().to_string();
    assert!(text.contains("combinational loop through `more`"), "{text}");
}

/// Calls any operation with any arguments.
fn call<'g>(
    g: &'g Graph,
    inner: &Arc<Module>,
    pool: &[Signal<'g>],
    (what, from, n): &(u8, [u16; 3], u32),
) -> Signal<'g> {
    let [a, b, c] = from.map(|from| pool[usize::from(from) % pool.len()]);
    let few = n % 12;
    let name = ["x", "y", "sum", "always", "", "9", "good"][*n as usize % 7];
    match what % 44 {
        0 => g.input(name, few),
        1 => g.constant(few, u128::from(from[0])),
        2 => g.parameter(name, few, 1..=n % 20, n / 3 % 9),
        3 => g.wire(name, few),
        4 => a & b,
        5 => a | b,
        6 => a ^ b,
        7 => a + b,
        8 => a - b,
        9 => a * b,
        10 => !a,
        11 => a.equals(b),
        12 => a.is(u128::from(few)),
        13 => a.is_zero(),
        14 => a.less_than(b),
        15 => a.greater_than(b),
        16 => a.at_least(b),
        17 => a.at_most(b),
        18 => a.plus(u128::from(few)),
        19 => a.minus(u128::from(few)),
        20 => a.any(),
        21 => a.all(),
        22 => a.one_hot(),
        23 => a.select(b, c),
        24 => a.gate(b),
        25 => a.bit(few),
        26 => a.msb(),
        27 => a.slice(few, n / 12 % 12),
        28 => a.slice(*n, few),
        29 => a.high(few),
        30 => a.drop_low(few),
        31 => Signal::join(&[a, b, c]),
        32 => a.repeat(if n % 3 == 0 { *n } else { few }),
        33 => a.extend(if n % 3 == 0 { *n } else { few }),
        34 => a.append_zeros(if n % 3 == 0 { *n } else { few }),
        35 => a.delay(if n % 3 == 0 { *n } else { few }),
        36 => {
            g.output(name, a);
            a.named(name)
        }
        37 => {
            a.drive(b);
            a
        }
        38 => {
            let register = g.register(name, few, u128::from(from[2]) % 9);
            if n % 2 == 0 {
                register.next(a)
            } else {
                register.next_if(a, b)
            }
            register.value()
        }
        39 => {
            let register = g.data_register(name, a.width());
            register.next(a);
            *register
        }
        40 => {
            let memory = g.memory(name, n % 9, few);
            memory.write(a, b, c);
            memory.read(b)
        }
        41 => g.instance("i", inner, &[("x", a), ("y", b)]).output(name),
        42 => g.chain("i", inner, a, &[("x", b), (name, c)]).output("sum"),
        _ => a.same(u128::from(*n)),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn nothing_panics(
        calls in prop::collection::vec((any::<u8>(), any::<[u16; 3]>(), any::<u32>()), 1..80),
        strangers: bool,
    ) {
        let (g, other) = (Graph::new("fuzzed"), Graph::new("other"));
        let inner = inner();
        let mut pool = vec![g.input("p", 8), g.input("q", 8), g.input("r", 1)];
        if strangers {
            pool.push(other.input("p", 8));
            pool.push(other.parameter("P", 2, 1..=2, 8));
        }
        for one in &calls {
            // Calls on a foreign signal are recorded in its own graph, and their results are foreign, too.
            pool.push(call(&g, &inner, &pool, one));
        }
        g.output("last", pool[pool.len() - 1]);
        for graph in [g, other] {
            // A graph without an error is a module, which can be run and is cut or rejected.
            if let Ok(module) = graph.finish() {
                if let Ok(mut run) = Evaluator::new(&module, &[]) {
                    run.step();
                    run.settle();
                }
                let _ = cut(&module, &DelayModel::default(), 200.0);
            }
        }
    }
}
