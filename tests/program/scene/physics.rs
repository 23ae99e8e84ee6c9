//! Energy and momentum behave as the scene's effects require.

use contact_afu::scene::{Detector, Energy, Plan, Scene, SceneRun, run};

use super::scene;

fn results(scene: &Scene) -> SceneRun {
    let plan = Plan::of(scene).unwrap();
    let mut engine = plan.config.profile.reference(plan.config.contact);
    run(scene, &plan, Detector::Pairs(&mut engine), "test", |_| {}).unwrap()
}

fn energies(scene: &Scene) -> Vec<Energy> {
    results(scene).energy
}

fn total(energy: &Energy) -> f64 {
    energy.kinetic + energy.potential
}

/// A frictionless gas with elastic collisions keeps its energy within one part in a thousand over 10 000 steps.
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

/// Without walls there is no external force: momentum is constant, except for the error of f32 normals.
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

/// The column falls, comes to rest and sleeps, so that no more pairs are sent.
#[test]
fn a_granular_column_comes_to_rest() {
    let column = scene("column");
    let plan = Plan::of(&column).unwrap();
    let mut engine = plan.config.profile.reference(plan.config.contact);
    let results = run(&column, &plan, Detector::Pairs(&mut engine), "test", |_| {}).unwrap();
    assert_eq!(results.energy.last().unwrap().kinetic, 0.0);
    assert!(results.summary.asleep > 0 && results.summary.contacts > 1000);
}

/// An effect that the scene does not name is absent: without gravity, pull or contacts, bodies go straight on.
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
            _: &[contact_afu::query::PairRecord],
        ) -> Result<Vec<contact_afu::query::ContactRecord>, contact_afu::kernel::EngineError> {
            Err("nobody is asked who touches whom".into())
        }
    }
    let results = run(&scene, &plan, Detector::Pairs(&mut Nobody), "test", |_| {}).unwrap();
    let last = results.places.last().unwrap();
    let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-12);
    assert!(
        near(last[0], [0.5, 0.0, 0.0]) && near(last[1], [0.5, 0.0, 2.0]) && near(last[2], [0.5, 0.0, 0.0]),
        "{last:?}"
    );
}

/// A former fault: a lattice whose `at` was mistaken for its corner gained energy without a warning.
#[test]
fn energy_from_nowhere_is_told_and_that_of_a_pull_is_not() {
    let lattice = "scene = 1\nstart = \"as given\"\nsteps = 300\nwant = [\"trajectories\"]\n[effects]\n\
                   gravity = [0.0, 0.0, -9.81]\nfloor = 0.0\nbounce = 0.5\n\
                   [[bodies]]\nshape = \"lattice\"\ncount = [3, 3, 4]\nradius = 0.5\nat = [0.5, 0.5, 0.5]\n";
    let of = |scene: &Scene| {
        let results = results(scene);
        (results.summary.balance.unwrap(), results.text())
    };
    let (balance, text) = of(&Scene::parse("test", lattice).unwrap());
    println!("corner for middle: {balance:?}");
    assert!(balance.excess().unwrap() > 100.0, "{balance:?}");
    assert!(
        text.contains("Warning: energy rose from ") && text.contains("of which pulls account for 0.0000"),
        "{text}"
    );
    // No other scene gains energy: the lattice placed by its middle, every example, and an elastic gas in a field.
    let well = lattice.replace("0.5, 0.5, 0.5]", "0.5, 0.5, 2.0]").replace("start = \"as given\"\n", "");
    let gas = "scene = 1\nsteps = 3000\nwant = [\"trajectories\"]\n[effects]\nbounce = 1.0\ngravity = [0.0, 0.0, -9.81]\n\
               walls = [[-2.0, -2.0, -2.0], [2.0, 2.0, 2.0]]\ntime_step\n\
               [[bodies]]\nshape = \"lattice\"\ncount = [4, 4, 4]\nradius = 0.2\ngap = 0.3\nat = [0.1, 0.2, 0.0]\nvelocity = [1.0, 0.5, -2.0]\n";
    let gas = gas.replace("time_step\n", "").replace("steps = 3000", "steps = 3000\ntime_step = 0.001");
    let mut scenes = vec![Scene::parse("test", &well).unwrap(), Scene::parse("test", &gas).unwrap()];
    scenes.extend(["diamond", "billiards", "column", "gas"].map(scene));
    for scene in &scenes {
        let (balance, text) = of(scene);
        println!("{}: {balance:?}", scene.name.value);
        assert!(balance.excess().is_none() && !text.contains("Warning"), "{}: {balance:?}", scene.name.value);
    }
    // The pull's work is energy that the scene asks for. All of it stays if nothing dissipates energy.
    let pull = "scene = 1\nsteps = 100\nwant = [\"trajectories\"]\n[effects]\npull = { strength = 3.0 }\n\
                [[bodies]]\nshape = \"stack\"\ncount = 1\nat = [9.0, 2.0, 0.0]\nvelocity = [0.3, 0.1, 0.2]\n";
    let (balance, _) = of(&Scene::parse("test", pull).unwrap());
    let gain = balance.end - balance.start;
    assert!(gain > 1.0 && (balance.work - gain).abs() < 1e-9 * gain, "{balance:?}");
}
