//! A sphere and a plane: the reference against its twin and ODE's formula, and the bounds that docs/sphere-plane.md
//! promises.

use crate::support::halves;
use crate::support::watched::raises;
use contact_afu::accuracy::{Answer, Contender, Formula, Standard, judge};
use contact_afu::kernel::{Arithmetic, Reference, Truth};
use contact_afu::number::{Format, Rounding};
use contact_afu::pairs::{Category, Set, categories};
use contact_afu::pipeline::is_normal;
use contact_afu::query::Query::SpherePlane;
use contact_afu::query::{ContactRecord, Fields, Flow, PairRecord};

/// Half a unit in the last place of binary32, relative.
const U: f64 = 1.0 / (1 << 24) as f64;
/// Half of the smallest binary32 number: the maximum error from storing a subnormal number.
const SMALLEST: f64 = f32::from_bits(1) as f64 / 2.0;

fn reference(arithmetic: Format, fields: Fields) -> Reference {
    Reference::new(arithmetic, fields).of_query(SpherePlane)
}

const fn every_fields() -> [Fields; 8] {
    let mut all = [Fields::HIT; 8];
    let mut bits = 0;
    while bits < 8 {
        all[bits] = Fields { depth: bits & 1 != 0, normal: bits & 2 != 0, position: bits & 4 != 0 };
        bits += 1;
    }
    all
}

/// Random pairs, including invalid ones, and hard pairs.
fn pairs(count: u64, seed: u64) -> Vec<PairRecord> {
    [Set::Random(count / 2), Set::Hard(count / 2)]
        .into_iter()
        .flat_map(|set| set.pairs_of(SpherePlane, seed).expect("a set of every query"))
        .collect()
}

#[test]
fn a_contact_is_on_the_sphere_and_touching_counts() {
    let paper = reference(Format::BINARY32, Fields::ALL);
    let at = |z| paper.run(&PairRecord::from_sphere_and_plane([1.0, 2.0, z, 0.5], [0.0, 0.0, 1.0, 3.0]));
    let contact = at(3.25);
    assert_eq!(contact.flow(), Some(Flow::Real));
    assert_eq!((contact.position(), contact.normal(), contact.depth()), ([1.0, 2.0, 2.75], [0.0, 0.0, 1.0], 0.25));
    assert_eq!((at(3.5).flow(), at(3.5).depth()), (Some(Flow::Real), 0.0), "touching");
    assert_eq!(at(3.5_f32.next_up()), ContactRecord::of_flags(Flow::Fake.flags()));
}

/// A field that is not selected is zero. A selected field has the same bits whichever others are selected. In binary32
/// the machine's `f32` and its twin agree.
#[test]
fn the_twin_has_the_same_bits_for_every_subset_of_fields() {
    for format in ["paper", "wide", "half", "e6f9z"].map(|name| name.parse().expect("a format")) {
        let whole = reference(format, Fields::ALL);
        for pair in pairs(40_000, 3) {
            let expected = whole.run(&pair);
            for fields in every_fields() {
                let reference = reference(format, fields);
                assert_eq!(reference.run(&pair), expected.only(fields), "{format} {fields}: {pair:?}");
                assert_eq!(reference.run_soft(&pair), expected.only(fields), "{format} {fields}: {pair:?}");
            }
        }
    }
}

/// The number of binary32 contacts that differ from those of the formula.
fn differing(pairs: &[PairRecord], mend: impl Fn(&PairRecord, Answer) -> Answer) -> usize {
    let paper = reference(Format::BINARY32, Fields::ALL);
    let answers = Formula(SpherePlane).answers(pairs).expect("it always answers");
    pairs.iter().zip(answers).filter(|(pair, answer)| mend(pair, *answer) != Answer::from(paper.run(pair))).count()
}

#[test]
fn paper_is_the_formula_in_f32_and_a_planted_rounding_is_seen() {
    let pairs: Vec<_> = pairs(400_000, 4).into_iter().filter(|pair| pair.is_valid(SpherePlane)).collect();
    assert_eq!(differing(&pairs, |_, answer| answer), 0);
    let fused = |pair: &PairRecord, answer: Answer| {
        // The last two sums are rounded as one.
        let [x, y, z, r, nx, ny, nz, d] = pair.values();
        let along = f64::from((nx * x + ny * y) + nz * z);
        let depth = ((f64::from(d) - along) + f64::from(r)) as f32;
        Answer { depth: if answer.hit { depth.into() } else { 0.0 }, ..answer }
    };
    assert!(differing(&pairs, fused) > 10_000);
}

/// In a wide format no value is subnormal or infinite, because the hardware has no logic for those.
#[test]
fn nothing_in_wide_leaves_the_normal_range() {
    for fields in every_fields() {
        let is_normal = |format| is_normal(SpherePlane, Arithmetic::Rounded(format), fields).expect("a kernel");
        assert!(is_normal(Format::WIDE), "{fields}");
        assert!(!is_normal(Format::BINARY32), "{fields}");
    }
}

#[test]
fn wide_is_binary32_wherever_that_neither_overflows_nor_underflows() {
    let (paper, wide) = (reference(Format::BINARY32, Fields::ALL), reference(Format::WIDE, Fields::ALL));
    let mut flows = [0; 4];
    let mut different = 0;
    for pair in pairs(1_000_000, 5) {
        let (expected, found) = (paper.run(&pair), wide.run(&pair));
        let flow = expected.flow().expect("flags of a kernel");
        if flow != Flow::Invalid && raises(SpherePlane, &pair, flow) {
            different += u32::from(expected != found);
        } else {
            assert_eq!(found, expected, "{pair:?}");
            flows[flow as usize] += 1;
        }
    }
    // The test is not vacuous: each flow occurs, and the two do differ where f32 fails.
    assert!([Flow::Invalid, Flow::Fake, Flow::Real].iter().all(|&flow| flows[flow as usize] > 10_000), "{flows:?}");
    assert!(different > 10_000, "{different} differ");
}

/// The largest errors as multiples of their units. For the decision and the depth the unit is 2^-24 of the terms of the
/// depth. For the position it is 2^-24 of |c| + 2·|n·r|, per axis.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    decision: f64,
    depth: f64,
    position: f64,
    wrong: u32,
    other_normals: u32,
}

impl Worst {
    fn add(&mut self, pair: &PairRecord, found: ContactRecord) {
        let truth = Truth::of_query(SpherePlane, pair);
        if found.is_contact() != truth.is_contact() {
            self.wrong += 1;
            self.decision = self.decision.max(truth.margin() / U);
        }
        let (Some(position), Some(depth)) = (truth.position(), truth.depth()) else { return };
        if !found.is_contact() {
            return;
        }
        self.other_normals += u32::from(found.0[3..6] != pair.0[4..7]);
        let error = |given: f32, exact: f64| {
            // An infinity stands for the number that would follow the largest one, and for all larger numbers.
            let largest = || 2.0_f64.powi(128).max(exact.abs()).copysign(given.into());
            let given = if given.is_infinite() { largest() } else { given.into() };
            ((given - exact).abs() - SMALLEST).max(0.0)
        };
        let share = |error: f64, of: f64| if error == 0.0 { 0.0 } else { error / (U * of) };
        self.depth = self.depth.max(share(error(found.depth(), depth.to_f64()), truth.scale().depth));
        let [x, y, z, r, nx, ny, nz, _] = pair.values().map(f64::from);
        for (axis, (c, n)) in [(x, nx), (y, ny), (z, nz)].into_iter().enumerate() {
            let of = c.abs() + 2.0 * (n * r).abs();
            self.position = self.position.max(share(error(found.position()[axis], position[axis].to_f64()), of));
        }
    }

    fn of(reference: &Reference, pairs: &[PairRecord]) -> Self {
        let mut worst = Self::default();
        pairs.iter().for_each(|pair| worst.add(pair, reference.run(pair)));
        worst
    }

    /// A product is rounded five times on its way into the depth, n·r twice on its way into the position, and the
    /// normal never.
    fn is_as_promised(&self) -> bool {
        self.other_normals == 0 && self.decision <= 5.000_001 && self.depth <= 5.000_001 && self.position <= 1.000_001
    }
}

#[test]
fn errors_of_wide_are_those_of_its_roundings() {
    let pairs = Set::Hard(240_000).pairs_of(SpherePlane, 6).expect("a set of every query");
    let worst = Worst::of(&reference(Format::WIDE, Fields::ALL), &pairs);
    println!("{worst:?}");
    assert!(worst.is_as_promised(), "{worst:?}");
    // Hard pairs come close to the bounds, and wrong roundings are detected.
    assert!(worst.depth > 2.0 && worst.position > 0.9 && worst.decision > 1.0 && worst.wrong > 100, "{worst:?}");
    let toward_zero = Format::WIDE.with_rounding(Rounding::TowardZero);
    let worst = Worst::of(&reference(toward_zero, Fields::ALL), &pairs);
    assert!(!worst.is_as_promised() && worst.other_normals == 0, "{worst:?}");
}

/// `wide` has no gross failure, and it has the bits of `paper` except where binary32's range fails. Returns the number
/// of gross failures of the profile paper.
fn wide_never_fails_grossly(category: &Category, pairs: &[PairRecord]) -> usize {
    let (wide, paper) = (reference(Format::WIDE, Fields::ALL), reference(Format::BINARY32, Fields::ALL));
    let mut worst = Worst::default();
    let mut failures = 0;
    for pair in pairs {
        let standard = Standard::of(SpherePlane, pair);
        let (found, of_paper) = (wide.run(pair), paper.run(pair));
        let judged = judge(&standard, &Answer::from(found));
        assert!(!judged.bad, "{}: {pair:?}: {found:?}: {judged:?}", category.name());
        worst.add(pair, found);
        let flow = of_paper.flow().expect("flags of a kernel");
        assert!(found == of_paper || raises(SpherePlane, pair, flow), "{}: {pair:?}", category.name());
        failures += usize::from(judge(&standard, &Answer::from(of_paper)).bad);
    }
    assert!(worst.is_as_promised(), "{}: {worst:?}", category.name());
    println!("{}: {worst:?}, {failures} gross failures of paper", category.name());
    failures
}

#[test]
fn wide_never_fails_grossly_in_any_category() {
    let mut failures = 0;
    for category in categories(SpherePlane) {
        failures += wide_never_fails_grossly(category, &category.pairs(1_000, 21).collect::<Vec<_>>());
    }
    assert!(failures > 0, "the pairs are hard: sums of binary32 overflow");
}

/// The long version of the test above: a million pairs of the hard set, 85 000 of each category.
#[test]
#[ignore = "half a minute: a million truths"]
fn wide_never_fails_grossly_in_a_million_pairs() {
    let categories = categories(SpherePlane);
    halves(categories.len() as u64, |part| {
        for category in &categories[part.start as usize..part.end as usize] {
            wide_never_fails_grossly(category, &category.pairs(1_020_000 / 12, 4).collect::<Vec<_>>());
        }
    });
}
