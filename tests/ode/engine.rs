//! An engine instead of ODE's collider: the same contacts, as far as binary32 can represent them.

use contact_afu::kernel::batch::Level;
use contact_afu::kernel::{Engine, EngineError, Reference};
use contact_afu::number::Format;
use contact_afu::ode::{Collider, Contact, Diamond, Error, Ode, SpherePair, Surface, Touch, World};
use contact_afu::pairs::Set;
use contact_afu::query::{ContactRecord, Fields, Flow, PairRecord};
use std::collections::HashSet;

fn engines() -> Vec<(&'static str, Box<dyn Engine>)> {
    vec![
        ("paper", Box::new(Reference::new(Format::BINARY32, Fields::ALL))),
        ("wide", Box::new(Reference::new(Format::WIDE, Fields::ALL))),
        ("batch", Box::new(Level::best())),
    ]
}

/// At the start every number is exact in binary32, and so is every contact: equal bits, in the same order.
#[test]
fn in_the_first_step_every_engine_gives_the_contacts_of_ode() {
    for (layers, pairs, real) in [(3, 132, 36), (10, 12_354, 2_934)] {
        let diamond = Diamond::new(layers, 0.0);
        let ode = Ode::start(Collider::Own).unwrap();
        let simulation = diamond.build(&ode).unwrap();
        let candidates = simulation.world().candidates().unwrap();
        let expected = simulation.world().contacts().unwrap();
        assert_eq!((candidates.len(), expected.len(), candidates.len() - expected.len()), (pairs, real, pairs - real));
        drop((simulation, ode));

        for (name, mut engine) in engines() {
            let ode = Ode::start(Collider::Engine).unwrap();
            let mut simulation = diamond.build(&ode).unwrap();
            let found = simulation.world().contacts_by(&mut *engine).unwrap();
            assert_eq!(bits(&found), bits(&expected), "{name}, hMax {layers}");
            simulation.advance(&found).unwrap();
        }
    }
}

/// Compares bits, so the sign of a zero counts.
fn bits(touches: &[Touch]) -> Vec<(usize, usize, [u64; 7])> {
    touches.iter().map(|t| (t.first.index(), t.second.index(), words(&t.contact))).collect()
}

fn words(Contact { position: [a, b, c], normal: [d, e, f], depth }: &Contact) -> [u64; 7] {
    [a, b, c, d, e, f, depth].map(|v| v.to_bits())
}

/// The set of pairs called diamond:H is what ODE's broad phase finds.
#[test]
fn the_candidates_are_those_of_the_named_set() {
    let ode = Ode::start(Collider::Own).unwrap();
    for layers in [1, 3, 10] {
        let simulation = Diamond::new(layers, 0.0).build(&ode).unwrap();
        let world = simulation.world();
        let lower_first = |pair: PairRecord| {
            let v = pair.values();
            let swapped = v[..3].partial_cmp(&v[4..7]).unwrap().is_gt();
            if swapped { PairRecord(std::array::from_fn(|i| pair.0[(i + 4) % 8])) } else { pair }
        };
        let found: Vec<_> =
            world.candidates().unwrap().into_iter().map(|pair| lower_first(world.record(pair))).collect();
        let named = Set::Diamond(layers).pairs(0);
        assert_eq!(found.len(), named.len());
        assert_eq!(HashSet::<_>::from_iter(found), HashSet::from_iter(named), "hMax {layers}");
    }
}

/// In later steps the engine's inputs are rounded. With u = 2^-24, half an ulp of 1, coordinates up to M are rounded by
/// at most uM, and radii by half an ulp. A distance d changes by at most 2√3·uM and its own four roundings, the sum of
/// radii s by two. So with e = 4u(M + d + s):
///
/// - the decision is ODE's wherever |d − s| > e;
/// - a depth differs by at most e, a normal by 2e/d, and a position, p1 + n·k with |k| ≤ d here, by 4e.
#[test]
fn later_contacts_differ_by_no_more_than_rounding_allows() {
    type Sphere = [f64; 4];
    for (name, mut engine) in engines() {
        // The pairs of spheres, and the engine's answer for each.
        let mut seen: Vec<(Sphere, Sphere, Option<Contact>)> = Vec::new();
        {
            let ode = Ode::start(Collider::Engine).unwrap();
            let mut simulation = Diamond::new(6, 0.05).build(&ode).unwrap();
            for _ in 0..100 {
                let world = simulation.world();
                let touches = world.contacts_by(&mut *engine).unwrap();
                if simulation.steps() % 10 == 9 {
                    let sphere = |sphere| {
                        let [x, y, z] = world.position(sphere);
                        [x, y, z, world.radius(sphere)]
                    };
                    let mut touching = touches.iter().peekable();
                    for [first, second] in world.candidates().unwrap() {
                        let touch = touching.next_if(|touch| (touch.first, touch.second) == (first, second));
                        seen.push((sphere(first), sphere(second), touch.map(|touch| touch.contact)));
                    }
                    assert!(touching.next().is_none(), "contacts come in the order of candidates");
                }
                simulation.advance(&touches).unwrap();
            }
        }

        let ode = Ode::start(Collider::Own).unwrap();
        let mut pair = SpherePair::new(&ode).unwrap();
        let (mut decided, mut real, mut inexact) = (0, 0, 0);
        for (first, second, found) in &seen {
            pair.set(*first, *second).unwrap();
            let expected = pair.collide();
            let d = distance(&first[..3], &second[..3]);
            let s = first[3] + second[3];
            let m = first[..3].iter().chain(&second[..3]).fold(0.0_f64, |m, v| m.max(v.abs()));
            let e = 4.0 * 2_f64.powi(-24) * (m + d + s);
            if (d - s).abs() > e {
                assert_eq!(found.is_some(), expected.is_some(), "{name}: {first:?} {second:?}");
                decided += 1;
            }
            let (Some(found), Some(expected)) = (found, expected) else { continue };
            real += 1;
            inexact += usize::from(*found != expected);
            assert!((found.depth - expected.depth).abs() <= e, "{name}: {found:?} {expected:?}");
            assert!(distance(&found.normal, &expected.normal) <= 2.0 * e / d, "{name}: {found:?} {expected:?}");
            assert!(distance(&found.position, &expected.position) <= 4.0 * e, "{name}: {found:?} {expected:?}");
        }
        // The bounds are exercised: most decisions are covered by them, and contacts do differ.
        assert!(decided > seen.len() * 3 / 4 && real > 500 && inexact > real / 2, "{decided} {real} {inexact}");
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// An engine that returns preset contacts.
struct Parrot(Vec<ContactRecord>);

impl Engine for Parrot {
    fn contacts(&mut self, _: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        Ok(self.0.clone())
    }
}

/// ODE swaps and negates the contact of an override. The result must equal the override's contact, including the sign
/// of zeros. The normal of coincident centres, (1, 0, 0), tests that.
#[test]
fn a_contact_passes_through_ode_unchanged() {
    let ode = Ode::start(Collider::Engine).unwrap();
    let mut world = World::new(&ode).unwrap();
    world.add_sphere([0.0; 3], 0.5, 1.0).unwrap();
    world.add_sphere([0.0; 3], 0.25, 1.0).unwrap();
    let coincident = world.contacts_by(&mut Reference::new(Format::BINARY32, Fields::ALL)).unwrap();
    let expected = Contact { position: [0.0; 3], normal: [1.0, 0.0, 0.0], depth: 0.75 };
    assert_eq!(coincident.len(), 1);
    assert_eq!(words(&coincident[0].contact), words(&expected));

    let mut contacts = 0;
    for pair in Set::Random(20_000).pairs(3) {
        let answer = Reference::new(Format::BINARY32, Fields::ALL).run(&pair);
        match (world.contacts_by(&mut Parrot(vec![answer])), Contact::from_record(answer)) {
            (Ok(found), expected) => {
                assert_ne!(answer.flow(), Some(Flow::Invalid));
                let found = found.iter().map(|touch| words(&touch.contact)).next();
                assert_eq!(found, expected.as_ref().map(words), "{pair:?}");
                contacts += usize::from(expected.is_some());
            }
            (Err(Error::Flags { flags, .. }), None) => assert_eq!(flags, 8),
            // The contact is NaN or farther away than any sphere of a world.
            (Err(Error::Contact { .. }), Some(contact)) => {
                assert!([contact.depth].iter().chain(&contact.position).any(|v| v.is_nan() || v.abs() > 1e8));
            }
            other => panic!("{other:?}"),
        }
    }
    assert!(contacts > 3_000, "{contacts}");
}

#[test]
fn a_wrong_engine_is_an_error_and_never_a_contact() {
    struct Broken;
    impl Engine for Broken {
        fn contacts(&mut self, _: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
            Err("it is broken".into())
        }
    }
    let ode = Ode::start(Collider::Engine).unwrap();
    let mut world = World::new(&ode).unwrap();
    let [first, second] = [0.0, 0.5].map(|x| world.add_sphere([x, 0.0, 0.0], 0.5, 1.0).unwrap());
    let error = world.contacts_by(&mut Broken).unwrap_err();
    assert_eq!(error.to_string(), "the engine that replaces ODE's collider: it is broken");

    let good = Reference::new(Format::WIDE, Fields::ALL).run(&world.record([first, second]));
    let says = |contacts: &[ContactRecord]| world.contacts_by(&mut Parrot(contacts.to_vec()));
    assert_eq!(says(&[good]).unwrap().len(), 1);
    assert!(matches!(says(&[]), Err(Error::Count { pairs: 1, contacts: 0 })));
    assert!(matches!(says(&[good; 2]), Err(Error::Count { pairs: 1, contacts: 2 })));
    for flags in [0, 1, 3, 8, 0x17] {
        let mut bad = good;
        bad.0[7] = flags;
        assert!(matches!(says(&[bad]), Err(Error::Flags { flags: seen, .. }) if seen == flags), "{flags}");
    }
    for place in 0..7 {
        for value in [f32::NAN, f32::INFINITY, 1e30] {
            let mut bad = good;
            bad.0[place] = value.to_bits();
            assert!(matches!(
                says(&[bad]),
                Err(Error::Contact { first: 1, second: 0 } | Error::Contact { first: 0, second: 1 })
            ));
        }
    }
    // An invalid contact passed directly is rejected, too.
    let contact = Contact { position: [f64::NAN; 3], normal: [1.0, 0.0, 0.0], depth: 0.0 };
    let touch = Touch { first, second, contact };
    assert!(matches!(world.join(&touch, &Surface::SMOOTH), Err(Error::Contact { first: 0, second: 1 })));
}

#[test]
fn the_collider_that_runs_is_the_one_that_is_used() {
    let reference = || Reference::new(Format::WIDE, Fields::ALL);
    {
        let ode = Ode::start(Collider::Own).unwrap();
        let world = World::new(&ode).unwrap();
        assert!(matches!(world.contacts_by(&mut reference()), Err(Error::OtherCollider { .. })));
        assert!(world.contacts().unwrap().is_empty());
    }
    let ode = Ode::start(Collider::Engine).unwrap();
    let world = World::new(&ode).unwrap();
    assert!(matches!(world.contacts(), Err(Error::OtherCollider { .. })));
    assert!(matches!(SpherePair::new(&ode), Err(Error::OtherCollider { .. })));
    assert!(world.contacts_by(&mut reference()).unwrap().is_empty());
}
