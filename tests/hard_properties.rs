//! What holds for every pair of finite spheres, shrunk to the smallest pair that breaks it.

use contact_afu::kernel::{ContactRecord, Fields, Flow, PairRecord, Reference, Truth, ulp};
use contact_afu::number::Format;
use proptest::prelude::*;

const WIDE: Reference = Reference::new(Format::WIDE, Fields::ALL);

/// Exponents of the last bit of a binary32 number: from the subnormals' to that of the largest number.
const LAST: std::ops::RangeInclusive<i32> = -149..=104;

/// significand · 2^exponent, which binary32 holds.
fn number(negative: bool, significand: u32, exponent: i32) -> f32 {
    let value = f64::from(significand) * 2.0_f64.powi(exponent);
    (if negative { -value } else { value }) as f32
}

/// Numbers whose last bit has an exponent near `scale`; they shrink to few bits, and to `scale`.
fn near(scale: i32, spread: i32) -> impl Strategy<Value = f32> {
    (any::<bool>(), prop_oneof![0_u32..64, 0_u32..1 << 24], 0..=spread).prop_map(
        move |(negative, significand, more)| {
            number(negative, significand, (scale + more).clamp(*LAST.start(), *LAST.end()))
        },
    )
}

/// Pairs at one scale, from the smallest to the largest; two in three are centred near each other.
fn pairs(scales: std::ops::RangeInclusive<i32>, spread: i32) -> impl Strategy<Value = PairRecord> {
    // A scale of 2^-23 first: numbers around 1 are the simplest.
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

fn swapped(pair: PairRecord) -> PairRecord {
    let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.0;
    PairRecord([x2, y2, z2, r2, x1, y1, z1, r1])
}

fn scaled(numbers: &[f32], power: i32) -> Option<Vec<u32>> {
    let factor = 2.0_f64.powi(power);
    let exact = |v: f32| {
        let wide = f64::from(v) * factor;
        // Zero, or a normal number with room on both sides.
        (v == 0.0 || (1e-37..1e37).contains(&wide.abs())).then_some((wide as f32).to_bits())
    };
    numbers.iter().map(|&v| exact(v)).collect()
}

fn numbers(record: ContactRecord) -> [f32; 7] {
    std::array::from_fn(|i| f32::from_bits(record.0[i]))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn the_decision_is_right_but_near_tangents(pair in pairs(LAST, 30)) {
        let truth = Truth::of(&pair);
        let found = WIDE.run(&pair);
        prop_assert!(found.is_contact() == truth.is_contact() || truth.margin() < 1.0 / f64::from(1 << 20));
        if truth.flow() == Flow::Grazing {
            prop_assert_eq!(found, truth.record());
        }
    }

    #[test]
    fn a_normal_is_a_unit_vector_and_a_depth_within_the_radii(pair in pairs(LAST, 30)) {
        let found = WIDE.run(&pair);
        if found.is_contact() {
            let [x, y, z] = found.normal().map(f64::from);
            prop_assert!(((x * x + y * y + z * z).sqrt() - 1.0).abs() < 1e-6);
            let sum = f64::from(pair.values()[3]) + f64::from(pair.values()[7]);
            prop_assert!(found.depth() >= 0.0 && found.depth() <= sum as f32, "depth {}", found.depth());
        } else {
            prop_assert_eq!(found.0, [0, 0, 0, 0, 0, 0, 0, Flow::Fake.flags()]);
        }
    }

    #[test]
    fn swapping_negates_the_normal(pair in pairs(LAST, 30)) {
        let (there, back) = (WIDE.run(&pair), WIDE.run(&swapped(pair)));
        prop_assert_eq!(there.flags(), back.flags());
        prop_assert_eq!(there.depth(), back.depth());
        if there.flow() == Some(Flow::Real) {
            prop_assert_eq!(there.normal(), back.normal().map(|v| -v));
        }
    }

    #[test]
    fn a_power_of_two_scales_lengths_and_nothing_else(pair in pairs(-60..=20, 8), power in -40..=40) {
        let found = WIDE.run(&pair);
        let Some(words) = scaled(&pair.values(), power) else { return Ok(()) };
        let other = WIDE.run(&PairRecord(words.try_into().expect("eight")));
        prop_assert_eq!(other.flags(), found.flags());
        prop_assert_eq!(other.normal(), found.normal());
        let [px, py, pz, .., depth] = numbers(found);
        if let Some(lengths) = scaled(&[px, py, pz, depth], power) {
            prop_assert_eq!(&lengths[..], &[other.0[0], other.0[1], other.0[2], other.0[6]][..]);
        }
    }

    #[test]
    fn a_translation_moves_the_position_and_nothing_else(
        pair in pairs(-30..=-20, 3),
        shift in prop::array::uniform3(-4096_i32..=4096),
    ) {
        let mut values = pair.values();
        for (axis, steps) in shift.into_iter().enumerate() {
            for place in [axis, axis + 4] {
                let exact = f64::from(values[place]) + f64::from(steps) / 64.0;
                values[place] = exact as f32;
                if f64::from(values[place]) != exact {
                    return Ok(());
                }
            }
        }
        let (found, moved) = (WIDE.run(&pair), WIDE.run(&PairRecord(values.map(f32::to_bits))));
        prop_assert_eq!(moved.flags(), found.flags());
        prop_assert_eq!(&moved.0[3..7], &found.0[3..7]);
        for axis in (0..3).filter(|_| found.is_contact()) {
            let expected = f64::from(found.position()[axis]) + f64::from(shift[axis]) / 64.0;
            let largest = [values[axis], pair.values()[axis], pair.values()[3], pair.values()[7], expected as f32];
            let unit = ulp(largest.into_iter().map(f32::abs).fold(0.0, f32::max));
            prop_assert!((f64::from(moved.position()[axis]) - expected).abs() <= unit);
        }
    }

    #[test]
    fn the_nearer_the_deeper(pair in pairs(LAST, 6), share in 0.0_f32..1.0) {
        // The second centre moves along x towards the first.
        let mut nearer = pair.values();
        nearer[4] = nearer[0] + (nearer[4] - nearer[0]) * share;
        let [x1, x2, nearer_x2] = [pair.values()[0], pair.values()[4], nearer[4]].map(f64::from);
        prop_assume!((nearer_x2 - x1).abs() <= (x2 - x1).abs());
        let (there, here) = (WIDE.run(&pair), WIDE.run(&PairRecord(nearer.map(f32::to_bits))));
        if there.is_contact() {
            prop_assert!(here.is_contact());
            let unit = ulp((f64::from(nearer[3]) + f64::from(nearer[7])) as f32);
            prop_assert!(f64::from(here.depth()) >= f64::from(there.depth()) - unit);
        }
    }
}
