//! The sphere kernel at intervals above 1 against the reference kernel, bit for bit: fewer operators, the same words.

use contact_afu::hdl::{DelayModel, Evaluator, Module};
use contact_afu::kernel::{Arithmetic, Reference};
use contact_afu::number::Format;
use contact_afu::pairs::Set;
use contact_afu::pipeline::{KernelReport, Settings, contact_kernel};
use contact_afu::query::{ContactRecord, Fields, Flow, PairRecord, Query};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::sync::Arc;

const OUTPUTS: [&str; 7] = ["pos_x", "pos_y", "pos_z", "normal_x", "normal_y", "normal_z", "depth"];

fn kernel(arithmetic: Arithmetic, fields: Fields, interval: u32) -> Arc<Module> {
    let (record, model) = (arithmetic.record(Format::BINARY32), DelayModel::default());
    contact_kernel(&Settings {
        query: Query::SphereSphere,
        arithmetic,
        record,
        fields,
        radius: None,
        clock_mhz: 200.0,
        interval,
        valid_is_late: false,
        touching: false,
        model,
    })
    .unwrap()
}

/// Runs pairs that arrive at multiples of `interval` cycles. Before and between them the inputs are random.
fn run(module: &Arc<Module>, interval: u64, pairs: &[PairRecord], random: &mut impl RngExt) -> Vec<ContactRecord> {
    let mut evaluator = Evaluator::new(module, &[]).unwrap();
    let inputs: Vec<_> = Query::SphereSphere.shape().names().map(|name| evaluator.pin(name).unwrap()).collect();
    let [take, valid] = ["take", "valid"].map(|name| evaluator.pin(name).unwrap());
    let outputs = OUTPUTS.map(|name| evaluator.pin(name));
    let [hit, coincident, invalid] = ["hit", "grazing", "invalid_pair"].map(|name| evaluator.pin(name).unwrap());
    let unsettled = evaluator.pin("unsettled");
    let mut entry = random.random_range(1..40_u64);
    let entries: Vec<u64> = pairs
        .iter()
        .map(|_| {
            let gap = if random.random_bool(0.7) { 1 } else { random.random_range(1..5_u64) };
            entry += gap * interval;
            entry
        })
        .collect();
    let latency = u64::from(module.latency);
    let mut contacts = Vec::with_capacity(pairs.len());
    let mut begun = 0;
    for cycle in 0..=entries.last().unwrap() + latency {
        if entries.get(begun) == Some(&cycle) {
            begun += 1;
        }
        let is_there = begun > 0 && cycle < entries[begun - 1] + interval;
        let pair = if is_there { pairs[begun - 1] } else { PairRecord(std::array::from_fn(|_| random.random())) };
        inputs.iter().zip(pair.0).for_each(|(pin, word)| evaluator.write(*pin, word.into()));
        evaluator
            .write(valid, if is_there { pair.is_valid(Query::SphereSphere).into() } else { random.random_range(0..2) });
        evaluator.write(take, u64::from(entries.get(begun) == Some(&(cycle + 1))));
        if entries.get(contacts.len()) == Some(&cycle.wrapping_sub(latency)) {
            let pair = &pairs[contacts.len()];
            let mut words = outputs.map(|pin| pin.map_or(0, |pin| evaluator.read(pin) as u32)).to_vec();
            assert_eq!(evaluator.read(invalid) == 0, pair.is_valid(Query::SphereSphere), "{pair:?}");
            let flow = match (pair.is_valid(Query::SphereSphere), evaluator.read(hit), evaluator.read(coincident)) {
                (false, ..) => Flow::Invalid,
                (true, 0, _) => Flow::Fake,
                (true, _, 0) => Flow::Real,
                _ => Flow::Coincident,
            };
            let is_unsettled = unsettled.is_some_and(|pin| evaluator.read(pin) == 1);
            words.push(if is_unsettled { ContactRecord::UNSETTLED.flags() } else { flow.flags() });
            contacts.push(ContactRecord(words.try_into().unwrap()));
        }
        evaluator.step();
    }
    contacts
}

/// Pairs of every flow: hard ones, random words, coincident and touching spheres.
fn pairs(count: usize, random: &mut impl RngExt) -> Vec<PairRecord> {
    let hard = Set::Hard(count as u64 / 2).pairs(2);
    let mut made: Vec<PairRecord> = (0..count - hard.len())
        .map(|index| {
            let [x, y, z] = [0; 3].map(|_| random.random_range(-9..=9) as f32);
            let step = [0; 3].map(|_| random.random_range(-1..=1) as f32);
            let radius = random.random_range(0.1..0.9_f32);
            match index % 4 {
                0 => PairRecord(std::array::from_fn(|_| random.random())),
                1 => PairRecord::from_spheres([x, y, z, radius], [x, y, z, 0.5]),
                2 => PairRecord::from_spheres([x, y, z, 0.5], [x + step[0], y + step[1], z + step[2], 0.5]),
                _ => PairRecord::from_spheres([x, y, z, radius], [x + 0.3, y - radius, z + step[2], 0.7]),
            }
        })
        .collect();
    made.extend(hard);
    // Shuffled, so that hard and easy pairs are neighbours.
    (0..made.len()).for_each(|index| made.swap(index, random.random_range(0..=index)));
    made
}

fn check(arithmetic: Arithmetic, fields: Fields, interval: u32, count: usize) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(u64::from(interval));
    let pairs = pairs(count, &mut random);
    let wanted = match arithmetic {
        Arithmetic::Rounded(format) => Reference::new(format, fields),
        Arithmetic::Exact => Reference::exact(fields),
    };
    let module = kernel(arithmetic, fields, interval);
    let got = run(&module, interval.into(), &pairs, &mut random);
    for (got, (wanted, pair)) in got.iter().zip(wanted.run_all(&pairs).iter().zip(&pairs)) {
        assert!(
            got == wanted,
            "{arithmetic:?}, {fields}, interval {interval}: {pair:x?} gives {got:x?}, not {wanted:x?}"
        );
    }
    assert_eq!(got.len(), pairs.len());
}

#[test]
fn wide() {
    for interval in [2, 3, 4, 5, 7, 8, 16, 33, 64] {
        check(Arithmetic::Rounded(Format::WIDE), Fields::ALL, interval, 600);
    }
}

#[test]
fn other_profiles() {
    for interval in [2, 5, 8, 16] {
        check(Arithmetic::Rounded(Format::BINARY32), Fields::ALL, interval, 300);
        check(Arithmetic::Exact, Fields::ALL, interval, 300);
        check(Arithmetic::Rounded("e10f23ztr".parse().unwrap()), Fields::ALL, interval, 200);
    }
}

#[test]
fn fewer_fields() {
    for bits in 0..8 {
        let fields = Fields { depth: bits & 1 != 0, normal: bits & 2 != 0, position: bits & 4 != 0 };
        [2, 5, 12].into_iter().for_each(|interval| check(Arithmetic::Rounded(Format::WIDE), fields, interval, 120));
    }
}

/// At an interval of 16 one adder does all sums and differences, and one multiplier all products and squares.
#[test]
fn operators_are_shared() {
    let instances = |interval: u32, name: &str| {
        let report = KernelReport::of(&kernel(Arithmetic::Rounded(Format::WIDE), Fields::ALL, interval));
        let of_name = report.operators.iter().filter(|of| of.module.starts_with(&format!("fp_{name}_e")));
        of_name.map(|of| of.instances).sum::<usize>()
    };
    let sums = |interval| {
        let all = ["add", "sub", "add_magnitudes", "widening_add", "widening_sub"];
        all.map(|name| instances(interval, name)).iter().sum::<usize>()
    };
    let products = |interval| instances(interval, "mul") + instances(interval, "square");
    assert_eq!([1, 2, 4, 8, 16].map(sums), [12, 6, 3, 2, 1]);
    assert_eq!([1, 2, 4, 8, 16].map(products), [9, 5, 3, 2, 1]);
}
