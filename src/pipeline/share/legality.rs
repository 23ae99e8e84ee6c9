//! Tests with random kernels: no instance is used twice in a phase, every operand is available when it is needed, and
//! the outputs equal those of a pipeline with one operator per operation.

use std::collections::{BTreeMap, BTreeSet};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Kinds, Library, Plan};
use crate::hdl::{DelayModel, Evaluator};
use crate::number::{Format, Number};
use crate::pipeline::kernel::{Kernel, Source};
use crate::pipeline::trace;
use crate::pipeline::wire::{Bit, Wire};

const INPUTS: [&str; 3] = ["a", "b", "c"];

/// Adds some operations on the values so far, and selections among them.
fn kernel(random: &mut Xoshiro256PlusPlus, operations: usize) -> Kernel {
    let format: Format = "e5f6".parse().expect("a format");
    trace("random", |ports| {
        let mut numbers: Vec<Wire> = INPUTS.iter().map(|name| ports.input(name, format)).collect();
        let mut truths: Vec<Bit> = vec![numbers[0].gt(numbers[1])];
        for _ in 0..operations {
            let mut pick = || numbers[random.random_range(0..numbers.len())];
            let (x, y) = (pick(), pick());
            let truth = truths[random.random_range(0..truths.len())];
            match random.random_range(0..10) {
                0 | 1 => numbers.push(x + y),
                2 | 3 => numbers.push(x - y),
                4 => numbers.push(x * y),
                5 => numbers.push(x * x),
                6 => numbers.push(Wire::select(truth, x, y)),
                7 => truths.push(x.gt(y) & !truth),
                8 => truths.push(x.le(y) | truth),
                _ if random.random_bool(0.3) => numbers.push(x.sqrt()),
                _ => numbers.push(x.recip()),
            }
        }
        for (index, number) in numbers.iter().rev().take(3).enumerate() {
            ports.output(&format!("y{index}"), *number);
        }
        ports.output_bit("t", truths[truths.len() - 1]);
    })
    .expect("a sound kernel")
}

#[test]
fn no_place_is_taken_twice_and_no_operand_comes_late() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let model = DelayModel::default();
    for round in 0..60 {
        let kernel = kernel(&mut random, 5 + round);
        let interval = random.random_range(2..=20);
        let mut library = Library { model: &model, clock_mhz: 200.0, modules: BTreeMap::new() };
        let kinds = Kinds::of(&kernel, interval, &mut library).expect("operators");
        let plan = Plan::new(&kernel, &kinds, interval);
        let mut taken = BTreeSet::new();
        for (index, value) in kernel.values.iter().enumerate() {
            let Some(start) = plan.start[index] else { continue };
            for id in &value.operands {
                let constant = matches!(kernel.value(*id).source, Source::Constant(_));
                assert!(constant || plan.ready[id.index()].is_some_and(|ready| ready <= start), "round {round}");
            }
            if let Some(kind) = kinds.of[index] {
                let place = (plan.instance[index].expect("an instance"), start % interval);
                assert!(taken.insert(place), "round {round}: {place:?} is taken twice");
                assert_eq!(plan.instances[place.0].kind, kind);
                assert_eq!(plan.ready[index], Some(start + kinds.all[kind].latency()));
            }
        }
        for kind in &kinds.all {
            let (uses, instances) = (kind.uses.len() as u32, kind.instances);
            assert!(instances == uses || instances == uses.div_ceil(interval), "{uses} uses of {instances}");
        }
    }
}

#[test]
fn the_same_words_as_without_sharing() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let model = DelayModel::default();
    for round in 0..12 {
        let kernel = kernel(&mut random, 8 + 3 * round);
        let interval = random.random_range(2..=12);
        let alone = kernel.pipeline(&model, 200.0).expect("a pipeline");
        let shared = kernel.pipeline_every(&model, 200.0, interval).expect("a pipeline");
        let words: Vec<[u128; 3]> = (0..20).map(|_| [0; 3].map(|_| u128::from(random.random::<u16>() >> 4))).collect();
        let outputs = ["y0", "y1", "y2", "t"];
        let mut wanted = Vec::new();
        let mut evaluator = Evaluator::new(&alone, &[]).expect("a module");
        for word in &words {
            INPUTS.iter().zip(word).for_each(|(name, word)| evaluator.set(name, *word));
            (0..alone.latency).for_each(|_| evaluator.step());
            wanted.push(outputs.map(|name| evaluator.get(name)));
        }
        let mut evaluator = Evaluator::new(&shared, &[]).expect("a module");
        let latency = u64::from(shared.latency);
        let entry = |index: usize| 3 + u64::from(interval) * (index + index / 3) as u64;
        let mut got = Vec::new();
        for cycle in 0..=entry(words.len() - 1) + latency {
            let begun = (0..words.len())
                .rev()
                .find(|index| (0..u64::from(interval)).contains(&cycle.wrapping_sub(entry(*index))));
            let word =
                begun.map_or_else(|| [0; 3].map(|_| u128::from(random.random::<u16>() >> 4)), |index| words[index]);
            INPUTS.iter().zip(word).for_each(|(name, word)| evaluator.set(name, word));
            evaluator.set("take", u128::from((0..words.len()).any(|index| entry(index) == cycle + 1)));
            if (0..words.len()).any(|index| entry(index) + latency == cycle) {
                got.push(outputs.map(|name| evaluator.get(name)));
            }
            evaluator.step();
        }
        assert_eq!(got, wanted, "round {round}, interval {interval}");
    }
}
