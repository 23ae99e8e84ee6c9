//! Workers beside each other, and beside processes that died.

use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use super::pass::CLAIM;
use super::{Failed, News, Point, PointError, Progress, Role, Shard, State, Worker};
use crate::store::{Key, Store, StoreError};

/// Short enough for a test, and far longer than a pause of a loaded machine between two signs of life.
const LEASE: Duration = Duration::from_millis(600);

#[derive(Debug, thiserror::Error)]
enum TestError {
    #[error("it is odd")]
    Odd,
    #[error("no tool")]
    Tool,
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl PointError for TestError {
    fn is_of_point(&self) -> bool {
        matches!(self, Self::Odd)
    }
}

fn points(count: u32) -> Vec<Point> {
    (0..count).map(|of| Point::new(format!("point {of}"), Key::new("square/1", &of).expect("JSON"))).collect()
}

fn squares(indices: &[usize]) -> Result<Vec<usize>, TestError> {
    Ok(indices.iter().map(|index| index * index).collect())
}

fn worker(role: Role) -> Worker {
    Worker::new(role).with_lease(LEASE)
}

fn states(worker: &Worker, of: &State) -> usize {
    worker.ledger().iter().filter(|(_, state)| state == of).count()
}

#[test]
fn shards_make_each_point_once_and_a_reader_finds_them() {
    let store = Store::temporary().expect("a temporary folder");
    let points = points(60);
    let made = AtomicUsize::new(0);
    let count = |indices: &[usize]| {
        made.fetch_add(indices.len(), Ordering::Relaxed);
        squares(indices)
    };
    thread::scope(|scope| {
        for shard in Shard::all(4) {
            let (store, points, count) = (&store, &points, &count);
            scope.spawn(move || {
                let mut worker = worker(Role::Part(shard)).with_jobs(3);
                worker.run(store, points, 1, count, |_| ()).expect("made");
            });
        }
    });
    assert_eq!(made.into_inner(), 60);
    let mut reader = worker(Role::Reader);
    let found = reader.run(&store, &points, 1, |_| Err::<Vec<usize>, _>(TestError::Tool), |_| ()).expect("read");
    assert_eq!(found, (0..60).map(|index| Some(index * index)).collect::<Vec<_>>());
    assert_eq!(states(&reader, &State::Made), 60);
    let left = |extension| store.files(extension).expect("read").len();
    assert_eq!((left("json"), left("claim"), left("failed")), (60, 0, 0));
}

/// Two processes with the same points: what one has claimed, the other waits for or leaves.
#[test]
fn two_processes_share_the_work() {
    let store = Store::temporary().expect("a temporary folder");
    let points = points(12);
    let made = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..2 {
            let (store, points, made) = (&store, &points, &made);
            scope.spawn(move || {
                let slowly = |indices: &[usize]| {
                    made.fetch_add(indices.len(), Ordering::Relaxed);
                    thread::sleep(Duration::from_millis(30));
                    squares(indices)
                };
                let found = worker(Role::Whole).run(store, points, 1, slowly, |_| ()).expect("made");
                assert!(found.iter().all(Option::is_some), "each has all at the end");
            });
        }
    });
    assert_eq!(made.into_inner(), 12);
}

#[test]
fn a_point_that_fails_is_recorded_and_tried_again_by_the_next_run() {
    let store = Store::temporary().expect("a temporary folder");
    let points = points(6);
    let fail = |indices: &[usize]| if indices[0] % 2 == 1 { Err(TestError::Odd) } else { squares(indices) };
    for attempts in 1..=2 {
        let mut first = worker(Role::Whole);
        let mut last = Progress::default();
        let found = first.run(&store, &points, 1, fail, |news| {
            if let News::Ended(_, _, progress) = news {
                last = progress;
            }
        });
        assert_eq!(found.expect("the others are made").iter().flatten().count(), 3);
        assert_eq!(states(&first, &State::Failed(Failed { error: "it is odd".to_owned(), attempts })), 3);
        assert_eq!((last.done, last.failed, last.left), (3, 3, 0));
    }
    let mut second = worker(Role::Whole);
    second.run(&store, &points, 1, squares, |_| ()).expect("made");
    assert!(
        states(&second, &State::Made) == 6 && store.files("failed").expect("read").is_empty(),
        "nothing tells of it any more"
    );
}

#[test]
fn an_error_that_others_would_meet_ends_the_run() {
    let store = Store::temporary().expect("a temporary folder");
    let ended = worker(Role::Whole).run(&store, &points(6), 1, |_| Err::<Vec<usize>, _>(TestError::Tool), |_| ());
    assert!(matches!(ended, Err(TestError::Tool)));
    assert!(store.files("failed").expect("read").is_empty() && store.files("claim").expect("read").is_empty());
}

#[test]
fn a_point_of_a_dead_process_is_taken_up_and_one_of_a_live_process_is_left() {
    let store = Store::temporary().expect("a temporary folder");
    let points = points(2);
    store.create().expect("made");
    let [dead, live] = [0, 1].map(|index| store.file(&points[index].key, CLAIM));
    fs::write(
        dead,
        "elsewhere process 1 2.3 4
",
    )
    .expect("written");
    let shard = || worker(Role::Part(Shard::new(1, 1).expect("a shard")));
    let is_over = AtomicUsize::new(0);
    thread::scope(|scope| {
        scope.spawn(|| {
            for beat in 0.. {
                fs::write(
                    &live,
                    format!(
                        "elsewhere process 5 6.7 {beat}
"
                    ),
                )
                .expect("written");
                thread::sleep(LEASE / 10);
                if is_over.load(Ordering::Relaxed) == 1 {
                    return;
                }
            }
        });
        thread::sleep(LEASE / 5);
        let mut first = shard();
        first.run(&store, &points, 1, squares, |_| ()).expect("made");
        is_over.store(1, Ordering::Relaxed);
        let state = |index: usize| &first.ledger()[index].1;
        assert_eq!((state(0), state(1)), (&State::Made, &State::Missing));
    });
    shard().run(&store, &points, 1, squares, |_| ()).expect("made");
    assert!(store.has(&points[1].key), "its process is dead by now");
}

#[test]
fn no_more_points_are_made_than_asked_for() {
    let store = Store::temporary().expect("a temporary folder");
    let mut first = worker(Role::Whole).with_limit(Some(4)).with_jobs(3);
    first.run(&store, &points(9), 1, squares, |_| ()).expect("made");
    assert_eq!((states(&first, &State::Made), states(&first, &State::Missing)), (4, 5));
    let mut second = worker(Role::Whole).with_limit(Some(4));
    second.run(&store, &points(9), 1, squares, |_| ()).expect("made");
    assert_eq!(states(&second, &State::Made), 8, "what is there does not count");
}

#[test]
fn a_shard_waits_for_others_while_they_live() {
    let store = Store::temporary().expect("a temporary folder");
    let points = points(8);
    let of = |index| worker(Role::Part(Shard::new(index, 2).expect("a shard")));
    let mut first = of(1);
    let mut found = first.run(&store, &points, 1, squares, |_| ()).expect("made");
    let of_first = found.iter().flatten().count();
    first.settle(&store, &points, &mut found).expect("read");
    assert!(found.iter().flatten().count() == of_first && first.is_missing_any(), "nobody works on the others");
    thread::scope(|scope| {
        scope.spawn(|| {
            let slowly = |indices: &[usize]| {
                thread::sleep(LEASE / 2);
                squares(indices)
            };
            of(2).run(&store, &points, 1, slowly, |_| ()).expect("made");
        });
        first.settle(&store, &points, &mut found).expect("read");
    });
    assert_eq!(found, (0..8).map(|index| Some(index * index)).collect::<Vec<_>>());
    assert!(of_first < 8 && !first.is_missing_any());
}
