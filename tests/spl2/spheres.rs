//! Spheres below SPL2: every hit in its order over every link, the same bytes as the AFU in software, aborts and
//! resets, and buffers that are too short.

use std::sync::LazyLock;

use contact_afu::afu::JobError;
use contact_afu::afu::shell::spl2::map::control;
use contact_afu::config::{Config, Input, Results, Search, Shell};
use contact_afu::cosim::Instance;
use contact_afu::cosim::spl2::Machine;
use contact_afu::host::{Done, Expected, HostError, Loaded, Session, Software, SpheresJob};
use contact_afu::host::{SpheresResults, Transaction, Transport, Workspace};
use contact_afu::link::spl2::PAGE_LINES;
use contact_afu::link::{Line, LinkModel};
use contact_afu::query::Fields;
use contact_afu::spheres::{self, Sphere, SphereSet, Spheres};
use contact_afu::verify::Bench;

use crate::bench::{machine, rough};

const TABLE: u32 = 512;
const ROOM: u64 = 2048;

fn config() -> Config {
    Config {
        input: Input::Spheres,
        results: Results::Hits,
        contact: Fields::HIT,
        shell: Shell::Spl2,
        search: Search { table: TABLE, lanes: 16, deciders: 2, box_bits: 24 },
        ..Config::default()
    }
}

fn shared() -> &'static Bench {
    static BENCH: LazyLock<Bench> = LazyLock::new(|| Bench::new(&config()).unwrap());
    &BENCH
}

fn expected() -> Expected {
    static EXPECTED: LazyLock<Expected> = LazyLock::new(|| Expected::new(&config()).unwrap());
    *EXPECTED
}

fn workspace() -> Workspace {
    Workspace::for_spheres_below_spl2(expected().layout, [u64::from(TABLE), 700], ROOM, 7).unwrap()
}

/// Another place for the buffers.
fn elsewhere() -> Workspace {
    let workspace = Workspace::new(expected().layout, 3, 7).unwrap();
    workspace.with_buffers(PAGE_LINES + 2, 2 * PAGE_LINES - 9, 400).unwrap()
}

fn session<'a>(afu: &'a Instance, link: &str, seed: u64) -> Session<Machine<'a>> {
    Session::new(machine(afu, rough(), link, seed), workspace(), expected())
}

fn set(name: &str) -> Spheres {
    name.parse::<SphereSet>().unwrap().spheres(3)
}

fn crowd(count: usize) -> Vec<Sphere> {
    vec![Sphere::new([1.0, 2.0, 3.0, 0.5]); count]
}

#[track_caller]
fn check(results: &SpheresResults, sets: &Spheres, what: &str) {
    let search = spheres::Search::new(config().profile.arithmetic(), config().search.box_bits).unwrap();
    let mut reference = config().profile.reference(Fields::HIT);
    let found = search.find(&mut reference, &sets.first, sets.second.as_deref()).unwrap();
    let hits: Vec<_> = found.hits.iter().map(|hit| hit.spheres).collect();
    assert!(results.hits == hits, "{what}: {} hits, not {}", results.hits.len(), hits.len());
    let counts = (u64::from(results.candidates), u64::from(results.invalid));
    assert_eq!(counts, (found.counts.candidates, found.counts.invalid), "{what}");
}

fn end<T: Transport>(
    loaded: Transaction<'_, T, Loaded<SpheresJob>>,
) -> Result<Transaction<'_, T, Done<SpheresJob>>, HostError> {
    loaded.start()?.confirm()?.wait()
}

#[test]
fn every_link_gives_every_hit_in_order() {
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        for spheres in [&set("diamond:6"), &set("probes:200:300")] {
            let verdict = shared().run_spheres(spheres, &link.parse().unwrap(), seed, None).unwrap();
            assert!(verdict.is_good() && !verdict.hits.is_empty(), "{link}: {:?}", verdict.failed_checks);
        }
    }
}

/// The lines that the AFU writes into the workspace: status and results.
fn written<T: Transport>(device: &T) -> Vec<Option<Line>> {
    let workspace = workspace();
    let status = workspace.context() + 64;
    let results = (0..ROOM / 16).map(|line| workspace.destination() + 64 * line);
    [status].into_iter().chain(results).map(|at| device.line(workspace.physical(at).unwrap())).collect()
}

#[test]
fn software_and_verilog_write_the_same() {
    let mut odd = set("gas:100:0.4");
    odd.first[17] = Sphere::new([0.0, 0.0, f32::INFINITY, 1.0]);
    let two = |first: usize, second: usize| Spheres { first: crowd(first), second: Some(crowd(second)) };
    let sets = [set("probes:90:300"), odd, two(17, 33), Spheres::default(), two(0, 20), two(16, 0)];
    let probes = set("probes:650:1").second.unwrap();
    let afu = shared().model().instance(3).unwrap();
    let mut hardware = session(&afu, "hostile", 3);
    let software = Software::new(&config(), LinkModel::ideal()).unwrap();
    let mut software = Session::new(software, workspace(), expected());
    let mut sent = set("probes:200:300");
    let mut one = hardware.transaction().send_spheres(&sent).unwrap();
    let mut other = software.transaction().send_spheres(&sent).unwrap();
    for next in sets.into_iter().map(Some).chain([None, None]) {
        let what = format!("{} spheres, {:?} more", sent.first.len(), sent.second.as_ref().map(Vec::len));
        let done = end(one).unwrap_or_else(|e| panic!("{what}: {e}"));
        let done_too = end(other).unwrap();
        assert_eq!(written(done.transport()), written(done_too.transport()), "{what}");
        let (got, got_too) = (done.retrieve().unwrap(), done_too.retrieve().unwrap());
        check(got.results(), &sent, &what);
        (one, other) = match &next {
            Some(sets) => (got.send_next_spheres(sets).unwrap(), got_too.send_next_spheres(sets).unwrap()),
            None => (got.send_against(&probes).unwrap(), got_too.send_against(&probes).unwrap()),
        };
        sent = next.unwrap_or(Spheres { first: sent.first, second: Some(probes.clone()) });
    }
}

#[test]
fn a_job_may_be_stopped_at_any_time() {
    let (spoilt, next) = (Spheres { first: crowd(20), second: Some(crowd(18)) }, set("diamond:3"));
    let afu = shared().model().instance(7).unwrap();
    let mut session = session(&afu, "late", 7);
    let mut aborted = 0;
    for moment in (0..).step_by(3) {
        let what = format!("after {moment} cycles");
        let loaded = session.transaction().send_spheres(&spoilt).unwrap();
        let mut running = loaded.start().unwrap().confirm().unwrap();
        running.idle(moment).unwrap_or_else(|e| panic!("{what}: {e}"));
        let done = running.is_done();
        if !done && moment % 2 == 0 {
            running.abort().unwrap();
            let ended = running.wait().unwrap_or_else(|e| panic!("{what}: {e}"));
            match ended.outcome().error {
                1 => aborted += 1,
                _ => check(ended.retrieve().unwrap().results(), &spoilt, &what),
            }
        } else {
            // The next transaction begins with a reset, while this one's accesses are on their way.
            std::mem::forget(running);
        }
        // Late writes of the one before may still arrive.
        session.set_workspace(elsewhere());
        check(&session.find(&next).unwrap_or_else(|e| panic!("{what}: {e}")), &next, &what);
        session.set_workspace(workspace());
        if done {
            assert!(aborted > 20, "{what}: {aborted} aborted");
            break;
        }
    }
}

/// Buffers of nine lines hold the control memory and two rows. What takes more ends with error 8, whichever set it is.
#[test]
fn sets_that_do_not_fit_into_the_buffers_are_refused() {
    let afu = shared().model().instance(5).unwrap();
    let device = machine(&afu, rough(), "ideal", 5);
    let workspace = Workspace::new(expected().layout, 1, 7).unwrap().with_buffers(2, 20, 9).unwrap();
    let mut session = Session::new(device, workspace.clone(), expected());
    check(&session.find(&two_rows()).unwrap(), &two_rows(), "two rows");
    let error = session.find(&Spheres { first: crowd(32), second: Some(crowd(1)) }).unwrap_err().to_string();
    assert!(error.contains("take 12 lines, and the source has 8"), "{error}");
    // A host that does not look.
    let at = workspace.physical(workspace.source()).unwrap();
    for (mode, count, others) in [(0, 33, 0), (1, 16, 17), (1, 17, 1), (2, 0, 33), (3, 16, 17), (1, u32::MAX, u32::MAX)]
    {
        let mut started = session.transaction().send_spheres(&two_rows()).unwrap().start().unwrap();
        let mut line = started.transport().line(at).unwrap();
        for (field, value) in [(control::MODE, mode), (control::COUNT, count), (control::OTHERS, others)] {
            field.set(&mut line, value.into());
        }
        started.transport_mut().put(at, &line);
        let error = started.confirm().unwrap().wait().unwrap().retrieve().unwrap_err();
        let code = JobError::Room.code();
        let advice = "send fewer spheres, or set up longer buffers";
        assert!(
            matches!(error, HostError::Job { code: found, .. } if found == code) && error.to_string().ends_with(advice),
            "mode {mode}, {count} and {others}: {error}"
        );
    }
}

fn two_rows() -> Spheres {
    Spheres { first: crowd(16), second: Some(crowd(7)) }
}
