//! Kernels traced with wires: the operators they produce, when results are ready, and which kernels are rejected.

use contact_afu::hdl::{BuildErrors, DelayModel, Evaluator, Module, Op};
use contact_afu::number::{Format, Number, Soft};
use contact_afu::pipeline::{Bit, Kernel, KernelReport, Ports, Wire, trace};
use std::sync::Arc;

const FORMAT: Format = Format::BINARY32;

fn pipeline(kernel: &Kernel) -> Arc<Module> {
    kernel.pipeline(&DelayModel::default(), 200.0).unwrap()
}

fn traced(body: impl FnOnce(&Ports)) -> Arc<Module> {
    pipeline(&trace("kernel", body).unwrap())
}

fn refused(body: impl FnOnce(&Ports)) -> BuildErrors {
    trace("kernel", body).unwrap_err()
}

fn operators(module: &Module) -> Vec<(String, usize)> {
    KernelReport::of(module).operators.into_iter().map(|of| (of.module, of.instances)).collect()
}

/// Runs words through the pipeline, one set per cycle.
fn run(module: &Arc<Module>, words: &[[u32; 2]]) -> Vec<u32> {
    let mut evaluator = Evaluator::new(module, &[]).unwrap();
    let mut results = Vec::new();
    for cycle in 0..words.len() + module.latency as usize {
        let [a, b] = words.get(cycle).copied().unwrap_or([0; 2]);
        evaluator.set("a", a.into());
        evaluator.set("b", b.into());
        if cycle >= module.latency as usize {
            results.push(evaluator.get("y") as u32);
        }
        evaluator.step();
    }
    results
}

#[test]
fn operands_that_meet_are_of_the_same_cycle() {
    let module = traced(|ports| {
        let (a, b) = (ports.input("a", FORMAT), ports.input("b", FORMAT));
        // A quotient takes far longer than a sum.
        ports.output("y", (a / b + b) * a - (a + b));
    });
    let words: Vec<_> = (1..200_u32).map(|i| [(i as f32).sqrt().to_bits(), (0.1 * i as f32).to_bits()]).collect();
    let wanted = words.iter().map(|&[a, b]| {
        let (a, b) = (f32::from_bits(a), f32::from_bits(b));
        ((a / b + b) * a - (a + b)).to_bits()
    });
    assert_eq!(run(&module, &words), wanted.collect::<Vec<_>>());
}

#[test]
fn cheaper_operators_and_constants_are_taken() {
    let module = traced(|ports| {
        let a = ports.input("a", FORMAT);
        let half = a.constant(0.5);
        let three = a.constant(1.0) + a.constant(2.0);
        let product = half * a + a * half;
        let inverse = a.constant(1.0) / a;
        let kept = Wire::select(three.gt(half), product, inverse);
        ports.output("y", (kept + inverse).to(FORMAT) * three);
    });
    let expected = [("fp_add_e8f23", 2), ("fp_halve_e8f23", 1), ("fp_mul_e8f23", 1), ("fp_recip_e8f23", 1)];
    assert_eq!(operators(&module), expected.map(|(name, count)| (name.to_owned(), count)));
}

#[test]
fn what_no_output_needs_is_left_out_and_inputs_stay() {
    let module = traced(|ports| {
        let (a, b) = (ports.input("a", FORMAT), ports.input("b", FORMAT));
        let _root = b.sqrt();
        ports.output("y", a + a);
    });
    assert_eq!(operators(&module), [("fp_add_e8f23".to_owned(), 1)]);
    assert!(module.port("b").is_some_and(|(_, port)| !port.output && port.node.is_none()));
}

/// The maximum number of logic levels between registers.
fn deepest_glue(module: &Module) -> u32 {
    let mut depth = vec![0_u32; module.nodes.len()];
    for (index, node) in module.nodes.iter().enumerate() {
        let below = node.operands.iter().map(|id| depth[id.index()]).max().unwrap_or(0);
        depth[index] = match node.op {
            Op::And | Op::Or | Op::Mux => below + 1,
            Op::Not | Op::Concat | Op::Slice { .. } => below,
            _ => 0,
        };
    }
    depth.into_iter().max().unwrap_or(0)
}

#[test]
fn long_glue_gets_registers_and_outputs_are_registered() {
    let alternating = |bits: &[Bit]| {
        bits[1..].iter().enumerate().fold(bits[0], |sum, (i, &bit)| if i % 2 == 0 { sum & bit } else { sum | !bit })
    };
    let module = traced(|ports| {
        let bits: Vec<_> = (0..20).map(|i| ports.input_bit(&format!("b{i}"))).collect();
        ports.output_bit("y", alternating(&bits));
    });
    assert!(deepest_glue(&module) <= 3, "{} levels", deepest_glue(&module));
    let mut evaluator = Evaluator::new(&module, &[]).unwrap();
    for pattern in (0..1_u32 << 20).step_by(4099) {
        let bit = |i: u32| pattern >> i & 1 == 1;
        (0..20).for_each(|i| evaluator.set(&format!("b{i}"), bit(i).into()));
        (0..module.latency).for_each(|_| evaluator.step());
        let wanted = (1..20).fold(bit(0), |sum, i| if i % 2 == 1 { sum & bit(i) } else { sum | !bit(i) });
        assert_eq!(evaluator.get("y"), wanted.into(), "{pattern:#x}");
    }

    let wire = traced(|ports| ports.output("y", ports.input("a", FORMAT)));
    assert_eq!(wire.latency, 1);
}

#[test]
fn names_are_kept_and_made_of_operands() {
    let module = traced(|ports| {
        let (a, b) = (ports.input("a", FORMAT), ports.input("b", FORMAT));
        let sum = (a + b).named("sum");
        ports.output("y", sum * sum - a.sqrt());
    });
    let mut names: Vec<_> = module.instances.iter().map(|instance| instance.name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["add_sum", "sqrt_root_a", "square_sum_squared", "sub_sum_squared_minus_root_a"]);
}

#[test]
fn every_bad_operation_is_recorded_and_none_panics() {
    let mut stray = None;
    trace("other", |ports| stray = Some(ports.input("stray", FORMAT))).unwrap();
    let stray = stray.unwrap();
    let line = line!();
    let errors = refused(|ports| {
        let (a, b) = (ports.input("a", FORMAT), ports.input("b", Format::WIDE));
        let mixed = a + b;
        let tenth = a.constant(0.1);
        let foreign = a * stray;
        // Using poison is not another error.
        ports.output("y", mixed.sqrt() + tenth / foreign);
        ports.output("z", Wire::select(a.gt(a), a, b));
    });
    let text = errors.to_string();
    for (place, message) in [
        (3, "kernel: add: `a` in e8f23 and `b` in e10f23z"),
        (4, "kernel: constant: 0.1 is no number of e8f23"),
        (5, "kernel: mul: a wire of another kernel"),
        (8, "kernel: select: `a` in e8f23 and `b` in e10f23z"),
    ] {
        let place = format!("{message} ({}:{})", file!(), line + place);
        assert!(text.contains(&place), "{place} is not in {text}");
    }
    assert_eq!(errors.0.len(), 4, "{text}");
}

#[test]
fn wires_outside_of_a_kernel_are_dead() {
    let mut stray = None;
    trace("other", |ports| stray = Some(ports.input("stray", FORMAT))).unwrap();
    let dead = stray.unwrap() + stray.unwrap();
    let text = refused(|ports| ports.output("y", dead)).to_string();
    assert!(text.contains("output `y`: its value was made outside of a kernel"), "{text}");
}

#[test]
fn kernels_nest_and_survive_a_panic() {
    let kernel = trace("outer", |ports| {
        let a = ports.input("a", FORMAT);
        trace("inner", |ports| ports.output("y", ports.input("a", FORMAT).sqrt())).unwrap();
        let panicked = std::panic::catch_unwind(|| trace("broken", |_| panic!("on purpose")).is_ok());
        assert!(panicked.is_err());
        ports.output("y", a + a);
    });
    assert_eq!(operators(&pipeline(&kernel.unwrap())), [("fp_add_e8f23".to_owned(), 1)]);
}

/// A sum of squares of inputs that are promised to be finite while `valid`. It is output if `show(valid)`, else zero.
fn squares(format: Format, show: impl Fn(Bit) -> Bit) -> Kernel {
    let body = |ports: &Ports| {
        let (a, b) = (ports.input("a", FORMAT), ports.input("b", FORMAT));
        let valid = ports.input_bit("valid");
        ports.promise_finite(valid, &[a, b], false);
        let (x, y) = (a.to(format), b.to(format));
        let sum = x * x + y * y;
        ports.output("y", Wire::select(show(valid), sum, sum.constant(0.0)).to(FORMAT));
    };
    trace("squares", body).unwrap()
}

#[test]
fn what_cannot_happen_costs_nothing() {
    let kernel = squares(Format::WIDE, |valid| valid);
    assert_eq!(kernel.not_normal(), None);
    let names = ["fp_add_magnitudes_e10f23z_normal", "fp_convert_e10f23z_normal_to_e8f23"];
    let names = names.into_iter().chain(["fp_convert_e8f23_finite_to_e10f23z", "fp_square_e10f23z_normal"]);
    assert_eq!(operators(&pipeline(&kernel)), names.map(str::to_owned).zip([1, 1, 2, 2]).collect::<Vec<_>>());
}

#[test]
fn a_range_too_narrow_is_found_and_named() {
    let narrow = squares("e9f23".parse().unwrap(), |valid| valid).not_normal().unwrap();
    assert!(narrow.contains("`square` in e9f23: results from 2^-298 to 2^256 leave the normal range"), "{narrow}");
    // The sum is output while the promise does not hold, so an input may be anything.
    let shown = squares(Format::WIDE, |valid| !valid).not_normal().unwrap();
    assert!(shown.contains("an operand may be infinite or NaN"), "{shown}");
}

#[test]
fn a_division_by_zero_must_be_hidden() {
    let inverse = |guarded: bool| {
        let body = |ports: &Ports| {
            let a = ports.input("a", FORMAT);
            let valid = ports.input_bit("valid");
            ports.promise_finite(valid, &[a], true);
            let x = a.to(Format::WIDE);
            let zero = x.constant(0.0);
            let inverse = Wire::select(x.le(zero), if guarded { zero } else { x.recip() }, x.recip());
            ports.output("y", Wire::select(valid, inverse, zero).to(FORMAT));
        };
        trace("inverse", body).unwrap().not_normal()
    };
    assert_eq!(inverse(true), None);
    let seen = inverse(false).unwrap();
    assert!(seen.contains("a division by zero that may be seen"), "{seen}");
}

#[test]
fn constants_reach_outputs() {
    let module = traced(|ports| {
        let a = ports.input("a", FORMAT);
        ports.output("y", a.constant(0.25));
        ports.output("z", a + a);
    });
    let mut evaluator = Evaluator::new(&module, &[]).unwrap();
    assert_eq!(evaluator.get("y"), Soft::from_f64(FORMAT, 0.25).bits());
}
