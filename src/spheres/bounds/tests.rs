use super::*;
use crate::kernel::Reference;
use crate::pairs::Set;
use crate::query::{Fields, PairRecord};

fn spheres(pair: &PairRecord) -> [Sphere; 2] {
    let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.0;
    [Sphere([x1, y1, z1, r1]), Sphere([x2, y2, z2, r2])]
}

fn rule(format: Format) -> BoundsRule {
    BoundsRule::new(Arithmetic::Rounded(format), 32).expect("a rule")
}

/// The number of pairs that `reference` calls a contact and whose boxes do not meet, and the number of contacts.
fn lost(rule: BoundsRule, reference: &Reference, pairs: impl IntoIterator<Item = PairRecord>) -> [u64; 2] {
    let mut counts = [0; 2];
    for pair in pairs {
        let contact = reference.settled(&[pair]).0[0];
        let [first, second] = spheres(&pair).map(|sphere| rule.bounds(sphere));
        if contact.is_contact() {
            counts[0] += u64::from(!first.meets(&second));
            counts[1] += 1;
        } else if !pair.is_valid(crate::query::Query::SphereSphere) {
            assert!(!first.meets(&second), "{pair:?}");
        }
    }
    counts
}

#[test]
fn codes_are_consecutive_and_in_order() {
    let values = [f32::NEG_INFINITY, f32::MIN, -1.0, -1e-45, -0.0, 0.0, 1e-45, 1.0, f32::MAX, f32::INFINITY];
    for two in values.windows(2) {
        assert!(code(two[0]) <= code(two[1]));
    }
    assert_eq!((code(-0.0), code(1e-45), code(-1e-45)), (0, 1, -1));
    assert_eq!(code(f32::INFINITY) - code(f32::MAX), 1);
    assert_eq!(code(1.0_f32.next_down()) + 1, code(1.0));
}

/// Every pair of spheres on a line in formats of three and four significand bits, up to scale and reflection: the first
/// centre is the larger one, in one binade, and the others reach far enough below it. One unit less loses contacts.
#[test]
fn small_formats_lose_no_contact_and_need_every_unit() {
    for (fraction, rounding) in [(2, Rounding::Nearest), (3, Rounding::Nearest), (3, Rounding::TowardZero)] {
        let format = Format::new(10, fraction, crate::number::Subnormals::Flushed).expect("a format");
        let format = format.with_rounding(rounding);
        let own = rule(format);
        let less = BoundsRule { radius_units: own.radius_units - (1 << (23 - fraction)), ..own };
        let reference = Reference::new(format, Fields::HIT);
        let steps = 1_u32 << fraction;
        let binade = |exponent: i32| (0..steps).map(move |i| (1.0 + i as f32 / steps as f32) * 2.0_f32.powi(exponent));
        let below = |top: i32| (top - fraction as i32 - 4..=top).flat_map(binade).chain([0.0]);
        let mut counts = [0_u64; 3];
        for x1 in binade(0) {
            for x2 in below(0).chain(below(0).map(|x| -x)) {
                for r1 in below(1) {
                    // Pairs that are far from touching, either way, say nothing.
                    let near = |r2: &f32| {
                        let ratio = (x1 - x2).abs() / (r1 + r2);
                        *r2 <= r1 && (0.95..=1.6).contains(&ratio)
                    };
                    for r2 in below(1).filter(near) {
                        let pair = PairRecord::from_spheres([x1, 0.0, 0.0, r1], [x2, 0.0, 0.0, r2]);
                        let [wrong, contacts] = lost(own, &reference, [pair]);
                        counts[0] += wrong;
                        counts[1] += contacts;
                        counts[2] += lost(less, &reference, [pair])[0];
                    }
                }
            }
        }
        assert_eq!(counts[0], 0, "e10f{fraction} {rounding}");
        assert!(counts[1] > 1000 && counts[2] > 0, "e10f{fraction} {rounding}: {counts:?}");
    }
}

/// Random pairs of every kind, hard pairs, and pairs within a few ulp of tangent at every scale.
#[test]
fn no_contact_is_lost_at_any_scale() {
    let pairs = [Set::Random(20_000).pairs(7), Set::Hard(20_000).pairs(7)].concat();
    for text in ["e10f23z", "e10f24z", "e12f30", "e10f31z", "e10f12z", "e11f52", "e10f23zt"] {
        let format: Format = text.parse().expect("a format");
        let [wrong, contacts] = lost(rule(format), &Reference::new(format, Fields::HIT), pairs.iter().copied());
        assert!(wrong == 0 && contacts > 10_000, "{text}: {wrong} of {contacts}");
    }
    let exact = BoundsRule::new(Arithmetic::Exact, 32).expect("a rule");
    let [wrong, contacts] = lost(exact, &Reference::exact(Fields::HIT), pairs.iter().copied());
    assert!(wrong == 0 && contacts > 10_000, "exact: {wrong} of {contacts}");
}

/// Tangent pairs along one axis, where a box has no slack.
fn along_an_axis(count: u32) -> impl Iterator<Item = PairRecord> {
    let mut state = 1_u64;
    let mut bits = move |count: u32| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u32 & ((1 << count) - 1)
    };
    (0..count).map(move |_| {
        let scale = (2.0_f32).powi(bits(6) as i32 - 32);
        let mut number = |exponent: u32| {
            let shift = bits(5) % exponent;
            f32::from_bits((0x3F80_0000 - (shift << 23)) | bits(23))
        };
        let (x1, x2, r1) = (number(24), -number(30), number(30));
        let distance = x1 - x2;
        let r2 = f32::from_bits((distance - r1).abs().to_bits().saturating_add(bits(3)).saturating_sub(4));
        PairRecord::from_spheres([x1 * scale, 0.0, 0.0, r1 * scale], [x2 * scale, 0.0, 0.0, r2 * scale])
    })
}

/// With one unit less of the radius, contacts are lost.
#[test]
fn wide_and_exact_need_every_unit() {
    let count = 400_000;
    for (rule, reference, count) in [
        (rule(Format::WIDE), Reference::new(Format::WIDE, Fields::HIT), count),
        (BoundsRule::new(Arithmetic::Exact, 32).expect("a rule"), Reference::exact(Fields::HIT), count / 4),
    ] {
        let [wrong, contacts] = lost(rule, &reference, along_an_axis(count));
        assert!(wrong == 0 && contacts > u64::from(count / 4), "{reference:?}: {wrong} of {contacts}");
        let less = BoundsRule { radius_units: rule.radius_units - 1, ..rule };
        assert!(lost(less, &reference, along_an_axis(count))[0] > 0, "{reference:?}: every unit is needed");
    }
}

/// A contact in `wide` although the true distance exceeds the sum of the radii.
#[test]
fn boxes_of_the_radii_as_they_are_lose_a_contact() {
    let far = 2.0_f32.powi(-30).next_up();
    let pair = PairRecord::from_spheres([-1.0, 0.0, 0.0, 1.0], [far, 0.0, 0.0, 2.0_f32.powi(-30)]);
    assert_eq!(far, 2.0_f32.powi(-30) + 2.0_f32.powi(-53));
    assert_eq!(lost(rule(Format::WIDE), &Reference::new(Format::WIDE, Fields::HIT), [pair]), [0, 1]);
    let plain = BoundsRule { radius_units: 0, ..rule(Format::WIDE) };
    assert_eq!(lost(plain, &Reference::new(Format::WIDE, Fields::HIT), [pair]), [1, 1]);
}

/// Boxes that meet do so with fewer bits too, whatever is dropped, and fit their bits.
#[test]
fn boxes_of_fewer_bits_meet_whenever_boxes_of_more_bits_do() {
    let pairs = [Set::Random(3000).pairs(3), Set::Dense(3000).pairs(3)].concat();
    let rules: Vec<_> =
        BOX_BITS.map(|bits| BoundsRule::new(Arithmetic::Rounded(Format::WIDE), bits).expect("a rule")).collect();
    let mut meeting = vec![0_u32; rules.len()];
    for pair in &pairs {
        let mut before = false;
        for (place, rule) in rules.iter().enumerate().rev() {
            let bits = BOX_BITS.start() + place as u32;
            let [first, second] = spheres(pair).map(|sphere| rule.bounds(sphere));
            let meets = first.meets(&second);
            assert!(meets || !before, "{pair:?}, {bits} bits");
            before = meets;
            meeting[place] += u32::from(meets);
            let half = 1_i64 << (bits - 1);
            for bounds in [first, second].into_iter().filter(|bounds| *bounds != Bounds::EMPTY) {
                assert!(bounds.low.into_iter().chain(bounds.high).all(|edge| (-half..half).contains(&edge.into())));
            }
        }
    }
    assert!(meeting[0] > meeting[22] && meeting[22] > 3000, "{meeting:?}");
}

#[test]
fn arithmetic_for_which_no_box_is_wide_enough_is_refused() {
    let refused = |text: &str, bits: u32| {
        let profile: crate::number::Format = text.parse().expect("a format");
        BoundsRule::new(Arithmetic::Rounded(profile), bits).expect_err(text)
    };
    assert_eq!(refused("e8f23", 24), RefusedArithmetic::Underflows("e8f23".parse().expect("a format")));
    assert_eq!(refused("e9f23z", 24), RefusedArithmetic::Underflows("e9f23z".parse().expect("a format")));
    assert_eq!(refused("e10f23zr", 24), RefusedArithmetic::Faithful("e10f23zr".parse().expect("a format")));
    assert_eq!(refused("e10f23z", 9), RefusedArithmetic::Bits(9));
    assert_eq!(refused("e10f23z", 33), RefusedArithmetic::Bits(33));
    // Centres 2^-80 apart, of radius 0: in `paper` their squared distance is 0, so they touch.
    let pair = PairRecord::from_spheres([0.0; 4], [2.0_f32.powi(-80), 0.0, 0.0, 0.0]);
    assert!(Reference::new(Format::BINARY32, Fields::HIT).run(&pair).is_contact());
    assert!(!Reference::new(Format::WIDE, Fields::HIT).run(&pair).is_contact());
}
