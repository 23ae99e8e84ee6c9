//! Random modules: the graph, the evaluator and the stage cutter against a bit-by-bit computation.

use std::collections::HashMap;

use crate::recipe::{Bits, Recipe, lines, to_words};
use contact_afu::hdl::{DelayModel, Evaluator, Module, NodeId, Op, cut};
use proptest::prelude::*;

/// Inputs for each cycle: all zeros, all ones and random bits.
fn stimulus(recipe: &Recipe, cycles: usize, seed: u64) -> Vec<Vec<Bits>> {
    let mut state = seed | 1;
    let mut noise = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let mut value = |width: u32| match noise() % 8 {
        0 => vec![false; width as usize],
        1 => vec![true; width as usize],
        _ => (0..width).map(|_| noise() >> 40 & 1 == 1).collect(),
    };
    (0..cycles).map(|_| recipe.inputs().iter().map(|&(_, width)| value(width)).collect()).collect()
}

fn set(run: &mut Evaluator, recipe: &Recipe, inputs: &[Bits]) {
    for ((line, _), bits) in recipe.inputs().iter().zip(inputs) {
        run.set_words(&format!("i{line}"), &to_words(bits));
    }
}

/// The number of nodes that outputs depend on, counted independently.
fn needed(module: &Module) -> usize {
    let mut open: Vec<NodeId> = module.ports.iter().filter(|p| p.output).filter_map(|p| p.node).collect();
    let mut seen = vec![false; module.nodes.len()];
    let mut count = 0;
    while let Some(id) = open.pop() {
        if std::mem::replace(&mut seen[id.index()], true) {
            continue;
        }
        count += 1;
        let node = module.node(id);
        open.extend(&node.operands);
        if let Op::MemoryRead { memory } = node.op {
            open.extend(module.memories[memory].write.iter().flatten());
        }
    }
    count
}

/// The longest path between registers in ns, computed independently, and whether it has more than one operation.
fn longest(module: &Module, model: &DelayModel) -> (f64, bool) {
    fn arrival(module: &Module, delays: &[f64], id: NodeId, known: &mut HashMap<NodeId, (f64, u32)>) -> (f64, u32) {
        if let Some(known) = known.get(&id) {
            return *known;
        }
        let node = module.node(id);
        let mut worst = (0.0, 0);
        if !matches!(node.op, Op::Delay { .. }) && needed_inputs(module, id) > 0 {
            for operand in &node.operands {
                let before = arrival(module, delays, *operand, known);
                worst = if before.0 > worst.0 { before } else { worst };
            }
            let own = delays[id.index()];
            worst = (worst.0 + own, worst.1 + u32::from(own > 0.0));
        }
        known.insert(id, worst);
        worst
    }
    let (mut known, delays) = (HashMap::new(), model.delays(module));
    let all = module.ids().map(|id| arrival(module, &delays, id, &mut known));
    let (logic, operations) = all.fold((0.0, 0), |worst, one| if one.0 > worst.0 { one } else { worst });
    (logic, operations > 1)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn the_evaluator_agrees_with_a_computation_bit_by_bit(lines in lines(true), seed: u64) {
        let mut recipe = Recipe::new(&lines);
        let module = recipe.build();
        let mut run = Evaluator::new(&module, &[]).unwrap();
        for (cycle, inputs) in stimulus(&recipe, 24, seed).iter().enumerate() {
            set(&mut run, &recipe, inputs);
            recipe.settle(inputs);
            for &line in &recipe.outputs {
                prop_assert_eq!(run.get_words(&format!("o{line}")), to_words(recipe.value(line)), "line {} cycle {}", line, cycle);
            }
            run.step();
            recipe.step();
        }
    }

    #[test]
    fn nothing_is_left_that_no_output_needs(lines in lines(true)) {
        let module = Recipe::new(&lines).build();
        prop_assert_eq!(needed(&module), module.nodes.len());
        for port in &module.ports {
            prop_assert!(port.node.is_some() || !port.output);
        }
    }

    #[test]
    fn a_cut_module_is_the_module_later(lines in lines(false), seed: u64, clock in 20.0..800.0) {
        let mut recipe = Recipe::new(&lines);
        let module = recipe.build();
        let model = DelayModel::default();
        let pipeline = cut(&module, &model, clock).unwrap();
        prop_assert!(pipeline.latency >= 1);

        let mut run = Evaluator::new(&pipeline, &[]).unwrap();
        let latency = pipeline.latency as usize;
        let stimulus = stimulus(&recipe, latency + 8, seed);
        for cycle in 0..stimulus.len() {
            set(&mut run, &recipe, &stimulus[cycle]);
            if let Some(then) = cycle.checked_sub(latency) {
                recipe.settle(&stimulus[then]);
                for &line in &recipe.outputs {
                    prop_assert_eq!(run.get_words(&format!("o{line}")), to_words(recipe.value(line)), "line {}", line);
                }
            }
            run.step();
        }

        let timing = pipeline.timing.clone().unwrap();
        let (logic, several) = longest(&pipeline, &model);
        // If a selection spans several stages, the cutter counts all its inputs and each stage has only its own.
        prop_assert!(model.clock(logic) > timing.clock_mhz - 1e-3, "{} ns but {:?}", logic, timing);
        prop_assert!(!several || logic <= model.budget(clock) + 1e-6, "{} ns of {}: {:?}", logic, model.budget(clock), timing);
        for node in &pipeline.nodes {
            let is_placed = matches!(node.op, Op::Constant(_) | Op::Delay { .. }) || node.stage < Some(pipeline.latency);
            prop_assert!(is_placed && (node.stage.is_some() || matches!(node.op, Op::Constant(_) | Op::Delay { .. })), "{:?}", node);
        }
        // Every output is a register, unless it is constant.
        for port in pipeline.ports.iter().filter(|port| port.output) {
            let node = pipeline.node(port.node.unwrap());
            let registered = matches!(node.op, Op::Delay { .. });
            prop_assert!(registered || needed_inputs(&pipeline, port.node.unwrap()) == 0, "{:?}", port);
        }
    }
}

/// The number of input nodes that a value depends on.
fn needed_inputs(module: &Module, id: NodeId) -> usize {
    let mut open = vec![id];
    let mut seen = vec![false; module.nodes.len()];
    let mut count = 0;
    while let Some(id) = open.pop() {
        if !std::mem::replace(&mut seen[id.index()], true) {
            count += usize::from(module.node(id).op == Op::Input);
            open.extend(&module.node(id).operands);
        }
    }
    count
}
