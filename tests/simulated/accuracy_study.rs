//! An interrupted study of `afu accuracy` resumes, and its results equal those of an uninterrupted one.

use contact_afu::accuracy::trade::{Ended, Named, Plan, Request, Size, run};
use contact_afu::accuracy::{Contenders, Profiled, measure};
use contact_afu::config::{Config, Profile, RecordFormat, Shell};
use contact_afu::pairs::Set;
use contact_afu::query::Query;
use contact_afu::store::Store;
use contact_afu::study::{News, Role, Shard, Worker};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::Duration;

/// One arithmetic with both kinds of records, without synthesis and without times of this machine.
fn plan() -> Plan {
    let mut plan = Request::new(Size::Quick, "harp1", 1).plan().expect("a link");
    let profile: Profile = "e8f3z".parse().expect("a profile");
    let config =
        |record| Config { scpus: 1, shell: Shell::Line, profile: profile.clone(), record, ..Config::default() };
    plan.choices = vec![("a", config(RecordFormat::F32)), ("b", config(RecordFormat::F16))];
    let named = |set: Set| Named { name: set.to_string(), is_scene: true, pairs: set.pairs(1) };
    plan.sets = vec![named(Set::Diamond(4)), named(Set::Dense(500))];
    plan.software = false;
    plan
}

/// Works on the study in a store and stops it after `stop_after` points. Returns also the points that it measured.
fn study(store: &Path, worker: &mut Worker, stop_after: usize) -> (Option<Ended>, Vec<String>) {
    let mut measured = Vec::new();
    let ran = catch_unwind(AssertUnwindSafe(|| {
        run(&plan(), &Store::open(store), worker, |news| {
            if let News::Ended(point, failed, _) = news {
                assert!(failed.is_none(), "{failed:?}");
                measured.push(point.title.clone());
                assert!(measured.len() < stop_after, "pulled the plug");
            }
        })
        .expect("a study that ends")
    }));
    (ran.ok(), measured)
}

fn whole() -> Worker {
    Worker::new(Role::Whole).with_lease(Duration::from_millis(500))
}

#[test]
fn an_interrupted_study_goes_on_and_comes_to_the_same() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let [whole_store, parts, shards] = ["whole", "parts", "shards"].map(|name| room.path().join(name));
    let (undisturbed, measured) = study(&whole_store, &mut whole(), usize::MAX);
    let undisturbed = undisturbed.expect("nothing stopped it");
    assert!(!undisturbed.is_waiting);
    let undisturbed = undisturbed.results;
    let of = |kind: &str| measured.iter().filter(|title| title.starts_with(kind)).count();
    assert_eq!((of("errors of "), of("cycles of ")), (4, 2), "{measured:?}");

    // The study stops after both sets and the first configuration, whose cycles are stored. A worker may have started
    // the second one.
    let (stopped, _) = study(&parts, &mut whole(), 5);
    assert!(stopped.is_none(), "it was stopped");
    let store = Store::open(&parts);
    let of = |kind: &str| store.list().expect("read").into_iter().filter(|key| key.kind() == kind).collect::<Vec<_>>();
    let kept = of("cycles/1").len();
    assert!(of("errors/1").len() == 4 && kept > 0, "{kept}");

    let (resumed, measured) = study(&parts, &mut whole(), usize::MAX);
    let simulated = measured.iter().filter(|title| title.starts_with("cycles of ")).count();
    assert_eq!(simulated, 2 - kept, "what is kept is not simulated again");
    assert_eq!(resumed.expect("nothing stopped it").results, undisturbed);

    // By shards, one after the other: the first cannot know what follows before the others have measured theirs.
    let shard = |index| Role::Part(Shard::new(index, 2).expect("a shard"));
    let mut by_shards = Vec::new();
    for (index, waits) in [(1, true), (2, false), (1, false)] {
        let mut worker = Worker::new(shard(index)).with_lease(Duration::from_millis(500));
        let (ended, measured) = study(&shards, &mut worker, usize::MAX);
        assert_eq!(ended.expect("nothing stopped it").is_waiting, waits, "shard {index}: {measured:?}");
        by_shards.extend(measured);
    }
    let mut reader = Worker::new(Role::Reader);
    let (merged, measured) = study(&shards, &mut reader, usize::MAX);
    assert_eq!(merged.expect("nothing stopped it").results, undisturbed);
    assert!(measured.is_empty() && !reader.is_missing_any(), "a reader measures nothing");
    let count = by_shards.len();
    by_shards.sort();
    by_shards.dedup();
    assert_eq!(count, by_shards.len(), "each point was measured by one of them");

    // Stored results are used as they are: no row is measured again either.
    for key in of("errors/1") {
        let mut judged: serde_json::Value = store.get(&key).expect("read").expect("there");
        judged["tally"]["missed"] = 4711.into();
        store.put(&key, &judged).expect("kept");
    }
    let (resumed, _) = study(&parts, &mut whole(), usize::MAX);
    assert_eq!(resumed.expect("nothing stopped it").results.points[0].rows[0].tally.missed, 4711);

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
