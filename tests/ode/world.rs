//! ODE itself behind its wrapper: its collider, its worlds, and inputs that the wrapper must reject.

use contact_afu::kernel::contact;
use contact_afu::number::{Format, Soft};
use contact_afu::ode::{BroadPhase, Collider, Contact, Diamond, Error, Ode, SpherePair, Surface, Touch, World};
use contact_afu::pairs::Set;
use contact_afu::query::{Fields, Query};
use std::panic::{AssertUnwindSafe, catch_unwind};

const BINARY64: &str = "e11f52";

/// Compares every bit of ODE's collider with the kernel evaluated in binary64. Returns three counts: pairs that touch,
/// those of them with coincident centres, and pairs that are apart.
fn compare(query: Query, ode: &Ode, pairs: impl Iterator<Item = [f64; 8]>) -> [usize; 3] {
    let format: Format = BINARY64.parse().unwrap();
    let mut bodies = SpherePair::of_query(query, ode).unwrap();
    let (mut touching, mut coincident, mut apart) = (0, 0, 0);
    for pair in pairs {
        let [a, b, c, d, e, f, g, h] = pair;
        bodies.set([a, b, c, d], [e, f, g, h]).unwrap();
        let word = |word: usize| Soft::from_bits(format, pair[word].to_bits().into());
        let expected = contact(query, word, true, format, format, Fields::ALL);
        match bodies.collide() {
            None => {
                assert!(!expected.hit, "{pair:?}");
                apart += 1;
            }
            Some(Contact { position: [a, b, c], normal: [d, e, f], depth }) => {
                assert!(expected.hit, "{pair:?}");
                let expected_bits = expected.numbers().map(|v| v.bits() as u64);
                assert_eq!([a, b, c, d, e, f, depth].map(f64::to_bits), expected_bits, "{pair:?}");
                touching += 1;
                coincident += usize::from(expected.coincident);
            }
        }
    }
    [touching, coincident, apart]
}

/// Valid random pairs in binary64, multiplied by a factor with a full significand. Plain binary32 values would leave
/// half of each binary64 significand untested.
fn in_binary64(query: Query) -> impl Iterator<Item = [f64; 8]> {
    let factor = 1.0 + 1.0 / 3.0;
    let pairs = Set::Random(30_000).pairs_of(query, 5).unwrap().into_iter();
    pairs.filter(move |pair| pair.is_valid(query)).map(move |pair| pair.values().map(|v| f64::from(v) * factor))
}

/// The kernel's order of operations is ODE's: evaluated in binary64, it gives the bits of ODE's own collider.
#[test]
fn the_kernel_read_in_binary64_is_odes_collider() {
    let ode = Ode::start(Collider::Own).unwrap();
    let found = compare(Query::SphereSphere, &ode, in_binary64(Query::SphereSphere));
    assert!(found[0] > 5_000 && found[1] > 500 && found[2] > 5_000, "{found:?}");
}

/// ODE scales a plane's normal and distance by 1/|n|, which has no effect if |n|² rounds to 1.
#[test]
fn the_kernel_of_a_plane_read_in_binary64_is_odes_collider() {
    let ode = Ode::start(Collider::Own).unwrap();
    let planes = in_binary64(Query::SpherePlane).filter_map(|[x, y, z, r, nx, ny, nz, d]| {
        let square = |[x, y, z]: [f64; 3]| (x * x + y * y) + z * z;
        let length = square([nx, ny, nz]).sqrt();
        let [nx, ny, nz] = [nx, ny, nz].map(|component| component / length);
        (square([nx, ny, nz]) == 1.0).then_some([x, y, z, r, nx, ny, nz, d])
    });
    let found = compare(Query::SpherePlane, &ode, planes);
    assert!(found[0] > 3_000 && found[2] > 3_000, "{found:?}");
}

#[test]
fn a_force_moves_a_sphere_as_newton_says() {
    let ode = Ode::start(Collider::Own).unwrap();
    let mut world = World::new(&ode).unwrap();
    let sphere = world.add_sphere([1.0, 2.0, 3.0], 0.5, 2.0).unwrap();
    let mass = 2.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.125;
    world.add_force(sphere, [mass, 0.0, 0.0]).unwrap();
    world.step(0.5).unwrap();
    world.step(0.5).unwrap();
    // The acceleration is 1 for half a second, then 0. ODE uses the speed at a step's end for the whole step.
    let [x, y, z] = world.position(sphere);
    assert!((x - 1.5).abs() < 1e-12, "{x}");
    assert_eq!(([y, z], world.radius(sphere)), ([2.0, 3.0], 0.5));
}

#[test]
fn a_joint_parts_spheres_and_lasts_a_step() {
    let ode = Ode::start(Collider::Own).unwrap();
    let speed = |surface: Surface| {
        let mut world = World::new(&ode).unwrap();
        let [first, second] = [0.0, 1.0].map(|x| world.add_sphere([x, 0.0, 0.0], 0.5, 1.0).unwrap());
        world.add_force(first, [1.0, 0.0, 0.0]).unwrap();
        world.step(0.01).unwrap();
        for touch in world.contacts().unwrap() {
            world.join(&touch, &surface).unwrap();
        }
        let before = world.position(second)[0];
        world.step(0.01).unwrap();
        let pushed = world.position(second)[0] - before;
        let before = world.position(second)[0];
        world.step(0.01).unwrap();
        let after = world.position(second)[0] - before;
        assert!((after - pushed).abs() < 1e-12, "no joint is left: {pushed} {after}");
        pushed / 0.01
    };
    let smooth = speed(Surface::SMOOTH);
    let bouncing = speed(Surface { bounce: 1.0, ..Surface::SMOOTH });
    assert!(smooth > 0.0 && bouncing > 1.5 * smooth, "{smooth} {bouncing}");
}

#[test]
fn worlds_do_not_disturb_each_other() {
    let ode = Ode::start(Collider::Own).unwrap();
    let diamond = Diamond::new(4, 0.02);
    let run = |others: usize| {
        let mut simulations: Vec<_> = (0..=others).map(|_| diamond.build(&ode).unwrap()).collect();
        for _ in 0..60 {
            for simulation in &mut simulations {
                let touches = simulation.world().contacts().unwrap();
                simulation.advance(&touches).unwrap();
            }
        }
        simulations[0].positions().map(|p| p.map(f64::to_bits)).collect::<Vec<_>>()
    };
    assert_eq!(run(0), run(2));
}

#[test]
fn both_broad_phases_find_the_same_contacts() {
    let ode = Ode::start(Collider::Own).unwrap();
    let found = [BroadPhase::Hash, BroadPhase::SweepAndPrune].map(|broad_phase| {
        let mut world = World::with_broad_phase(&ode, broad_phase).unwrap();
        for number in 0..1000 {
            // A lattice of spheres with overlaps, and spheres of very different sizes in it.
            let at = [number % 10, number / 10 % 10, number / 100].map(f64::from);
            world.add_sphere(at, if number % 97 == 0 { 3.0 } else { 0.51 }, 1.0).unwrap();
        }
        let touches = world.contacts().unwrap();
        let mut pairs: Vec<_> = touches.iter().map(|t| [t.first.min(t.second), t.first.max(t.second)]).collect();
        pairs.sort_unstable();
        pairs
    });
    assert!(found[0].len() > 2700, "each inner sphere touches its neighbours: {}", found[0].len());
    assert_eq!(found[0], found[1]);
}

#[test]
fn a_panic_in_the_near_callback_comes_out_of_ode_whole() {
    let ode = Ode::start(Collider::Own).unwrap();
    let simulation = Diamond::new(3, 0.0).build(&ode).unwrap();
    let mut visits = 0;
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        simulation.world().near(|_, _| {
            visits += 1;
            assert!(visits < 5, "five is enough");
        })
    }));
    assert_eq!(outcome.unwrap_err().downcast_ref(), Some(&"five is enough"));
    assert_eq!(visits, 5, "none after the panic");
    assert_eq!(simulation.world().candidates().unwrap().len(), 132, "and the world works on");
}

#[test]
fn what_ode_would_end_the_process_for_is_refused() {
    let ode = Ode::start(Collider::Own).unwrap();
    let mut world = World::new(&ode).unwrap();
    for bad in [f64::NAN, f64::INFINITY, 1e9] {
        assert!(matches!(world.add_sphere([0.0, bad, 0.0], 1.0, 1.0), Err(Error::Number { what: "a coordinate", .. })));
    }
    for bad in [f64::NAN, -1.0, 0.0, 1e-300, f64::INFINITY] {
        assert!(matches!(world.add_sphere([0.0; 3], bad, 1.0), Err(Error::Number { what: "a radius", .. })));
        assert!(matches!(world.add_sphere([0.0; 3], 1.0, bad), Err(Error::Number { what: "a density", .. })));
        assert!(matches!(world.step(bad), Err(Error::Number { what: "a step's time", .. })));
    }
    assert!(world.set_iterations(0).is_err());
    let sphere = world.add_sphere([0.0; 3], 1.0, 1.0).unwrap();
    assert_eq!(world.spheres().len(), 1, "nothing of what was refused is left");
    assert!(world.add_force(sphere, [0.0, 0.0, f64::NAN]).is_err());
    let contact = Contact { position: [0.0; 3], normal: [1.0, 0.0, 0.0], depth: 0.0 };
    let itself = Touch { first: sphere, second: sphere, contact };
    assert!(matches!(world.join(&itself, &Surface::SMOOTH), Err(Error::Itself(0))));

    let mut pair = SpherePair::new(&ode).unwrap();
    for bad in [f64::NAN, -1e-300, f64::INFINITY] {
        let error = pair.set([0.0; 4], [0.0, 0.0, 0.0, bad]).unwrap_err();
        assert!(error.to_string().starts_with("a radius is "), "{error}");
    }
    assert_eq!(pair.collide().map(|contact| contact.depth), Some(0.0), "points that coincide touch");

    let diamond = Diamond::new(3, 0.0);
    for bad in [
        Diamond { layers: 0, ..diamond },
        Diamond { layers: 41, ..diamond },
        Diamond { gap: -1.1, ..diamond },
        Diamond { force: f64::NAN, ..diamond },
        Diamond { time_step: 0.0, ..diamond },
        Diamond { iterations: 0, ..diamond },
    ] {
        assert!(bad.build(&ode).is_err(), "{bad:?}");
    }
}

#[test]
fn a_sphere_that_flies_away_is_lost_and_not_the_process() {
    let ode = Ode::start(Collider::Own).unwrap();
    let mut world = World::new(&ode).unwrap();
    let sphere = world.add_sphere([0.0; 3], 0.5, 1.0).unwrap();
    world.add_force(sphere, [1e8, 0.0, 0.0]).unwrap();
    let error = world.step(10.0).unwrap_err();
    assert!(matches!(error, Error::Lost { sphere: 0, .. }), "{error}");
    assert!(matches!(world.candidates(), Err(Error::Lost { .. })));
    assert!(matches!(world.step(0.01), Err(Error::Lost { .. })));
}
