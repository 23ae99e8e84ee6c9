//! An interrupted study of `afu accuracy` resumes, and its results equal those of an uninterrupted one.

use contact_afu::accuracy::trade::{Named, Plan, Size, Study, Work, run};
use contact_afu::accuracy::{Contenders, Profiled, measure};
use contact_afu::config::{Config, Profile, RecordFormat, Shell};
use contact_afu::pairs::Set;
use contact_afu::query::Query;
use contact_afu::store::Store;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// One arithmetic with both kinds of records, without synthesis.
fn plan() -> Plan {
    let link = "harp1".parse().expect("a link");
    let mut plan = Size::Quick.plan(link, "harp1", 1, 1);
    let profile: Profile = "e8f3z".parse().expect("a profile");
    let config =
        |record| Config { scpus: 1, shell: Shell::Line, profile: profile.clone(), record, ..Config::default() };
    plan.choices = vec![("a", config(RecordFormat::F32)), ("b", config(RecordFormat::F16))];
    let named = |set: Set| Named { name: set.to_string(), is_scene: true, pairs: set.pairs(1) };
    plan.sets = vec![named(Set::Diamond(4)), named(Set::Dense(500))];
    plan.synthesis = false;
    plan
}

/// Runs the study in a folder and stops it after `stop_after` pieces of work. Returns also how many cosims it started.
fn study(folder: &Path, stop_after: usize) -> (Option<Study>, usize) {
    let (mut done, mut begun, mut configurations) = (0, 0, 0);
    let (mut planned, mut worked) = (0.0, 0.0);
    let ran = catch_unwind(AssertUnwindSafe(|| {
        run(&plan(), Some((folder, false)), |work| match work {
            Work::Begun(what) => {
                begun += usize::from(what.ends_with(": cosim"));
                assert!(worked < planned, "the bar is full while there is work: {what}");
            }
            Work::Done(_) if done == stop_after => panic!("pulled the plug"),
            Work::Done(seconds) => (done, worked) = (done + 1, worked + seconds),
            Work::Planned(seconds) => planned += seconds,
            Work::Configuration(line) => {
                configurations += 1;
                assert!(line.starts_with("e8f3z") && line.contains(" cycles, line in to line out"), "{line}");
            }
        })
        .expect("a study that ends")
    }));
    if ran.is_ok() {
        assert!((worked - planned).abs() < 1e-3, "what was planned was done: {planned}, {worked}");
        assert_eq!(configurations, 2);
    }
    (ran.ok(), begun)
}

/// The results without times measured on this machine.
fn figures(mut results: Study) -> Study {
    results.kernels.clear();
    results.points.iter_mut().for_each(|point| point.software_ns = None);
    results
}

#[test]
fn an_interrupted_study_goes_on_and_comes_to_the_same() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let [whole, parts] = ["whole", "parts"].map(|name| room.path().join(name));
    let (undisturbed, begun) = study(&whole, usize::MAX);
    let undisturbed = figures(undisturbed.expect("nothing stopped it"));
    assert_eq!(begun, 2);

    // The study stops after both sets and the first configuration, whose cycles are stored. A worker may have started
    // the second one.
    let (stopped, _) = study(&parts, 2);
    assert!(stopped.is_none(), "it was stopped");
    let store = Store::open(&parts.join("measurements"));
    let of = |kind: &str| store.list().expect("read").into_iter().filter(|key| key.kind() == kind).collect::<Vec<_>>();
    let kept = of("cycles/1").len();
    assert!(of("errors/1").len() == 4 && kept > 0, "{kept}");

    let (resumed, begun) = study(&parts, usize::MAX);
    assert_eq!(begun, 2 - kept, "what is kept is not simulated again");
    assert_eq!(figures(resumed.expect("nothing stopped it")), undisturbed);

    // Stored results are used as they are: no row is measured again either.
    for key in of("errors/1") {
        let mut judged: serde_json::Value = store.get(&key).expect("read").expect("there");
        judged["tally"]["missed"] = 4711.into();
        store.put(&key, &judged).expect("kept");
    }
    let (resumed, _) = study(&parts, usize::MAX);
    assert_eq!(resumed.expect("nothing stopped it").points[0].rows[0].tally.missed, 4711);

    let [f32, f16] = [0, 1].map(|i| &undisturbed.points[i]);
    assert_eq!((f32.name.as_str(), f16.name.as_str()), ("e8f3z", "e8f3z record f16"));
    assert!(f16.cycles.link < 0.7 * f32.cycles.link, "a line carries more pairs: {:?} {:?}", f16.cycles, f32.cycles);
    assert!(f16.cycles.link_limit < 0.55 * f32.cycles.link_limit);
}

/// Errors over f16 records are relative to the original pair, so they include the rounding of its words.
#[test]
fn a_record_s_rounding_is_part_of_the_error() {
    let configs = [("wide", RecordFormat::F32), ("wide", RecordFormat::F16), ("half", RecordFormat::F16)];
    let mut contenders = Contenders::new();
    for (profile, record) in configs {
        contenders.push(Box::new(Profiled::of(&Config {
            profile: profile.parse().expect("a profile"),
            record,
            ..Config::default()
        })));
    }
    let dense = Set::Dense(500).pairs(1);
    let (rows, _) = measure(
        Query::SphereSphere,
        "dense",
        &dense,
        &mut contenders,
        &Store::temporary().expect("a temporary folder"),
        |_| {},
    )
    .expect("answers");
    let [wide, rounded, half] = [0, 1, 2].map(|i| rows[i].errors.contact.mean);
    assert!(rounded > 1000.0 * wide, "f16 costs what it costs: {rounded:e} {wide:e}");
    assert!(half > rounded, "and computing in it costs more: {half:e} {rounded:e}");
    assert_eq!(rows[1].contender, "wide record f16");
}
