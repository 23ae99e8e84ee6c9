//! The evaluator on small modules whose behaviour is known.

use contact_afu::hdl::{EvaluateError, Evaluator, Graph, Signal};

#[test]
fn a_counter_counts_holds_and_is_reset() {
    let g = Graph::new("counter");
    let enable = g.input("enable", 1);
    let count = g.register("count", 4, 9);
    count.next_if(enable, count.plus(1));
    g.output("value", *count);
    let mut run = Evaluator::new(&g.finish().unwrap(), &[]).unwrap();
    assert_eq!(run.get("value"), 9);
    run.set("enable", 1);
    for expected in [10, 11, 12, 13, 14, 15, 0, 1] {
        run.step();
        assert_eq!(run.get("value"), expected);
    }
    run.set("enable", 0);
    run.step();
    assert_eq!(run.get("value"), 1);
    run.reset();
    assert_eq!(run.get("value"), 9);
}

#[test]
fn registers_sample_together() {
    let g = Graph::new("swap");
    let (a, b) = (g.register("a", 8, 1), g.register("b", 8, 2));
    a.next(*b);
    b.next(*a);
    g.output("a_now", *a);
    g.output("b_now", *b);
    let mut run = Evaluator::new(&g.finish().unwrap(), &[]).unwrap();
    for step in 0..5 {
        let expected = if step % 2 == 0 { (1, 2) } else { (2, 1) };
        assert_eq!((run.get("a_now"), run.get("b_now")), expected);
        run.step();
    }
}

#[test]
fn delays_of_every_length_lag_by_it() {
    let g = Graph::new("delays");
    let x = g.input("x", 100);
    for cycles in 1..=9 {
        g.output(&format!("d{cycles}"), x.delay(cycles));
    }
    let mut run = Evaluator::new(&g.finish().unwrap(), &[]).unwrap();
    let value = |t: u32| (u128::from(t) * 0x1_2345_6789_abcd_ef01_2345) & ((1 << 100) - 1);
    for t in 0..40 {
        for cycles in 1..=9 {
            let expected = if t < cycles { 0 } else { value(t - cycles) };
            assert_eq!(run.get(&format!("d{cycles}")), expected, "delay {cycles} at {t}");
        }
        run.set("x", value(t));
        run.step();
    }
}

#[test]
fn a_memory_read_gives_what_stood_there_unless_it_is_written() {
    let g = Graph::new("memory");
    let (enable, to, data, from) = (g.input("enable", 1), g.input("to", 3), g.input("data", 70), g.input("from", 3));
    let memory = g.memory("words", 5, 70);
    memory.write(enable, to, data);
    g.output("word", memory.read(from));
    let mut run = Evaluator::new(&g.finish().unwrap(), &[]).unwrap();
    let write = |run: &mut Evaluator, enable, to, data, from| {
        run.set("enable", enable);
        run.set("to", to);
        run.set("data", data);
        run.set("from", from);
        run.step();
        run.get("word")
    };
    assert_eq!(write(&mut run, 1, 3, 1 << 69 | 7, 3), (1 << 70) - 1, "all bits of the old word are wrong");
    assert_eq!(write(&mut run, 0, 3, 1, 3), 1 << 69 | 7, "written");
    assert_eq!(write(&mut run, 0, 3, 1, 3), 1 << 69 | 7, "nothing is written now");
    assert_eq!(write(&mut run, 1, 4, 5, 3), 1 << 69 | 7, "not written without enable");
    assert_eq!(write(&mut run, 1, 7, 9, 4), 5);
    assert_eq!(write(&mut run, 0, 0, 0, 7), 0, "nothing stands beyond the end");
}

#[test]
fn a_chain_passes_on_and_each_copy_knows_its_number() {
    let g = Graph::new("copy");
    let (x, index) = (g.input("x", 6), g.input("index", 3));
    let passed = g.input("y_in", 6);
    g.output("y_out", (passed | x.gate(x.slice(3, 3).equals(index)).named("mine")).delay(1));
    let copy = g.finish().unwrap();

    let g = Graph::new("top");
    let count = g.parameter("COPIES", 2, 1..=8, 4);
    let x = g.input("x", 6);
    g.output("y", g.chain("copies", &copy, count, &[("x", x), ("y_in", g.constant(6, 0))]).output("y_out"));
    g.output("copies_there", count);
    let top = g.finish().unwrap();

    for copies in [1, 2, 5] {
        let mut run = Evaluator::new(&top, &[("COPIES", copies)]).unwrap();
        assert_eq!(run.get("copies_there"), u128::from(copies));
        for x in 0..64 {
            run.set("x", x);
            (0..copies).for_each(|_| run.step());
            let expected = if x >> 3 < u128::from(copies) { x } else { 0 };
            assert_eq!(run.get("y"), expected);
        }
        let last = run.probe(&format!("copies[{}].mine", copies - 1)).expect("a named value");
        run.set("x", u128::from((copies - 1) << 3 | 5));
        assert_eq!(run.read(last), u64::from((copies - 1) << 3 | 5));
        assert!(run.probe(&format!("copies[{copies}].mine")).is_none());
        assert_eq!(run.probes().filter(|(path, _)| path.ends_with(".mine")).count(), copies as usize);
    }
    assert_eq!(
        Evaluator::new(&top, &[("COPIES", 9)]).unwrap_err().to_string(),
        "parameter `COPIES` = 9 is outside 1..=8"
    );
    assert_eq!(Evaluator::new(&top, &[("SCPUS", 1)]).unwrap_err().to_string(), "module `top` has no parameter `SCPUS`");
}

/// A module with two independent paths: a to x with no logic, b to y.
fn two_paths() -> std::sync::Arc<contact_afu::hdl::Module> {
    let g = Graph::new("two_paths");
    let (a, b) = (g.input("a", 4), g.input("b", 4));
    g.output("x", a.plus(1).named("a_more"));
    g.output("y", (!b).named("b_not"));
    g.finish().unwrap()
}

#[test]
fn a_value_may_pass_twice_through_one_instance_but_not_in_a_circle() {
    let inner = two_paths();
    let g = Graph::new("there_and_back");
    let through = g.wire("through", 4);
    let instance = g.instance("inner", &inner, &[("a", g.input("a", 4)), ("b", through)]);
    through.drive(instance.output("x"));
    g.output("y", instance.output("y"));
    let mut run = Evaluator::new(&g.finish().unwrap(), &[]).unwrap();
    run.set("a", 4);
    assert_eq!(run.get("y"), 10);
}

#[test]
fn a_loop_through_modules_is_named() {
    // `paths` of this module was edited to hide that x depends on a, as a faulty generator might.
    let mut lying = (*two_paths()).clone();
    lying.paths.iter_mut().for_each(|path| path.clear());
    let g = Graph::new("circle");
    let back = g.wire("back", 4);
    let instance = g.instance("inner", &std::sync::Arc::new(lying), &[("a", back), ("b", g.input("b", 4))]);
    back.drive(instance.output("x"));
    g.output("x", instance.output("x"));
    let error = Evaluator::new(&g.finish().unwrap(), &[]).unwrap_err();
    let EvaluateError::Loop(names) = &error else { panic!("{error}") };
    for name in ["back", "inner.a", "inner.a_more"] {
        assert!(names.iter().any(|n| n == name), "{name} is missing in: {error}");
    }
}

#[test]
fn wide_values_keep_every_bit() {
    let g = Graph::new("wide");
    let (a, b) = (g.input("a", 512), g.input("b", 512));
    let bit = g.input("one", 1);
    let outputs: [(&str, Signal<'_>); 6] = [
        ("sum", a + b),
        ("difference", a - b),
        ("product", a.low(130) * b.low(70)),
        ("middle", a.slice(37, 200)),
        ("rotated", a.low(61).concat(a.drop_low(61))),
        ("spread", bit.repeat(150)),
    ];
    for (name, value) in outputs {
        g.output(name, value);
    }
    g.output("less", a.less_than(b));
    let mut run = Evaluator::new(&g.finish().unwrap(), &[]).unwrap();
    let ones = [u64::MAX; 8];
    run.set_words("a", &ones);
    run.set_words("b", &[1]);
    run.set("one", 1);
    assert_eq!(run.get_words("sum"), [0; 8]);
    assert_eq!(run.get_words("difference"), [u64::MAX - 1, !0, !0, !0, !0, !0, !0, !0]);
    assert_eq!(run.get_words("product"), [!0, !0, 3, 0]);
    assert_eq!(run.get_words("middle"), [!0, !0, !0, 0xff]);
    assert_eq!(run.get_words("rotated"), ones);
    assert_eq!(run.get_words("spread"), [!0, !0, (1 << 22) - 1]);
    assert_eq!(run.get("less"), 0);
    run.set_words("a", &[0; 8]);
    run.set_words("b", &[0, 0, 0, 0, 0, 0, 0, 1]);
    assert_eq!(run.get("less"), 1);
    assert_eq!(run.get_words("difference"), [0, 0, 0, 0, 0, 0, 0, !0]);
}

#[test]
fn values_are_cut_to_their_port() {
    let g = Graph::new("cut");
    g.output("y", g.input("x", 3));
    let mut run = Evaluator::new(&g.finish().unwrap(), &[]).unwrap();
    run.set("x", 0xfff);
    assert_eq!(run.get("y"), 7);
    let (x, y) = (run.pin("x").unwrap(), run.pin("y").unwrap());
    run.write(x, 0xa);
    assert_eq!(run.read(y), 2);
    run.write(y, 1);
    assert_eq!(run.read(y), 2, "an output is not written");
}

/// An operation with a constant is folded while the graph is built: into nothing, or into less. This runs every
/// constant on either side of every operation, for every value of the other operand.
#[test]
fn operations_with_constants_come_to_what_they_would() {
    type Operation = (&'static str, for<'g> fn(Signal<'g>, Signal<'g>) -> Signal<'g>, fn(u128, u128) -> u128);
    let operations: [Operation; 8] = [
        ("and", |a, b| a & b, |a, b| a & b),
        ("or", |a, b| a | b, |a, b| a | b),
        ("xor", |a, b| a ^ b, |a, b| a ^ b),
        ("plus", |a, b| a + b, |a, b| a.wrapping_add(b)),
        ("minus", |a, b| a - b, |a, b| a.wrapping_sub(b)),
        ("equals", |a, b| a.equals(b), |a, b| u128::from(a == b)),
        ("less", |a, b| a.less_than(b), |a, b| u128::from(a < b)),
        ("at_most", |a, b| a.at_most(b), |a, b| u128::from(a <= b)),
    ];
    for width in [1, 3] {
        let g = Graph::new("constants");
        let x = g.input("x", width);
        for constant in 0..1 << width {
            for (name, operation, _) in operations {
                g.output(&format!("{name}_{constant}"), operation(x, x.same(constant)));
                g.output(&format!("c{constant}_{name}"), operation(x.same(constant), x));
            }
        }
        let mut run = Evaluator::new(&g.finish().unwrap(), &[]).unwrap();
        for x in 0..1 << width {
            run.set("x", x);
            for constant in 0..1 << width {
                for (name, _, expected) in operations {
                    let bits = if matches!(name, "equals" | "less" | "at_most") { 1 } else { width };
                    let expected = |a, b| expected(a, b) & ((1 << bits) - 1);
                    assert_eq!(run.get(&format!("{name}_{constant}")), expected(x, constant), "{x} {name} {constant}");
                    assert_eq!(run.get(&format!("c{constant}_{name}")), expected(constant, x), "{constant} {name} {x}");
                }
            }
        }
    }
}
