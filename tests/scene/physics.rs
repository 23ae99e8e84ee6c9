//! Energy and momentum behave as the named effects say.

use contact_afu::scene::{Energy, Plan, Scene, run};

use crate::scene;

fn energies(scene: &Scene) -> Vec<Energy> {
    let plan = Plan::of(scene).unwrap();
    let mut engine = plan.config.profile.reference(plan.config.contact);
    run(scene, &plan, &mut engine, "test", |_| {}).unwrap().energy
}

fn total(energy: &Energy) -> f64 {
    energy.kinetic + energy.potential
}

/// A frictionless gas that springs back keeps its energy: within one part in a thousand over 10 000 steps.
#[test]
fn an_elastic_gas_keeps_its_energy_through_ten_thousand_steps() {
    let mut gas = scene("gas");
    gas.steps.value = 10_000;
    gas.want.retain(|(want, _)| want.name() == "energy");
    let energies = energies(&gas);
    assert_eq!(energies.len(), 10_001);
    let first = total(&energies[0]);
    let worst = energies.iter().map(|e| (total(e) - first).abs() / first).fold(0.0, f64::max);
    println!("energy within {worst:.2e} of {first}");
    assert!(worst < 1e-3, "{worst}");
}

/// Without walls nothing from outside acts: momentum stays, to what f32 normals leave of it.
#[test]
fn bodies_among_themselves_keep_their_momentum() {
    let text = "scene = 1\nsteps = 3000\nwant = [\"energy\"]\n[effects]\nbounce = 1.0\n\
                [[bodies]]\nshape = \"lattice\"\ncount = [3, 3, 3]\nradius = 0.3\ngap = 0.2\n\
                [[bodies]]\nshape = \"lattice\"\ncount = [2, 2, 2]\nradius = 0.2\nat = [4.0, 0.1, 0.2]\nvelocity = [-1.5, 0.05, 0.0]\n";
    let energies = energies(&Scene::parse("test", text).unwrap());
    let (first, last) = (&energies[0], energies.last().unwrap());
    let moved = (last.kinetic - first.kinetic).abs() / first.kinetic;
    for axis in 0..3 {
        let kept = (last.momentum[axis] - first.momentum[axis]).abs();
        assert!(kept < 1e-6 * 12.0, "axis {axis}: {kept}");
    }
    assert!(moved < 1e-3, "energy changed by {moved}");
}

#[test]
fn damping_lets_energy_fall_in_every_step() {
    let text = "scene = 1\nsteps = 400\nwant = [\"energy\"]\n[effects]\ndamping = 0.02\nbounce = 0.5\n\
                [[bodies]]\nshape = \"lattice\"\ncount = [2, 2, 2]\nradius = 0.3\ngap = 0.1\n\
                [[bodies]]\nshape = \"stack\"\ncount = 1\nradius = 0.3\nat = [3.0, 0.3, 0.2]\nvelocity = [-2.0, 0.0, 0.0]\n";
    let energies = energies(&Scene::parse("test", text).unwrap());
    for (step, pair) in energies.windows(2).enumerate() {
        assert!(total(&pair[1]) < total(&pair[0]), "step {step}: {} to {}", total(&pair[0]), total(&pair[1]));
    }
    assert!(total(&energies[400]) < 1e-3 * total(&energies[0]));
}

/// The column falls and comes to rest, asleep: nothing is sent any more.
#[test]
fn a_granular_column_comes_to_rest() {
    let column = scene("column");
    let plan = Plan::of(&column).unwrap();
    let mut engine = plan.config.profile.reference(plan.config.contact);
    let results = run(&column, &plan, &mut engine, "test", |_| {}).unwrap();
    assert_eq!(results.energy.last().unwrap().kinetic, 0.0);
    assert!(results.summary.asleep > 0 && results.summary.contacts > 1000);
}

/// An effect that a scene does not name is not there: without gravity, pull or contacts, bodies go straight on.
#[test]
fn nothing_happens_that_is_not_named() {
    let text = "scene = 1\nsteps = 50\nwant = [\"trajectories\"]\n\
                [[bodies]]\nshape = \"stack\"\ncount = 2\nvelocity = [1.0, 0.0, 0.0]\n\
                [[bodies]]\nshape = \"stack\"\ncount = 1\nat = [0.5, 0.0, 0.0]\n";
    let scene = Scene::parse("test", text).unwrap();
    let plan = Plan::of(&scene).unwrap();
    struct Nobody;
    impl contact_afu::kernel::Engine for Nobody {
        fn contacts(
            &mut self,
            _: &[contact_afu::kernel::PairRecord],
        ) -> Result<Vec<contact_afu::kernel::ContactRecord>, contact_afu::kernel::EngineError> {
            Err("nobody is asked who touches whom".into())
        }
    }
    let results = run(&scene, &plan, &mut Nobody, "test", |_| {}).unwrap();
    let last = results.places.last().unwrap();
    let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-12);
    assert!(
        near(last[0], [0.5, 0.0, 0.0]) && near(last[1], [0.5, 0.0, 2.0]) && near(last[2], [0.5, 0.0, 0.0]),
        "{last:?}"
    );
}
