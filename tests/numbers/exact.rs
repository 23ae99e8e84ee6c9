//! The profile `exact`: right for every pair of finite spheres, with unsettled pairs resolved by the host.

use contact_afu::kernel::{Filtered, Reference, Truth, exact, ulp};
use contact_afu::number::{Format, Precise};
use contact_afu::pairs::{CATEGORIES, Set, read_pairs};
use contact_afu::query::{ContactRecord, Fields, Flow, PairRecord, Query};
use std::path::Path;

const EXACT: Reference = Reference::exact(Fields::ALL);

/// The result of kernel and host for a pair, and whether the host was needed.
fn settled(pair: &PairRecord) -> (ContactRecord, bool) {
    let (contacts, unsettled) = EXACT.settled(std::slice::from_ref(pair));
    (contacts[0], unsettled > 0)
}

/// Checks that the decision is exact and every number is within one unit in the last place.
fn check(what: &str, pair: &PairRecord) -> bool {
    let truth = Truth::of(pair);
    let (found, by_host) = settled(pair);
    assert_eq!(found.flow(), Some(truth.flow()), "{what}: {pair:?}");
    match truth.errors(found) {
        Some(errors) => assert!(errors.largest() <= 1.0, "{what}: {pair:?}: {found:?}: {errors:?}"),
        None => assert_eq!(found.0[..7], [0; 7], "{what}: {pair:?}"),
    }
    by_host
}

#[test]
fn every_category_is_right() {
    for category in CATEGORIES {
        let count = 1_500;
        let by_host = category.pairs(count, 31).filter(|pair| check(category.name(), pair)).count() as u64;
        // These two categories consist of pairs that exceed the kernel's window.
        let share = if ["cancel", "sideways"].contains(&category.name()) { count } else { count / 100 };
        assert!(by_host <= share, "{}: {by_host} of {count} unsettled", category.name());
    }
}

#[test]
fn the_corpus_is_right() {
    let corpus = read_pairs(Query::SphereSphere, &Path::new(env!("CARGO_MANIFEST_DIR")).join("tb/corpus/hard.csv"))
        .expect("the corpus");
    let swapped = corpus.iter().map(|pair| {
        let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.0;
        PairRecord([x2, y2, z2, r2, x1, y1, z1, r1])
    });
    let by_host = corpus.iter().copied().chain(swapped).filter(|pair| check("corpus", pair)).count();
    assert!(by_host > 400, "the corpus has what the window cannot hold: {by_host}");
}

/// Fewer than one in ten thousand ordinary pairs go to the host, and none of the paper's diamond, whose contacts are
/// all exactly tangent.
#[test]
fn the_host_is_seldom_needed() {
    let unsettled = |pairs: &[PairRecord]| EXACT.run_all(pairs).iter().filter(|c| c.is_unsettled()).count();
    let ordinary: Vec<_> = CATEGORIES[0].pairs(300_000, 1).collect();
    assert!(unsettled(&ordinary) < 30, "{} ordinary pairs", unsettled(&ordinary));
    assert_eq!(unsettled(&Set::Diamond(10).pairs(0)), 0);
}

#[test]
fn swapping_the_spheres_negates_the_normal() {
    let pairs = Set::Hard(60_000).pairs(9);
    for pair in &pairs {
        let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.0;
        let (there, _) = settled(pair);
        let (back, _) = settled(&PairRecord([x2, y2, z2, r2, x1, y1, z1, r1]));
        assert_eq!((there.flags(), there.0[6]), (back.flags(), back.0[6]), "{pair:?}");
        for axis in (0..3).filter(|_| there.flow() == Some(Flow::Real)) {
            assert_eq!(there.normal()[axis], -back.normal()[axis], "{pair:?}");
            let (p, q) = (there.position()[axis], back.position()[axis]);
            let makers = [axis, 3, 4 + axis, 7].map(|i| pair.values()[i].abs());
            let unit = ulp(makers.into_iter().chain([p.abs(), q.abs()]).fold(0.0, f32::max));
            assert!(p == q || (f64::from(p) - f64::from(q)).abs() <= unit, "{pair:?}: {p} and {q}");
        }
    }
}

/// A selected field has the same bits whichever others are selected. An invalid pair is invalid in every profile.
#[test]
fn fields_and_invalid_pairs() {
    for pair in Set::Random(20_000).pairs(4) {
        let whole = EXACT.run(&pair);
        assert_eq!(pair.is_valid(Query::SphereSphere), whole.flow() != Some(Flow::Invalid), "{pair:?}");
        let mut part = Reference::exact(Fields { normal: false, ..Fields::ALL }).run(&pair);
        part.0[3..6].copy_from_slice(&whole.0[3..6]);
        assert_eq!(part, whole, "{pair:?}");
    }
}

/// Evaluates the kernel's formula with exact numbers, which must give the true contact's record.
#[test]
fn the_kernel_is_the_same_contact() {
    for pair in Set::Hard(5_100).pairs(6) {
        let truth = Truth::of(&pair);
        let word = |word: usize| Precise::from_f64(f32::from_bits(pair.0[word]).into());
        let Filtered { contact, unsettled } = exact(word, true, Format::BINARY32, Fields::ALL);
        assert!(!unsettled, "nothing is in doubt");
        assert_eq!(contact.hit, truth.is_contact(), "{pair:?}");
        if truth.flow() == Flow::Real {
            let words = |v: [Precise; 3]| v.map(|number| number.to_f32().abs().to_bits());
            assert_eq!(words(contact.normal.into()), truth.record().normal().map(|v| v.abs().to_bits()), "{pair:?}");
            assert_eq!(words([contact.depth; 3])[0], truth.record().depth().to_bits(), "{pair:?}");
        }
    }
}

/// The long version of the test above: a million pairs.
#[test]
#[ignore = "minutes: a million truths"]
fn a_million_pairs_are_right() {
    crate::support::halves(1_000_000, |part| {
        for pair in Set::Hard(part.end).pairs(12).drain(part.start as usize..) {
            check("a million", &pair);
        }
    });
}
