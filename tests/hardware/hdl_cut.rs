//! Cutting modules into stages: small cases with known stages.

use contact_afu::hdl::{DelayModel, Evaluator, Graph, Module, Op, cut};

/// Round delays: a gate takes 1 ns, a sum 2 ns plus 1 ns per bit.
fn simple() -> DelayModel {
    DelayModel {
        name: "simple".to_owned(),
        register: 0.0,
        lut: 2.0,
        lut_inputs: 4,
        gate: 1.0,
        mux: 3.0,
        carry: 2.0,
        carry_bit: 1.0,
        carry_out: 0.0,
        multiplier: 50.0,
        multiplier_bits: 18,
        margin: 0.0,
        ..DelayModel::guess()
    }
}

/// The clock in MHz with a period of `ns`.
fn period(ns: f64) -> f64 {
    1000.0 / ns
}

fn stage_of(module: &Module, name: &str) -> Option<u32> {
    module.nodes.iter().find(|node| node.name.as_deref() == Some(name)).expect("a node of that name").stage
}

#[test]
fn a_chain_fills_stages_up_to_the_period() {
    let g = Graph::new("chain");
    let x = g.input("x", 8);
    let y = (1..=6).fold(x, |value, k| (value + x).named(&format!("times_{}", k + 1)));
    g.output("y", y);
    let module = g.finish().unwrap();
    for (ns, stages, clock) in [(10.0, 6, 10.0), (19.9, 6, 10.0), (20.0, 3, 20.0), (30.0, 2, 30.0), (60.0, 1, 60.0)] {
        let pipeline = cut(&module, &simple(), period(ns)).unwrap();
        assert_eq!(pipeline.latency, stages, "at {ns} ns");
        let timing = pipeline.timing.as_ref().unwrap();
        assert!((timing.clock_mhz - period(clock)).abs() < 1e-6, "{timing:?}");
        assert_eq!(timing.critical.len(), (clock / 10.0) as usize, "{timing:?}");
    }
}

#[test]
fn an_operation_that_takes_too_long_stands_alone_and_is_reported() {
    let g = Graph::new("slow");
    let (a, b) = (g.input("a", 18), g.input("b", 18));
    let product = (a.plus(1).named("a_more") * (!b).named("b_not")).named("product");
    g.output("y", product.high(18).plus(1).named("more"));
    let pipeline = cut(&g.finish().unwrap(), &simple(), period(25.0)).unwrap();
    let stages = ["a_more", "product", "more"].map(|name| stage_of(&pipeline, name));
    assert_eq!(stages, [Some(0), Some(1), Some(2)]);
    let timing = pipeline.timing.as_ref().unwrap();
    assert_eq!(timing.critical, ["b_not", "product"]);
    assert_eq!(timing.stage, 1);
    assert!((timing.clock_mhz - period(50.0)).abs() < 1e-6);
}

#[test]
fn a_product_of_one_block_has_its_registers_inside() {
    let g = Graph::new("blocks");
    let (a, b) = (g.input("a", 12), g.input("b", 18));
    // Operands of a block may arrive late in a stage, and the logic after it begins a stage. A wider product is no
    // block.
    let product = (a.plus(1) * b).named("product");
    g.output("y", product.high(18).plus(1) ^ b);
    g.output("z", a.concat(b) * a.concat(b));
    g.output("square", a * a);
    let model = simple().with_registered_multipliers(None);
    let pipeline = cut(&g.finish().unwrap(), &model, period(50.0)).unwrap();
    assert_eq!(stage_of(&pipeline, "product"), Some(2));
    let blocks: Vec<_> = pipeline.instances.iter().map(|instance| instance.module.name.as_str()).collect();
    assert_eq!(blocks, ["multiplier_18x12", "multiplier_12x12"]);
    assert!(pipeline.instances.iter().all(|instance| instance.module.latency == 2));
    let mut run = Evaluator::new(&pipeline, &[]).unwrap();
    let operands: Vec<(u128, u128)> = (0..100).map(|t| (t * 37 % 4096, t * 4099 % (1 << 18))).collect();
    for cycle in 0..operands.len() + pipeline.latency as usize {
        if let Some(&(a, b)) = cycle.checked_sub(pipeline.latency as usize).map(|then| &operands[then]) {
            let y = (((((a + 1) % 4096 * b) >> 12) + 1) % (1 << 18)) ^ b;
            let whole = a << 18 | b;
            assert_eq!((run.get("y"), run.get("z"), run.get("square")), (y, whole * whole, a * a), "{a} {b}");
        }
        let (a, b) = operands.get(cycle).copied().unwrap_or_default();
        run.set("a", a);
        run.set("b", b);
        run.step();
    }
}

/// Values may share a name, as those of four squares do; their instances have different names.
#[test]
fn blocks_of_one_name_are_instances_of_two() {
    let g = Graph::new("twice");
    let (a, b) = (g.input("a", 12), g.input("b", 12));
    g.output("y", (a * a).named("tile") ^ (b * b).named("tile"));
    let pipeline = cut(&g.finish().unwrap(), &simple().with_registered_multipliers(None), period(50.0)).unwrap();
    let names: Vec<_> = pipeline.instances.iter().map(|instance| instance.name.as_str()).collect();
    assert_eq!(names, ["tile_block", "tile_block_1"]);
    let mut evaluator = Evaluator::new(&pipeline, &[]).unwrap();
    evaluator.set("a", 30);
    evaluator.set("b", 50);
    (0..pipeline.latency).for_each(|_| evaluator.step());
    assert_eq!(evaluator.get("y"), 900 ^ 2500);
}

#[test]
fn outputs_are_registered_and_aligned_and_constants_never_wait() {
    let g = Graph::new("aligned");
    let (a, b) = (g.input("a", 8), g.input("b", 8));
    let size = g.parameter("SIZE", 3, 1..=9, 8);
    g.output("early", a);
    g.output("late", ((a + b) + size).plus(7));
    g.output("seven", g.constant(3, 7));
    g.output("size_more", size.plus(1));
    let pipeline = cut(&g.finish().unwrap(), &simple(), period(10.0)).unwrap();
    assert_eq!(pipeline.latency, 3);
    for port in pipeline.ports.iter().filter(|port| port.output) {
        let is_register = matches!(pipeline.node(port.node.unwrap()).op, Op::Delay { .. });
        assert_eq!(is_register, port.name == "early" || port.name == "late", "{}", port.name);
    }
    for node in &pipeline.nodes {
        if let Op::Delay { .. } = node.op {
            let of = &pipeline.node(node.operands[0]).op;
            assert!(!matches!(of, Op::Constant(_) | Op::Parameter(_)), "{of:?} is delayed");
            assert_eq!(node.name, None);
        }
    }
    let mut run = Evaluator::new(&pipeline, &[("SIZE", 5)]).unwrap();
    for t in 0..20_u128 {
        run.set("a", t);
        run.set("b", 2 * t);
        run.step();
        assert_eq!((run.get("seven"), run.get("size_more")), (7, 6));
        if let Some(then) = t.checked_sub(2) {
            assert_eq!((run.get("early"), run.get("late")), (then, 3 * then + 12));
        }
    }
}

#[test]
fn operations_move_to_where_fewer_bits_wait() {
    let g = Graph::new("moves");
    let (a, b) = (g.input("a", 8), g.input("b", 8));
    let chain = (0..4).fold(b, |value, _| value + b);
    // The output needs only one bit derived from a, so that bit is computed early and delayed instead of a.
    let any = a.any().named("a_any");
    // Sixteen bits derived from b are computed at the end, because b is delayed anyway.
    let twice = b.concat(!b).named("b_twice");
    g.output("y", any.repeat(16).named("spread") & chain.extend(16) & twice);
    let pipeline = cut(&g.finish().unwrap(), &simple(), period(10.0)).unwrap();
    assert_eq!(pipeline.latency, 5);
    assert_eq!(stage_of(&pipeline, "a_any"), Some(0));
    assert_eq!(stage_of(&pipeline, "spread"), Some(4));
    assert_eq!(stage_of(&pipeline, "b_twice"), Some(4));
    // Registers: b, its four sums and a_any (one bit), then 16 bits at the output.
    assert_eq!(pipeline.timing.as_ref().unwrap().register_bits, 4 * 8 + 4 * 8 + 4 + 16);
}

#[test]
fn what_cannot_be_cut_is_said_together() {
    let g = Graph::new("clocked");
    let x = g.input("x", 8);
    g.output("a", x.delay(1).named("x_late"));
    let state = g.register("state", 8, 0);
    state.next(x);
    g.output("b", *state);
    let module = g.finish().unwrap();
    let errors = cut(&module, &simple(), f64::NAN).unwrap_err();
    assert_eq!(errors.0.len(), 3);
    let text = errors.to_string();
    for part in ["a clock of NaN MHz", "`x_late` is clocked", "`state` is clocked", "tests/hardware/hdl_cut.rs"] {
        assert!(text.contains(part), "{part} is missing in: {text}");
    }
    for clock in [0.0, -1.0, f64::INFINITY] {
        assert!(cut(&module, &simple(), clock).is_err());
    }
}
