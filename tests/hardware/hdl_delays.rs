//! Delays of one value become one chain, in whatever order they were requested.

use contact_afu::hdl::{DelayModel, Evaluator, Graph, Module, Op, Primitive, Signal, delay_block};

/// The delays of a module: cycles, and the name of the delayed value unless that is itself a delay.
fn delays(module: &Module) -> Vec<(u32, Option<String>)> {
    let mut found: Vec<_> = module
        .nodes
        .iter()
        .filter_map(|node| match node.op {
            Op::Delay { cycles } => Some((cycles, module.node(node.operands[0]).name.clone())),
            _ => None,
        })
        .collect();
    found.sort();
    found
}

#[test]
fn different_distances_share_their_registers() {
    let g = Graph::new("shared");
    let x = g.input("x", 8);
    g.output("five", x.delay(5));
    g.output("three", x.delay(3));
    g.output("also_five", x.delay(2).delay(3));
    g.output("six", x.delay(1).delay(4).delay(1));
    let module = g.finish().unwrap();
    // Six registers in total: a delay of a few cycles is made of registers.
    assert_eq!(delays(&module), [vec![(1, None); 5], vec![(1, Some("x".to_owned()))]].concat());

    let mut run = Evaluator::new(&module, &[]).unwrap();
    for t in 0..30_u32 {
        run.set("x", u128::from(t + 1));
        let ago = |cycles: u32| u128::from((t + 1).saturating_sub(cycles));
        for (port, cycles) in [("five", 5), ("three", 3), ("also_five", 5), ("six", 6)] {
            assert_eq!(run.get(port), ago(cycles), "{port} at {t}");
        }
        run.step();
    }
}

#[test]
fn a_chain_that_is_only_passed_through_is_one_delay() {
    let g = Graph::new("through");
    let x = g.input("x", 8);
    g.output("y", x.delay(1).delay(1).delay(1).delay(7));
    assert_eq!(delays(&g.finish().unwrap()), [(10, Some("x".to_owned()))]);
}

#[test]
fn delays_that_nothing_needs_lengthen_nothing() {
    let g = Graph::new("dead");
    let x = g.input("x", 8);
    let _ = x.delay(8) + x.delay(4);
    g.output("y", x.delay(7));
    assert_eq!(delays(&g.finish().unwrap()), [(7, Some("x".to_owned()))]);
}

/// A delay memory takes its input directly from registers and wiring. The result of logic passes a register first.
#[test]
fn what_logic_computes_passes_a_register_before_a_memory() {
    let cycles = |build: fn(&Graph) -> Signal<'_>, cycles: u32| {
        let g = Graph::new("late");
        g.output("y", build(&g).delay(cycles));
        delays(&g.finish().unwrap()).into_iter().map(|(cycles, _)| cycles).collect::<Vec<_>>()
    };
    assert_eq!(cycles(|g| g.input("a", 24), 5), [5]);
    assert_eq!(cycles(|g| g.input("a", 30).low(12).concat(g.input("b", 12)), 5), [5]);
    assert_eq!(cycles(|g| g.input("a", 24) + g.input("b", 24), 5), [1, 4]);
    // At three cycles a wide delay is already a memory, but not if its input would have to pass a register first.
    assert_eq!(cycles(|g| g.input("a", 24), 3), [3]);
    assert_eq!(cycles(|g| g.input("a", 24) + g.input("b", 24), 3), [1, 1, 1]);
    // A delay of few bits is not a memory.
    assert_eq!(cycles(|g| g.input("a", 4) + g.input("b", 4), 5), [5]);
}

#[test]
fn of_equal_delays_the_named_one_stays() {
    let g = Graph::new("named");
    let x = g.input("x", 8);
    g.output("a", x.delay(2).delay(2).plus(1));
    g.output("b", x.delay(4).named("x_late").plus(2));
    let module = g.finish().unwrap();
    let names: Vec<_> = module.nodes.iter().filter(|n| matches!(n.op, Op::Delay { .. })).map(|n| &n.name).collect();
    assert_eq!(names, [&Some("x_late".to_owned())]);
}

#[test]
fn delays_through_registers_and_in_circles_stay_what_they_are() {
    let g = Graph::new("circle");
    let round = g.wire("round", 4);
    let x = g.input("x", 4);
    round.drive((round.delay(2).delay(1) + x).delay(1));
    g.output("y", round);
    let still = g.wire("still", 4);
    still.drive(still.delay(3));
    g.output("z", still.delay(2));
    let module = g.finish().unwrap();
    let mut run = Evaluator::new(&module, &[]).unwrap();
    let mut seen = vec![0_u128; 4];
    for t in 0..40 {
        run.set("x", t % 16);
        assert_eq!((run.get("y"), run.get("z")), (seen[seen.len() - 1], 0), "at {t}");
        // y(t + 1) = y(t - 3) + x(t)
        seen.push((seen[seen.len() - 4] + t % 16) % 16);
        run.step();
    }
}

#[test]
fn wires_in_a_circle_are_an_error_wherever_it_is_entered() {
    let g = Graph::new("wires");
    let (a, b, c) = (g.wire("a", 1), g.wire("b", 1), g.wire("c", 1));
    a.drive(b);
    b.drive(c);
    c.drive(b);
    g.output("y", a);
    let error = g.finish().unwrap_err().to_string();
    assert!(error.starts_with("wires: combinational loop through `"), "{error}");
}

/// A delay in a block memory has its exact length at every wrap of its pointer. Too small a delay gets no block memory.
#[test]
fn delays_in_blocks_are_as_long_as_they_say() {
    let plain = DelayModel::default();
    let blocks = plain.clone().with_registered_tables(Some(Primitive::Dp16kd));
    for cycles in [18, 19, 33, 34, 64, 514] {
        assert!(delay_block(cycles, 32, &plain).unwrap().is_none());
        let module = delay_block(cycles, 32, &blocks).unwrap().expect("a block");
        assert_eq!(module.latency, cycles);
        let mut run = Evaluator::new(&module, &[]).unwrap();
        for t in 0..3 * cycles {
            run.set("value", u128::from(t + 1));
            if t >= cycles {
                assert_eq!(run.get("delayed"), u128::from(t - cycles + 1), "{cycles} cycles, at {t}");
            }
            run.step();
        }
    }
    for (cycles, width) in [(17, 32), (515, 32), (18, 23), (18, 37)] {
        assert!(delay_block(cycles, width, &blocks).unwrap().is_none(), "{cycles} cycles of {width} bits");
    }
}
