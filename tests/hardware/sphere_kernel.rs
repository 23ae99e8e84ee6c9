//! The sphere kernel's pipeline against the reference kernel, bit for bit, a new pair in every cycle.

use contact_afu::hdl::{DelayModel, Evaluator, Module};
use contact_afu::kernel::{Arithmetic, Reference, narrow, widen};
use contact_afu::number::Format;
use contact_afu::pairs::Set;
use contact_afu::pipeline::{KernelReport, Settings, contact_kernel};
use contact_afu::query::{ContactRecord, Fields, Flow, PairRecord, Query};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::ops::Range;
use std::sync::Arc;

const OUTPUTS: [&str; 7] = ["pos_x", "pos_y", "pos_z", "normal_x", "normal_y", "normal_z", "depth"];

fn kernel(arithmetic: Format, fields: Fields) -> Arc<Module> {
    kernel_of(Arithmetic::Rounded(arithmetic), fields)
}

fn kernel_of(arithmetic: Arithmetic, fields: Fields) -> Arc<Module> {
    kernel_in(arithmetic, fields, Format::BINARY32)
}

fn kernel_in(arithmetic: Arithmetic, fields: Fields, record: Format) -> Arc<Module> {
    contact_kernel(&settings(arithmetic, fields, record)).unwrap()
}

fn settings(arithmetic: Arithmetic, fields: Fields, record: Format) -> Settings {
    let model = DelayModel::default();
    let record = arithmetic.record(record);
    Settings {
        query: Query::SphereSphere,
        arithmetic,
        record,
        fields,
        radius: None,
        clock_mhz: 200.0,
        interval: 1,
        valid_is_late: false,
        touching: false,
        model,
    }
}

/// A kernel that knows that its pairs touch gives them the same bits with less hardware, whatever comes between them.
#[test]
fn a_kernel_of_touching_pairs_gives_the_bits_of_one_that_decides() {
    let pairs = pairs(20_000, 11);
    for arithmetic in [Format::WIDE, Format::BINARY32, "e8f10".parse().unwrap()] {
        let settings = settings(Arithmetic::Rounded(arithmetic), Fields::ALL, Format::BINARY32);
        let deciding = contact_kernel(&settings).unwrap();
        let touching = contact_kernel(&Settings { touching: true, ..settings }).unwrap();
        assert!(touching.latency <= deciding.latency && touching.port("hit").is_none());
        let wanted = run(&deciding, &pairs);
        let mut evaluator = Evaluator::new(&touching, &[]).unwrap();
        let inputs: Vec<_> = Query::SphereSphere.shape().names().map(|name| evaluator.pin(name).unwrap()).collect();
        let outputs = OUTPUTS.map(|name| evaluator.pin(name).unwrap());
        let coincident = evaluator.pin("grazing").unwrap();
        let latency = touching.latency as usize;
        let mut compared = 0;
        for cycle in 0..pairs.len() + latency {
            if let Some(wanted) = cycle.checked_sub(latency).map(|number| wanted[number])
                && wanted.is_contact()
            {
                let words = outputs.map(|pin| evaluator.read(pin) as u32);
                assert_eq!(words[..], wanted.0[..7], "{arithmetic}, {wanted:?}");
                assert_eq!(evaluator.read(coincident) == 1, wanted.flow() == Some(Flow::Coincident));
                compared += 1;
            }
            let pair = pairs.get(cycle).copied().unwrap_or(PairRecord([0x7FC0_0001; 8]));
            inputs.iter().zip(pair.0).for_each(|(pin, word)| evaluator.write(*pin, word.into()));
            evaluator.step();
        }
        assert!(compared > 5_000, "{compared}");
    }
}

/// The pipeline's results for the pairs, one pair per cycle.
fn run(module: &Arc<Module>, pairs: &[PairRecord]) -> Vec<ContactRecord> {
    run_in(module, pairs, Format::BINARY32)
}

/// The same for a pipeline whose words have the format `record`; the results are widened.
fn run_in(module: &Arc<Module>, pairs: &[PairRecord], record: Format) -> Vec<ContactRecord> {
    let is_valid = |pair: &PairRecord| pair.rounded(record).is_valid(Query::SphereSphere);
    let mut evaluator = Evaluator::new(module, &[]).unwrap();
    let inputs: Vec<_> = Query::SphereSphere.shape().names().map(|name| evaluator.pin(name).unwrap()).collect();
    let valid = evaluator.pin("valid").unwrap();
    let outputs = OUTPUTS.map(|name| evaluator.pin(name));
    let [hit, coincident] = ["hit", "grazing"].map(|name| evaluator.pin(name).unwrap());
    let unsettled = evaluator.pin("unsettled");
    let latency = module.latency as usize;
    let mut contacts = Vec::with_capacity(pairs.len());
    for cycle in 0..pairs.len() + latency {
        if cycle >= latency {
            let pair = &pairs[cycle - latency];
            let mut words = [0; 8];
            for (word, pin) in words.iter_mut().zip(outputs) {
                *word = pin.map_or(0, |pin| widen(evaluator.read(pin) as u32, record));
            }
            let flow = match (is_valid(pair), evaluator.read(hit), evaluator.read(coincident)) {
                (false, ..) => Flow::Invalid,
                (true, 0, _) => Flow::Fake,
                (true, _, 0) => Flow::Real,
                _ => Flow::Coincident,
            };
            words[7] = flow.flags();
            if unsettled.is_some_and(|pin| evaluator.read(pin) == 1) {
                // The hardware must not report a hit for an unsettled pair.
                assert_eq!(flow, Flow::Fake, "{pair:?}");
                words[7] = ContactRecord::UNSETTLED.flags();
            }
            contacts.push(ContactRecord(words));
        }
        // After the last pair the inputs are NaNs, which must not affect earlier pairs.
        let pair = pairs.get(cycle).copied().unwrap_or(PairRecord([0x7FC0_0001; 8]));
        inputs.iter().zip(pair.0).for_each(|(pin, word)| evaluator.write(*pin, narrow(word, record).into()));
        evaluator.write(valid, is_valid(&pair).into());
        evaluator.step();
    }
    contacts
}

/// Pairs of every flow: random words, spheres that nearly touch at every scale, coincident and nearly coincident
/// centres, and neighbours in the paper's diamond, which touch exactly.
fn pairs(count: usize, seed: u64) -> Vec<PairRecord> {
    pairs_of(count, seed, -140..120)
}

/// The same with sizes around 2^s for random s in `scales`.
fn pairs_of(count: usize, seed: u64, scales: Range<i32>) -> Vec<PairRecord> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut pairs = Vec::new();
    while pairs.len() < count {
        let scale = 2.0_f32.powi(random.random_range(scales.clone()));
        let mut number = |reach: f32| (random.random::<f32>() * 2.0 - 1.0) * reach;
        let first = [0; 3].map(|_| number(scale));
        let direction = [0; 3].map(|_| number(scale));
        let length = direction.iter().map(|c| f64::from(*c).powi(2)).sum::<f64>().sqrt() as f32;
        let share = number(0.5) + 0.5;
        let second: [f32; 3] = std::array::from_fn(|axis| first[axis] - direction[axis]);
        let (r1, r2) = (length * share, length * (1.0 - share));
        let nudge = random.random_range(-4..=4);
        let r2 = f32::from_bits(r2.to_bits().saturating_add_signed(nudge));
        pairs.push(match pairs.len() % 8 {
            0 => PairRecord(std::array::from_fn(|_| random.random())),
            1 => {
                PairRecord(std::array::from_fn(|i| random.random::<u32>() & if i % 4 == 3 { 0x7FFF_FFFF } else { !0 }))
            }
            2 => sphere_pair(first, r1, first, r2),
            3 => sphere_pair(first, r1, first.map(|c| f32::from_bits(c.to_bits() ^ 1)), r2),
            4 => {
                let [i, j, k] = [0; 3].map(|_| random.random_range(-9..=9) as f32);
                let step = [0; 3].map(|_| random.random_range(-1..=1) as f32);
                sphere_pair([i, j, k], 0.5, [i + step[0], j + step[1], k + step[2]], 0.5)
            }
            5 => sphere_pair(first, r1 * 1.5, second, r2 * 1.5),
            _ => sphere_pair(first, r1, second, r2),
        });
    }
    pairs
}

fn sphere_pair(p1: [f32; 3], r1: f32, p2: [f32; 3], r2: f32) -> PairRecord {
    PairRecord::from_spheres([p1[0], p1[1], p1[2], r1], [p2[0], p2[1], p2[2], r2])
}

fn check(arithmetic: Format, fields: Fields, count: usize) {
    let module = kernel(arithmetic, fields);
    let pairs = pairs(count, 1);
    let wanted = Reference::new(arithmetic, fields).run_all(&pairs);
    for flow in Flow::ALL {
        // Without a distance the kernel distinguishes flows only by its flags, and all of those occur here.
        let seen = wanted.iter().filter(|contact| contact.flow() == Some(flow)).count();
        assert!(seen * 40 > count, "only {seen} pairs are {flow}");
    }
    for (got, (wanted, pair)) in run(&module, &pairs).iter().zip(wanted.iter().zip(&pairs)) {
        assert!(got == wanted, "{arithmetic}, {fields}: {pair:x?} gives {got:x?}, not {wanted:x?}");
    }
}

fn every_fields() -> impl Iterator<Item = Fields> {
    (0..8).map(|bits| Fields { depth: bits & 1 != 0, normal: bits & 2 != 0, position: bits & 4 != 0 })
}

#[test]
fn wide() {
    every_fields().for_each(|fields| check(Format::WIDE, fields, 4_000));
}

#[test]
fn paper() {
    every_fields().for_each(|fields| check(Format::BINARY32, fields, 4_000));
}

/// Rounding toward zero, the opposite treatment of subnormals, faithful roots, and all of them together.
#[test]
fn other_arithmetic() {
    for text in ["e8f23t", "e8f23z", "e8f23r", "e10f23zr", "e10f23zt", "e10f23", "e10f23ztr", "e5f10tr"] {
        check(text.parse().unwrap(), Fields::ALL, 1_500);
        check(text.parse().unwrap(), Fields::HIT, 500);
    }
}

#[test]
fn other_formats() {
    for arithmetic in ["half", "e9f30", "e11f52"] {
        check(arithmetic.parse().unwrap(), Fields::ALL, 500);
    }
}

/// The kernel of exact squares, including pairs that it leaves to the host.
#[test]
fn exact() {
    let hard = Set::Hard(5_100).pairs(2);
    for fields in every_fields() {
        let module = kernel_of(Arithmetic::Exact, fields);
        let pairs: Vec<_> = if fields == Fields::ALL {
            pairs(4_000, 1).into_iter().chain(hard.clone()).collect()
        } else {
            pairs(1_000, 1)
        };
        let wanted = Reference::exact(fields).run_all(&pairs);
        let unsettled = wanted.iter().filter(|contact| contact.is_unsettled()).count();
        assert!(fields != Fields::ALL || unsettled > 200, "{unsettled} unsettled");
        for (got, (wanted, pair)) in run(&module, &pairs).iter().zip(wanted.iter().zip(&pairs)) {
            assert!(got == wanted, "{fields}: {pair:x?} gives {got:x?}, not {wanted:x?}");
        }
    }
}

#[test]
fn what_is_not_asked_for_is_not_there() {
    for arithmetic in [Format::WIDE, Format::BINARY32] {
        for fields in every_fields() {
            let module = kernel(arithmetic, fields);
            let uses = |name: &str| {
                let report = KernelReport::of(&module);
                let is_one = |module: &str| module.starts_with(&format!("fp_{name}_"));
                report.operators.iter().filter(|of| is_one(&of.module)).map(|of| of.instances).sum::<usize>()
            };
            let distance = fields.need_distance();
            let directed = fields.normal || fields.position;
            assert_eq!(uses("sqrt"), usize::from(distance), "{fields}");
            assert_eq!(uses("root_exceeds"), usize::from(!distance), "{fields}");
            assert_eq!(uses("recip"), usize::from(directed), "{fields}");
            assert_eq!(uses("halve"), usize::from(fields.position), "{fields}");
            assert_eq!(
                uses("mul"),
                if fields.position {
                    6
                } else if directed {
                    3
                } else {
                    0
                },
                "{fields}"
            );
            assert_eq!(uses("square"), 3, "{fields}");
            assert_eq!(module.port("pos_y").is_some(), fields.position);
            assert_eq!(module.port("normal_z").is_some(), fields.normal);
            assert_eq!(module.port("depth").is_some(), fields.depth);
            assert!(module.port("valid").is_some_and(|(_, port)| !port.output && port.node.is_some()));
        }
    }
}

/// Records of 16-bit words: as narrow as the kernel's arithmetic, narrower, and with other exponents. Finite numbers of
/// the pair may overflow in the record.
#[test]
fn records_of_16_bits() {
    for (record, scales) in [(Format::HALF, -24..15), (Format::BFLOAT, -140..120)] {
        let pairs = pairs_of(1_000, 3, scales);
        for arithmetic in ["e5f10", "e8f7", "e10f23z", "e8f15", "e8f23", "e10f23ztr", "e6f3z"] {
            for fields in [Fields::ALL, Fields::HIT] {
                let arithmetic = Arithmetic::Rounded(arithmetic.parse().unwrap());
                let module = kernel_in(arithmetic, fields, record);
                let wanted = Reference::of(arithmetic, fields).with_record(record).run_all(&pairs);
                for flow in Flow::ALL {
                    let seen = wanted.iter().filter(|contact| contact.flow() == Some(flow)).count();
                    assert!(seen > 25, "only {seen} pairs are {flow} in {record}");
                }
                for (got, (wanted, pair)) in run_in(&module, &pairs, record).iter().zip(wanted.iter().zip(&pairs)) {
                    assert!(
                        got == wanted,
                        "{arithmetic:?} {record} {fields}: {pair:x?} gives {got:x?}, not {wanted:x?}"
                    );
                }
            }
        }
    }
    // A format that is too narrow for binary32 records is wide enough for records with fewer exponents.
    let ends = |record| {
        let report = KernelReport::of(&kernel_in(Arithmetic::Rounded("e8f15z".parse().unwrap()), Fields::ALL, record));
        let inner = report.operators.into_iter().filter(|of| !is_edge(&of.module));
        inner.filter(|of| !of.module.ends_with("_normal")).count()
    };
    assert_eq!(ends(Format::HALF), 0);
    assert!(ends(Format::BINARY32) > 3 && ends(Format::BFLOAT) > 3);
}

/// True if the operator converts words from or to records.
fn is_edge(module: &str) -> bool {
    ["fp_convert_", "fp_widening_"].iter().any(|begin| module.starts_with(begin))
}

/// The whole kernel of a wide format has no logic for the ends of the range, except in the converters at its edges. The
/// kernel of binary32 has.
#[test]
fn a_wide_format_needs_no_ends() {
    for fields in every_fields() {
        let domains = |arithmetic: Format| {
            let report = KernelReport::of(&kernel(arithmetic, fields));
            let inner = report.operators.into_iter().filter(|of| !is_edge(&of.module));
            inner.map(|of| of.module.ends_with("_normal")).collect::<Vec<_>>()
        };
        for arithmetic in ["wide", "e10f40", "e11f52"] {
            assert!(
                domains(arithmetic.parse().unwrap()).into_iter().all(|is_normal| is_normal),
                "{arithmetic} {fields}"
            );
        }
        assert!(!domains(Format::BINARY32).contains(&true));
        assert!(domains("e9f23".parse().unwrap()).contains(&false));
    }
}

/// The comparison can fail: replacing one operator by another is detected at every place in the kernel.
#[test]
fn planted_faults_are_found() {
    let module = kernel(Format::WIDE, Fields::ALL);
    let pairs = pairs(400, 2);
    let wanted = Reference::new(Format::WIDE, Fields::ALL).run_all(&pairs);
    let operator = |name: &str| {
        let all = module.instances.iter().map(|instance| &instance.module);
        all.clone().find(|module| module.name.starts_with(&format!("fp_{name}_e"))).unwrap().clone()
    };
    let swaps = [
        ("add", "sub"),
        ("add_magnitudes", "sub"),
        ("sub", "add"),
        ("widening_add", "widening_sub"),
        ("widening_sub", "widening_add"),
        ("recip", "sqrt"),
        ("greater", "at_most"),
        ("at_most", "greater"),
    ];
    let mut planted = 0;
    for (index, instance) in module.instances.iter().enumerate() {
        for (from, to) in swaps.map(|(from, to)| (operator(from), operator(to))) {
            if instance.module.name == from.name && from.ports.len() == to.ports.len() {
                let mut faulty = Module::clone(&module);
                faulty.instances[index].module = to;
                planted += 1;
                assert!(run(&Arc::new(faulty), &pairs) != wanted, "`{}` may be another operator", instance.name);
            }
        }
    }
    assert_eq!(planted, 15);
}
