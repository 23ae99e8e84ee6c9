//! Properties of each profile, with counterexamples shrunk to the smallest pair. In `wide` and `exact` they hold for
//! every pair of finite spheres, in `paper` where binary32 neither overflows nor underflows.

use crate::support::watched::raises;
use contact_afu::config::Profile;
use contact_afu::kernel::{Truth, ulp};
use contact_afu::query::{ContactRecord, Fields, Flow, PairRecord, Query};
use proptest::prelude::*;
use proptest::test_runner::{TestError, TestRunner};

const PROFILES: [&str; 3] = ["paper", "wide", "exact"];

/// Exponents of the last bit of a binary32 number: from that of the subnormals to that of the largest number.
const LAST: std::ops::RangeInclusive<i32> = -149..=104;

/// significand · 2^exponent, which must be representable in binary32.
fn number(negative: bool, significand: u32, exponent: i32) -> f32 {
    let value = f64::from(significand) * 2.0_f64.powi(exponent);
    (if negative { -value } else { value }) as f32
}

/// Numbers whose last bit has an exponent near `scale`. They shrink to few bits and to `scale`.
fn near(scale: i32, spread: i32) -> impl Strategy<Value = f32> {
    (any::<bool>(), prop_oneof![0_u32..64, 0_u32..1 << 24], 0..=spread).prop_map(
        move |(negative, significand, more)| {
            number(negative, significand, (scale + more).clamp(*LAST.start(), *LAST.end()))
        },
    )
}

/// Pairs at one scale, from the smallest to the largest. In two of three pairs the centres are near each other.
fn pairs(scales: std::ops::RangeInclusive<i32>, spread: i32) -> impl Strategy<Value = PairRecord> {
    // A scale of 2^-23 comes first, because numbers around 1 are the simplest.
    let scale = prop_oneof![Just(-23), scales];
    scale.prop_flat_map(move |scale| {
        (prop::array::uniform8(near(scale, spread)), 0_u32..3).prop_map(|(mut v, kind)| {
            (v[3], v[7]) = (v[3].abs(), v[7].abs());
            if kind == 0 {
                (v[5], v[6]) = (v[1], v[2]);
            }
            PairRecord(v.map(f32::to_bits))
        })
    })
}

/// A kernel and its range of inputs.
#[derive(Clone, Debug)]
struct Kernel {
    name: &'static str,
    profile: Profile,
    /// True if decision and last places are right.
    is_exact: bool,
}

impl Kernel {
    /// The contact that the user reads, with unsettled pairs resolved by the host.
    fn run(&self, pair: &PairRecord) -> ContactRecord {
        self.profile.reference(Fields::ALL).settled(std::slice::from_ref(pair)).0[0]
    }

    /// Pairs at scales that the profile supports.
    fn pairs(&self, scales: std::ops::RangeInclusive<i32>, spread: i32) -> BoxedStrategy<PairRecord> {
        match self.name {
            "paper" => pairs(*scales.start().max(&-45)..=*scales.end().min(&10), spread.min(12)).boxed(),
            _ => pairs(scales, spread).boxed(),
        }
    }
}

/// Checks a property in each profile, for the pairs and any other inputs that `cases` generates.
fn in_each_profile<T: std::fmt::Debug>(
    cases: impl Fn(&Kernel) -> BoxedStrategy<(PairRecord, T)>,
    check: impl Fn(&Kernel, PairRecord, &T) -> Result<bool, TestCaseError>,
) {
    for name in PROFILES {
        let profile: Profile = name.parse().expect("a profile");
        let kernel = Kernel { name, is_exact: profile.is_exact(), profile };
        let (mut contacts, mut told) = (0_u32, 0_u32);
        let mut runner =
            TestRunner::new(ProptestConfig { cases: 1500, failure_persistence: None, ..Default::default() });
        let counts = std::cell::RefCell::new((&mut contacts, &mut told));
        let outcome = runner.run(&cases(&kernel), |(pair, more)| {
            let found = kernel.run(&pair);
            if kernel.name == "paper" {
                let flow = found.flow().expect("flags of a kernel");
                prop_assert!(!raises(Query::SphereSphere, &pair, flow), "these scales are within binary32");
            }
            let tells = check(&kernel, pair, &more)?;
            let mut counts = counts.borrow_mut();
            *counts.0 += u32::from(found.is_contact());
            *counts.1 += u32::from(tells);
            Ok(())
        });
        match outcome {
            Ok(()) => {}
            Err(TestError::Fail(why, smallest)) => panic!("{name}: {why}\nsmallest: {smallest:?}"),
            Err(other) => panic!("{name}: {other}"),
        }
        // The test is not vacuous: there are contacts and other pairs, and most cases reach the property.
        assert!(
            (200..1400).contains(&contacts) && told > 300,
            "{name}: {contacts} contacts, {told} of 1500 cases tell"
        );
    }
}

/// Pairs with coordinates below 8 in steps of 2^-17, so that adding or subtracting 64 is exact. Radii are arbitrary.
fn on_a_grid() -> impl Strategy<Value = PairRecord> {
    let steps = |most: i32| prop::array::uniform3(prop_oneof![-64..64, -most..most]);
    let radii = prop::array::uniform2(near(-24, 2).prop_map(f32::abs));
    (steps(1 << 19), steps(1 << 17), radii).prop_map(|(first, step, [r1, r2])| {
        let on_grid = |steps: i32| number(steps < 0, steps.unsigned_abs(), -17);
        let [x1, y1, z1] = first.map(on_grid);
        let [x2, y2, z2] = [0, 1, 2].map(|axis| on_grid(first[axis] + step[axis]));
        PairRecord::from_spheres([x1, y1, z1, r1], [x2, y2, z2, r2])
    })
}

fn swapped(pair: PairRecord) -> PairRecord {
    let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.0;
    PairRecord([x2, y2, z2, r2, x1, y1, z1, r1])
}

fn scaled(numbers: &[f32], power: i32) -> Option<Vec<u32>> {
    let factor = 2.0_f64.powi(power);
    let exact = |v: f32| {
        let wide = f64::from(v) * factor;
        // Zero, or a normal number with a margin on both sides.
        (v == 0.0 || (1e-37..1e37).contains(&wide.abs())).then_some((wide as f32).to_bits())
    };
    numbers.iter().map(|&v| exact(v)).collect()
}

fn numbers(record: ContactRecord) -> [f32; 7] {
    std::array::from_fn(|i| f32::from_bits(record.0[i]))
}

#[test]
fn the_decision_is_right() {
    in_each_profile(
        |kernel| kernel.pairs(LAST, 30).prop_map(|pair| (pair, ())).boxed(),
        |kernel, pair, ()| {
            let (truth, found) = (Truth::of(&pair), kernel.run(&pair));
            let near = !kernel.is_exact && truth.margin() < 1.0 / f64::from(1 << 20);
            prop_assert!(found.is_contact() == truth.is_contact() || near);
            if truth.flow() == Flow::Coincident {
                prop_assert_eq!(found.flow(), Some(Flow::Coincident));
                prop_assert_eq!(found.0[..6].to_vec(), truth.record().0[..6].to_vec());
                prop_assert!(
                    (f64::from(found.depth()) - f64::from(truth.record().depth())).abs() <= ulp(found.depth())
                );
            }
            Ok(!near)
        },
    );
}

#[test]
fn a_normal_is_a_unit_vector_and_a_depth_within_the_radii() {
    in_each_profile(
        |kernel| kernel.pairs(LAST, 30).prop_map(|pair| (pair, ())).boxed(),
        |kernel, pair, ()| {
            let found = kernel.run(&pair);
            if !found.is_contact() {
                prop_assert_eq!(found.0, [0, 0, 0, 0, 0, 0, 0, Flow::Fake.flags()]);
                return Ok(true);
            }
            let [x, y, z] = found.normal().map(f64::from);
            prop_assert!(((x * x + y * y + z * z).sqrt() - 1.0).abs() < 1e-6);
            let sum = (f64::from(pair.values()[3]) + f64::from(pair.values()[7])) as f32;
            // `exact` may round a depth close to the sum up to the next number.
            let most = if kernel.is_exact { sum.next_up() } else { sum };
            prop_assert!(found.depth() >= 0.0 && found.depth() <= most, "depth {}", found.depth());
            Ok(true)
        },
    );
}

/// Positions may differ by the bound that tests/support/swap.rs derives.
#[test]
fn swapping_negates_the_normal() {
    in_each_profile(
        |kernel| kernel.pairs(LAST, 30).prop_map(|pair| (pair, ())).boxed(),
        |kernel, pair, ()| {
            let (there, back) = (kernel.run(&pair), kernel.run(&swapped(pair)));
            prop_assert_eq!(there.flags(), back.flags());
            prop_assert_eq!(there.depth().to_bits(), back.depth().to_bits());
            if there.flow() != Some(Flow::Real) {
                return Ok(false);
            }
            prop_assert_eq!(there.normal(), back.normal().map(|v| -v));
            for axis in 0..3 {
                let (p, q) = (there.position()[axis], back.position()[axis]);
                let apart = (f64::from(p) - f64::from(q)).abs();
                let unit = crate::support::swap::unit(&pair, axis, p, q);
                let most = if kernel.is_exact { unit } else { crate::support::swap::most(&pair, there, axis, p, q) };
                prop_assert!(p == q || apart <= most, "{} and {}, {} units", p, q, apart / unit);
            }
            Ok(true)
        },
    );
}

#[test]
fn a_power_of_two_scales_lengths_and_nothing_else() {
    in_each_profile(
        |kernel| {
            let reach = if kernel.name == "paper" { 10 } else { 40 };
            (kernel.pairs(-60..=20, 8), -reach..=reach).boxed()
        },
        |kernel, pair, power| {
            let Some(words) = scaled(&pair.values(), *power) else { return Ok(false) };
            let (found, other) = (kernel.run(&pair), kernel.run(&PairRecord(words.try_into().expect("eight"))));
            prop_assert_eq!(other.flags(), found.flags());
            prop_assert_eq!(other.normal(), found.normal());
            let [px, py, pz, .., depth] = numbers(found);
            let Some(lengths) = scaled(&[px, py, pz, depth], *power) else { return Ok(false) };
            prop_assert_eq!(&lengths[..], &[other.0[0], other.0[1], other.0[2], other.0[6]][..]);
            Ok(true)
        },
    );
}

#[test]
fn a_translation_moves_the_position_and_nothing_else() {
    in_each_profile(
        |_| (on_a_grid(), prop::array::uniform3(-4096_i32..=4096)).boxed(),
        |kernel, pair, shift| {
            let mut values = pair.values();
            for (axis, steps) in shift.iter().enumerate() {
                for place in [axis, axis + 4] {
                    let exact = f64::from(values[place]) + f64::from(*steps) / 64.0;
                    values[place] = exact as f32;
                    prop_assert_eq!(f64::from(values[place]), exact, "the grid is coarse enough");
                }
            }
            let (found, moved) = (kernel.run(&pair), kernel.run(&PairRecord(values.map(f32::to_bits))));
            prop_assert_eq!(moved.flags(), found.flags());
            prop_assert_eq!(&moved.0[3..7], &found.0[3..7]);
            for axis in (0..3).filter(|_| found.is_contact()) {
                let expected = f64::from(found.position()[axis]) + f64::from(shift[axis]) / 64.0;
                let largest = [values[axis], pair.values()[axis], pair.values()[3], pair.values()[7], expected as f32];
                let unit = ulp(largest.into_iter().map(f32::abs).fold(0.0, f32::max));
                prop_assert!((f64::from(moved.position()[axis]) - expected).abs() <= unit);
            }
            Ok(true)
        },
    );
}

#[test]
fn the_nearer_the_deeper() {
    in_each_profile(
        |kernel| (kernel.pairs(LAST, 6), 0.0_f32..1.0).boxed(),
        |kernel, pair, share| {
            // The second centre moves along x towards the first.
            let mut nearer = pair.values();
            nearer[4] = nearer[0] + (nearer[4] - nearer[0]) * share;
            let [x1, x2, nearer_x2] = [pair.values()[0], pair.values()[4], nearer[4]].map(f64::from);
            if (nearer_x2 - x1).abs() > (x2 - x1).abs() || !nearer[4].is_finite() {
                return Ok(false);
            }
            let (there, here) = (kernel.run(&pair), kernel.run(&PairRecord(nearer.map(f32::to_bits))));
            if !there.is_contact() {
                return Ok(false);
            }
            prop_assert!(here.is_contact());
            // Relative to the depth itself if that is right to its last place, else to the sum that it is a difference
            // of.
            let sum = (f64::from(nearer[3]) + f64::from(nearer[7])) as f32;
            let unit = ulp(if kernel.is_exact { there.depth() } else { sum });
            let limit = f64::from(there.depth()) - unit;
            prop_assert!(f64::from(here.depth()) >= limit, "{} after {}", here.depth(), there.depth());
            Ok(true)
        },
    );
}
