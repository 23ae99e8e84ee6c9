//! The paper's benchmark: the recording, the counted pairs, and the measured times.

use contact_afu::kernel::Reference;
use contact_afu::number::Format;
use contact_afu::ode::{Benchmark, Collider, Diamond, Error, Ode};
use contact_afu::query::{Fields, Flow};

/// In the diamond of hMax 3, 36 pairs touch and 96 more are near.
#[test]
fn collisions_are_those_of_the_steps_in_order_and_of_runs_begun_anew() {
    let ode = Ode::start(Collider::Own).unwrap();
    let recording = Benchmark { steps_of_a_run: 2, ..Benchmark::paper(100) }.run(&ode).unwrap();
    assert_eq!((recording.collisions.len(), recording.steps), (100, 2));
    let spheres: Vec<_> = recording.collisions.iter().map(|collision| collision.spheres).collect();
    assert_eq!(spheres[72..], spheres[..28], "the third step is the first of a new run");
    assert_ne!(spheres[36..72], spheres[..36], "the second is not");
    let one_run = Benchmark::paper(100).run(&ode).unwrap();
    assert_ne!(one_run.collisions[72].spheres, spheres[72]);
    assert!(recording.collisions.iter().all(|collision| collision.nanoseconds > 0.0));
}

#[test]
fn only_the_kind_that_is_asked_for_counts() {
    let ode = Ode::start(Collider::Own).unwrap();
    let reference = Reference::new(Format::BINARY32, Fields::ALL);
    for (flow, gap, count) in [(Flow::Fake, 0.0, 96), (Flow::Real, 0.0, 36), (Flow::Coincident, -1.0, 300)] {
        let recording = Benchmark { diamond: Diamond::new(3, gap), flow, ..Benchmark::paper(count) }.run(&ode).unwrap();
        assert_eq!(recording.steps, 0, "{flow}: the first step has as many");
        let pairs = recording.pairs(count);
        assert!(pairs.len() == count && pairs.iter().all(|pair| reference.run(pair).flow() == Some(flow)), "{flow}");
    }
    let none = Benchmark { flow: Flow::Coincident, most_steps: 50, ..Benchmark::paper(1) }.run(&ode).unwrap_err();
    assert!(matches!(none, Error::TooFew { flow: Flow::Coincident, found: 0, wanted: 1, steps: 50 }), "{none}");
    assert!(matches!(Benchmark { flow: Flow::Invalid, ..Benchmark::paper(1) }.run(&ode), Err(Error::Flow(_))));
}

/// More collisions take longer, and parts of the work take less than the whole.
#[test]
fn figures_grow_with_the_collisions() {
    let ode = Ode::start(Collider::Own).unwrap();
    let recording = Benchmark::paper(2000).run(&ode).unwrap();
    let [few, many] = [200, 2000].map(|count| recording.figures(&ode, count, 5).unwrap());
    assert_eq!((few.collisions, many.collisions), (200, 2000));
    assert!(few.rule_ns < many.rule_ns && few.calls.least_ns * 4.0 < many.calls.least_ns, "{few:?} {many:?}");
    assert!(few.kernel.least_ns * 2.0 < many.kernel.least_ns && many.kernel.least_ns < many.calls.least_ns);
    assert_eq!(recording.figures(&ode, 5000, 1).unwrap().collisions, 2000, "no more than there are");
}
