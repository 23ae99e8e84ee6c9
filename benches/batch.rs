//! The batch kernel against a plain scalar loop, in one run: `cargo bench --bench batch`.
//!
//! The scalar loop is Algorithm 1 as one would write it by hand: an array of structures, `f32`, branches, compiled for
//! the target's basic instruction set. A batch fits in the cache (1024 pairs, 64 KiB of input and output). Figures are
//! medians. With `--check` the program fails unless AVX2 is at least 3 times and AVX-512 at least 4 times as fast on
//! every mix.

use contact_afu::kernel::batch::{Batch, Level};
use contact_afu::pairs::Set;
use contact_afu::query::{ContactRecord, Fields, PairRecord};
use std::hint::black_box;
use std::time::Instant;

const PAIRS: usize = 1024;
/// Number of timings, whose median is reported, and passes over the batch in each.
const TIMINGS: usize = 101;
const PASSES: usize = 40;

/// Two spheres as an ordinary program would store them.
struct Pair {
    p1: [f32; 3],
    r1: f32,
    p2: [f32; 3],
    r2: f32,
}

#[derive(Clone, Default)]
struct Contact {
    position: [f32; 3],
    normal: [f32; 3],
    depth: f32,
    flags: u32,
}

/// The plain scalar loop.
#[inline(never)]
fn scalar(pairs: &[Pair], contacts: &mut [Contact]) {
    for (Pair { p1, r1, p2, r2 }, contact) in pairs.iter().zip(contacts) {
        let good = |v: f32| v.is_finite();
        let finite = p1.iter().chain(p2).all(|&v| good(v)) && good(*r1) && good(*r2);
        if !finite || *r1 < 0.0 || *r2 < 0.0 {
            *contact = Contact { flags: 8, ..Contact::default() };
            continue;
        }
        let (x, y, z) = (p1[0] - p2[0], p1[1] - p2[1], p1[2] - p2[2]);
        let d = ((x * x + y * y) + z * z).sqrt();
        let s = r1 + r2;
        *contact = if d > s {
            Contact { flags: 2, ..Contact::default() }
        } else if d <= 0.0 {
            Contact { position: *p1, normal: [1.0, 0.0, 0.0], depth: s, flags: 5 }
        } else {
            let inverse = 1.0 / d;
            let normal = [x * inverse, y * inverse, z * inverse];
            let k = 0.5 * ((r2 - r1) - d);
            let position = [p1[0] + normal[0] * k, p1[1] + normal[1] * k, p1[2] + normal[2] * k];
            Contact { position, normal, depth: s - d, flags: 7 }
        };
    }
}

/// Median time in ns per pair.
fn time(mut pass: impl FnMut()) -> f64 {
    let mut timings: Vec<f64> = (0..TIMINGS)
        .map(|_| {
            let begin = Instant::now();
            (0..PASSES).for_each(|_| pass());
            begin.elapsed().as_secs_f64() * 1e9 / (PASSES * PAIRS) as f64
        })
        .collect();
    timings.sort_by(f64::total_cmp);
    timings[TIMINGS / 2]
}

/// Mixes of pairs: all touch, none touch, and half of each in random order.
fn mixes() -> [(&'static str, Vec<PairRecord>); 3] {
    use contact_afu::kernel::Reference;
    use contact_afu::number::Format;
    use contact_afu::query::Flow;
    let reference = Reference::new(Format::BINARY32, Fields::HIT);
    // The first of every ten random pairs is ordinary, with numbers around 1.
    let ordinary = Set::Random(150_000).pairs(1).into_iter().step_by(10);
    let (real, fake): (Vec<_>, Vec<_>) = ordinary.partition(|pair| reference.run(pair).flow() == Some(Flow::Real));
    assert!(real.len() >= PAIRS && fake.len() >= PAIRS, "{} touch, {} do not", real.len(), fake.len());
    let mut order = 1_u32;
    let mixed = (0..PAIRS).map(|i| {
        order = order.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if order >> 31 == 0 { real[i] } else { fake[i] }
    });
    let mixed = mixed.collect();
    [("all touch", real[..PAIRS].to_vec()), ("none does", fake[..PAIRS].to_vec()), ("half and half", mixed)]
}

fn main() {
    let check = std::env::args().any(|argument| argument == "--check");
    let mut slow = Vec::new();
    println!("{:<14} {:<12} {:>8} {:>8} {:>10} {:>8}", "pairs", "kernel", "ns/pair", "ratio", "hit only", "ratio");
    for (mix, records) in mixes() {
        let pairs: Vec<Pair> = records
            .iter()
            .map(|record| {
                let [x1, y1, z1, r1, x2, y2, z2, r2] = record.values();
                Pair { p1: [x1, y1, z1], r1, p2: [x2, y2, z2], r2 }
            })
            .collect();
        let mut contacts = vec![Contact::default(); PAIRS];
        let plain = time(|| scalar(black_box(&pairs), black_box(&mut contacts)));
        println!("{mix:<14} {:<12} {plain:>8.2} {:>8}", "scalar", 1.0);

        let batch = Batch::from_pairs(&records);
        let mut found = Batch::zeros(PAIRS);
        for level in Level::available() {
            let hit = time(|| level.run(black_box(&batch), black_box(&mut found), Fields::HIT));
            let all = time(|| level.run(black_box(&batch), black_box(&mut found), Fields::ALL));
            let same = contacts.iter().map(words).eq(found.contacts());
            assert!(same, "the scalar loop and {} disagree", level.name());
            let ratio = plain / all;
            let name = level.name();
            println!("{mix:<14} {name:<12} {all:>8.2} {ratio:>8.1} {hit:>10.2} {:>8.1}", plain / hit);
            let wanted = match name {
                "AVX2" => 3.0,
                "AVX-512" => 4.0,
                _ => 0.0,
            };
            if ratio < wanted {
                slow.push(format!("{name} is {ratio:.1} times the scalar loop where {mix}, not {wanted}"));
            }
        }
    }
    if check && !slow.is_empty() {
        eprintln!("{}", slow.join("\n"));
        std::process::exit(1);
    }
}

fn words(contact: &Contact) -> ContactRecord {
    let Contact { position: [px, py, pz], normal: [nx, ny, nz], depth, flags } = contact;
    let [a, b, c, d, e, f, g] = [px, py, pz, nx, ny, nz, depth].map(|v| v.to_bits());
    ContactRecord([a, b, c, d, e, f, g, *flags])
}
