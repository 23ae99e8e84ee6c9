//! Roots that take several cycles per number, against their twins: every word of small formats, every significand of
//! medium ones, and some of long ones. The intervals include divisors of the number of steps and others.

use contact_afu::hdl::{DelayModel, Evaluator, Module};
use contact_afu::number::Format;
use contact_afu::operator::{Domain, Operator, Values, iterative};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::sync::Arc;

const ROOTS: [Operator; 2] = [Operator::Recip, Operator::Sqrt];

fn root(operator: Operator, domain: Domain, interval: u32, clock_mhz: f64) -> Arc<Module> {
    // Counts registered bits; any measure that prefers fewer ranks would do.
    let size = |module: &Module| module.nodes.iter().map(|node| node.width).sum();
    iterative(operator, domain, &DelayModel::default(), clock_mhz, interval, size).unwrap().expect("a root")
}

/// Runs each word a multiple of the interval after the one before, with random bits between them.
fn check(operator: Operator, domain: Domain, interval: u32, clock_mhz: f64, words: &[u128]) {
    let module = root(operator, domain, interval, clock_mhz);
    let latency = u64::from(module.latency);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(words.len() as u64);
    let mut evaluator = Evaluator::new(&module, &[]).unwrap();
    let [a, phase, result] = ["a", "phase", "result"].map(|name| evaluator.pin(name).unwrap());
    let entries: Vec<u64> = words
        .iter()
        .scan(0, |entry, _| {
            *entry += u64::from(interval * if random.random_bool(0.9) { 1 } else { 3 });
            Some(*entry)
        })
        .collect();
    let (mut begun, mut ended) = (0, 0);
    for cycle in 0..=entries.last().unwrap() + latency {
        let is_entry = entries.get(begun) == Some(&cycle);
        evaluator.write(a, if is_entry { words[begun] as u64 } else { random.random() });
        begun += usize::from(is_entry);
        evaluator.write(phase, 1 << (cycle % u64::from(interval)));
        if entries.get(ended) == Some(&cycle.wrapping_sub(latency)) {
            let (word, wanted) = (words[ended], operator.twin(domain.format(), words[ended], 0));
            let got = u128::from(evaluator.read(result));
            assert_eq!(got, wanted, "{} of {word:#x} in {domain}, interval {interval}", operator.name());
            ended += 1;
        }
        evaluator.step();
    }
    assert_eq!(ended, words.len());
}

#[test]
fn every_word_of_eight_to_ten_bits() {
    for format in ["e5f2", "e5f2z", "e5f2t", "e5f2zt", "e5f3", "e6f3z"] {
        let format: Format = format.parse().unwrap();
        let words: Vec<u128> = (0..1 << format.width()).collect();
        for (operator, interval) in ROOTS.into_iter().flat_map(|root| [2, 3, 4, 7, 16].map(|interval| (root, interval)))
        {
            check(operator, format.into(), interval, 200.0, &words);
        }
    }
}

/// Both parities of the exponent.
#[test]
fn every_significand_of_twelve_bits() {
    for format in ["e5f11z", "e5f11zt"] {
        let domain = Domain::new(format.parse().unwrap(), Values::Normal);
        let words: Vec<u128> = (14 << 11..16 << 11).collect();
        for operator in ROOTS {
            for (interval, clock) in [(2, 100.0), (5, 200.0), (8, 150.0), (12, 300.0), (13, 50.0)] {
                check(operator, domain, interval, clock, &words);
            }
        }
    }
}

#[test]
fn some_of_long_formats() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    for (format, count) in [("wide", 3_000), ("e8f23", 2_000), ("e11f52", 300)] {
        let format: Format = format.parse().unwrap();
        let (wide, width) = (format == Format::WIDE, format.width());
        let exponents = format.bias() as u128 - 100..format.bias() as u128 + 100;
        let words: Vec<u128> = (0..count)
            .map(|_| match wide {
                // Operands as in the kernel: normal and not negative.
                true => random.random_range(exponents.clone()) << 23 | u128::from(random.random::<u32>() >> 9),
                false => random.random::<u128>() >> (128 - width),
            })
            .collect();
        let domain = Domain::new(format, if wide { Values::Normal } else { Values::Any });
        for operator in ROOTS {
            for interval in [2, 8, 16, 25, 64] {
                check(operator, domain, interval, 200.0, &words);
            }
        }
    }
}

/// A faithful root is a table, and other operators have no steps.
#[test]
fn only_roots_that_are_rounded_correctly() {
    let of = |operator, format: &str| {
        let format: Format = format.parse().unwrap();
        iterative(operator, format, &DelayModel::default(), 200.0, 8, |_| 1).unwrap().is_some()
    };
    assert!(of(Operator::Recip, "e10f23z") && of(Operator::Sqrt, "e10f23z"));
    assert!(!of(Operator::Recip, "e10f23zr") && !of(Operator::Sqrt, "e10f23zr"));
    assert!(!of(Operator::Mul, "e10f23z") && !of(Operator::Div, "e10f23z"));
}

/// The Verilog of the default AFU's roots, compiled by Verilator.
#[cfg(feature = "cosim")]
mod verilated {
    use contact_afu::cosim::{File, Model, Source, Trace};
    use contact_afu::hdl::verilog::{Style, emit};

    use super::*;

    fn stream(operator: Operator, domain: Domain, interval: u32, words: impl Iterator<Item = u128>) {
        let module = root(operator, domain, interval, 200.0);
        let file =
            |module: Arc<Module>| File { name: format!("{}.v", module.name), text: emit(&module, &Style::default()) };
        let files = module.hierarchy().into_iter().map(file).collect();
        let model = Model::build(&Source::new(&module.name, files), Trace::Off).unwrap();
        let instance = model.instance(1).unwrap();
        let clock = instance.clock("clk").unwrap();
        let a = instance.input("a", domain.width()).unwrap();
        let phase = instance.input("phase", interval).unwrap();
        let result = instance.output("result", domain.width()).unwrap();
        let mut pending = std::collections::VecDeque::new();
        let mut cycle = 0_u32;
        for word in words.map(Some).chain(std::iter::repeat_n(None, module.latency as usize)) {
            a.set(word.unwrap_or_default() as u64);
            pending.extend(word.map(|word| (word, cycle + module.latency)));
            for later in 0..interval {
                phase.set(1 << later);
                clock.tick(1).unwrap();
                cycle += 1;
                // Between numbers the input is meaningless.
                a.set(u64::from(cycle));
                if let Some(&(word, _)) = pending.front().filter(|(_, when)| *when == cycle) {
                    pending.pop_front();
                    let wanted = operator.twin(domain.format(), word, 0);
                    assert_eq!(u128::from(result.get()), wanted, "{} of {word:#x}", operator.name());
                }
            }
        }
        assert!(pending.is_empty());
    }

    fn significands(step: usize) {
        let domain = Domain::new(Format::WIDE, Values::Normal);
        let one = (Format::WIDE.bias() as u128) << 23;
        for (operator, interval) in [(Operator::Recip, 16), (Operator::Sqrt, 16), (Operator::Sqrt, 5)] {
            // Both parities of the exponent.
            stream(operator, domain, interval, (one..one + (2 << 23)).step_by(step));
        }
    }

    #[test]
    fn some_significands_of_24_bits() {
        significands(1_009);
    }

    #[test]
    #[ignore = "some minutes: every significand of 24 bits"]
    fn every_significand_of_24_bits() {
        significands(1);
    }
}
