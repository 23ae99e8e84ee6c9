use super::*;
use crate::kernel::Reference;
use crate::number::Format;
use crate::query::Fields;
use crate::spheres::{SphereSet, Spheres, hilbert_order, reorder};

const WIDE: Arithmetic = Arithmetic::Rounded(Format::WIDE);

fn search(bits: u32) -> Search {
    Search::new(WIDE, bits).expect("a search")
}

fn reference() -> Reference {
    Reference::new(Format::WIDE, Fields::HIT)
}

/// The pairs that touch, found by deciding every pair, in the order of a search.
fn brute_force(reference: &Reference, Spheres { first, second }: &Spheres) -> Vec<[u32; 2]> {
    let others = second.as_ref().unwrap_or(first);
    let mut found = Vec::new();
    for (j, other) in others.iter().enumerate() {
        let end = if second.is_none() { j } else { first.len() };
        let touching = (0..end).filter(|&i| {
            let contact = reference.run(&first[i].with(*other));
            contact.is_contact()
        });
        found.extend(touching.map(|i| [i as u32, j as u32]));
    }
    found.sort_by_key(|[i, j]| [j / 16, i / 16, *j, *i]);
    found
}

fn pairs(hits: Vec<Hit>) -> Vec<[u32; 2]> {
    hits.into_iter().map(|hit| hit.spheres).collect()
}

fn found(spheres: &Spheres, bits: u32) -> Vec<[u32; 2]> {
    let found = search(bits).find(&mut reference(), &spheres.first, spheres.second.as_deref());
    pairs(found.expect("the reference does not fail").hits)
}

/// Gases, diamonds, probes, in their order and along a curve, with few and many bits.
#[test]
fn a_search_finds_what_brute_force_finds_in_its_order() {
    for (text, contacts) in
        [("diamond:6", 510..=510), ("gas:600:0.3", 500..=900), ("gas:333:0.01", 1..=40), ("probes:150:400", 20..=200)]
    {
        let mut spheres = text.parse::<SphereSet>().expect(text).spheres(5);
        for sorted in [false, true] {
            if sorted {
                spheres.first = reorder(&spheres.first, &hilbert_order(&spheres.first));
                spheres.second = spheres.second.map(|second| reorder(&second, &hilbert_order(&second)));
            }
            let expected = brute_force(&reference(), &spheres);
            assert!(contacts.contains(&expected.len()), "{text}: {} contacts", expected.len());
            for bits in [10, 17, 24, 32] {
                assert_eq!(found(&spheres, bits), expected, "{text}, {bits} bits");
            }
        }
    }
}

/// The last row is empty, has one sphere, lacks one, is full; one sphere more; a second group of rows.
#[test]
fn every_length_of_the_last_row_is_right() {
    let gas = SphereSet::Gas(300, 300).spheres(2).first;
    for first in [0, 1, 2, 15, 16, 17, 255, 256, 257] {
        let mut spheres = Spheres { first: gas[..first].to_vec(), second: None };
        assert_eq!(found(&spheres, 24), brute_force(&reference(), &spheres), "{first} spheres");
        for second in [0, 1, 16, 17] {
            spheres.second = Some(gas[300 - second..].to_vec());
            assert_eq!(found(&spheres, 24), brute_force(&reference(), &spheres), "{first} against {second}");
        }
    }
}

#[test]
fn extreme_scenes_are_right() {
    let largest = Sphere::new([f32::MAX, -f32::MAX, 0.0, f32::MAX]);
    let small = |i: u32| Sphere::new([f32::from_bits(i), 0.0, 0.0, f32::from_bits(i % 3)]);
    let scenes: [(&str, Vec<Sphere>); 5] = [
        ("all in one place", vec![Sphere::new([1.0, 2.0, 3.0, 0.0]); 70]),
        ("none touch", (0..70).map(|i| Sphere::new([i as f32, 0.0, 0.0, 0.25])).collect()),
        ("points in a line of subnormals", (0..70).map(small).collect()),
        ("boxes without end", [vec![largest; 20], (0..20).map(|i| Sphere::new([i as f32; 4])).collect()].concat()),
        ("every second one is invalid", {
            (0..70).map(|i| Sphere::new([0.0, 0.0, 0.0, if i % 2 == 0 { 1.0 } else { f32::NAN }])).collect()
        }),
    ];
    for (name, first) in scenes {
        let spheres = Spheres { first, second: None };
        let expected = brute_force(&reference(), &spheres);
        assert_eq!(found(&spheres, 24), expected, "{name}");
        let count = match name {
            "all in one place" => 70 * 69 / 2,
            "none touch" => 0,
            "every second one is invalid" => 35 * 34 / 2,
            _ => continue,
        };
        assert_eq!(expected.len(), count, "{name}");
        let counts = search(24).candidates(&spheres.first, None).counts;
        assert_eq!(counts.invalid, if name.starts_with("every") { 35 } else { 0 }, "{name}");
    }
}

/// `exact` leaves pairs to the host; they are candidates.
#[test]
fn exact_finds_the_true_contacts() {
    let spheres = SphereSet::Gas(400, 200).spheres(9);
    let search = Search::new(Arithmetic::Exact, 24).expect("a search");
    let found = search.find(&mut Reference::exact(Fields::ALL), &spheres.first, None).expect("no failure");
    let mut expected = Vec::new();
    for j in 0..spheres.first.len() {
        for i in 0..j {
            let [x1, y1, z1, r1] = spheres.first[i].values().map(f64::from);
            let [x2, y2, z2, r2] = spheres.first[j].values().map(f64::from);
            let excess = (r1 + r2).powi(2) - ((x1 - x2).powi(2) + (y1 - y2).powi(2) + (z1 - z2).powi(2));
            assert!(excess.abs() > 1e-9, "no pair of this gas is hard");
            if excess > 0.0 {
                expected.push([i as u32, j as u32]);
            }
        }
    }
    expected.sort_by_key(|[i, j]| [j / 16, i / 16, *j, *i]);
    assert!(expected.len() > 200);
    assert_eq!(pairs(found.hits), expected);
}

/// A scene far from the origin has nearly the same candidates with 24 bits, and many more with few.
#[test]
fn a_moved_scene_has_few_more_candidates() {
    let spheres = SphereSet::Diamond(8).spheres(1).first;
    let candidates = |by: f32, bits: u32| {
        let moved = spheres.iter().map(|sphere| {
            let [x, y, z, r] = sphere.values();
            Sphere::new([x + by, y + by, z + by, r])
        });
        search(bits).candidates(&moved.collect::<Vec<_>>(), None).counts.candidates as f64
    };
    let here = candidates(0.0, 24);
    assert!(candidates(10_000.0, 24) <= 1.2 * here);
    assert!(candidates(10_000.0, 18) > 5.0 * here);
}

/// A search that does less work than all pairs, and in a good order still less.
#[test]
fn the_order_changes_the_work_and_not_the_hits() {
    let shuffled = SphereSet::Gas(4096, 100).spheres(1).first;
    let order = hilbert_order(&shuffled);
    let sorted = reorder(&shuffled, &order);
    let [unsorted_counts, sorted_counts] =
        [&shuffled, &sorted].map(|spheres| search(24).candidates(spheres, None).counts);
    assert_eq!(unsorted_counts.candidates, sorted_counts.candidates);
    assert!(20 * sorted_counts.column_tests < unsorted_counts.column_tests, "{sorted_counts:?} {unsorted_counts:?}");
    let spheres = Spheres { first: shuffled, second: None };
    let mut expected = found(&spheres, 24);
    expected.sort_unstable();
    let by_curve = search(24).find_in_order(&mut reference(), &spheres.first, &order).expect("no failure");
    assert_eq!(by_curve.counts, sorted_counts);
    let contact = reference().run(&spheres.first[expected[0][0] as usize].with(spheres.first[expected[0][1] as usize]));
    assert_eq!(by_curve.hits[0].contact, contact);
    assert_eq!(pairs(by_curve.hits), expected);
}
