//! Spheres behind AXI4: every hit in its order over every link, the same bytes as the AFU in software, aborts and
//! resets at any time, and faults planted in what a job of spheres has beyond one of pairs.

use std::cell::RefCell;
use std::sync::LazyLock;

use contact_afu::afu::JobError;
use contact_afu::afu::shell::axi::map;
use contact_afu::config::{Config, Input, Results, Search, Shell};
use contact_afu::cosim::axi::Machine;
use contact_afu::cosim::{Instance, Model, Source, Trace};
use contact_afu::host::{Done, Expected, Hardware, HostError, Loaded, Session, Software, SpheresJob};
use contact_afu::host::{SpheresResults, Transaction, Transport, Workspace};
use contact_afu::link::axi::Handshake;
use contact_afu::link::{Line, LinkModel};
use contact_afu::query::Fields;
use contact_afu::record::SetTooLarge;
use contact_afu::spheres::{self, Sphere, SphereSet, Spheres, hilbert_order, reorder};
use contact_afu::verify::{Bench, VerifyError};

use crate::bench::{self, files, machine};
use crate::hardware::{BUFFER, Board};

const TABLE: u32 = 512;
/// Contacts that the destination has room for.
const ROOM: u64 = 4096;

fn config() -> Config {
    Config {
        input: Input::Spheres,
        results: Results::Hits,
        contact: Fields::HIT,
        shell: Shell::Axi,
        search: Search { table: TABLE, lanes: 16, deciders: 2, box_bits: 24 },
        bus: 128,
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
    Workspace::for_spheres(expected().layout, [u64::from(TABLE), 700], ROOM).unwrap()
}

fn session<'a>(afu: &'a Instance, link: &str, seed: u64) -> Session<Machine<'a>> {
    Session::new(machine(afu, link, Handshake::Free, seed), workspace(), expected())
}

fn software() -> Session<Software> {
    Session::new(Software::new(&config(), LinkModel::ideal()).unwrap(), workspace(), expected())
}

fn set(name: &str) -> Spheres {
    name.parse::<SphereSet>().unwrap().spheres(3)
}

/// Spheres in one place: every two touch.
fn crowd(count: usize) -> Vec<Sphere> {
    vec![Sphere::new([1.0, 2.0, 3.0, 0.5]); count]
}

/// Sets of every kind: one and two, with spheres that are none, crowded, and empty.
fn sets() -> Vec<Spheres> {
    let mut odd = set("gas:300:0.4");
    for (place, sphere) in [(2, [f32::NAN, 0.0, 0.0, 1.0]), (17, [0.0; 4]), (290, [0.0, 0.0, 0.0, -1.0])] {
        odd.first[place] = Sphere::new(sphere);
    }
    let two = |first: usize, second: usize| Spheres { first: crowd(first), second: Some(crowd(second)) };
    let one = |count: usize| Spheres { first: crowd(count), second: None };
    vec![set("diamond:4"), set("probes:90:300"), odd, one(40), two(17, 33), one(0), two(0, 20), two(16, 0), one(1)]
}

/// What the search in software finds.
fn found(sets: &Spheres) -> spheres::Found {
    let search = spheres::Search::new(config().profile.arithmetic(), config().search.box_bits).unwrap();
    let mut reference = config().profile.reference(Fields::HIT);
    search.find(&mut reference, &sets.first, sets.second.as_deref()).unwrap()
}

#[track_caller]
fn check(results: &SpheresResults, sets: &Spheres, what: &str) {
    let found = found(sets);
    let hits: Vec<_> = found.hits.iter().map(|hit| hit.spheres).collect();
    assert!(results.hits == hits, "{what}: {} hits, not {}", results.hits.len(), hits.len());
    let counts = (u64::from(results.candidates), u64::from(results.invalid));
    assert_eq!(counts, (found.counts.candidates, found.counts.invalid), "{what}");
    assert_eq!(results.first_invalid.is_some(), results.invalid > 0, "{what}");
}

fn end<T: Transport>(
    loaded: Transaction<'_, T, Loaded<SpheresJob>>,
) -> Result<Transaction<'_, T, Done<SpheresJob>>, HostError> {
    loaded.start()?.confirm()?.wait()
}

#[test]
fn every_link_gives_every_hit_in_order() {
    let sort = |set: &[Sphere]| reorder(set, &hilbert_order(set));
    let diamond = Spheres { first: sort(&set("diamond:7").first), second: None };
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        for spheres in [&diamond, &set("probes:300:400")] {
            let verdict = shared().run_spheres(spheres, &link.parse().unwrap(), seed, None).unwrap();
            assert!(verdict.is_good() && !verdict.hits.is_empty(), "{link}: {:?}", verdict.failed_checks);
        }
    }
}

/// What a host reads after a job, without cycle counts, which the software does not have.
fn registers<T: Transport>(device: &mut T) -> Vec<(&'static str, u32)> {
    let counts = ["cycles_busy", "cycles_input", "cycles_output", "first_read", "first_write"];
    let mut read = Vec::new();
    for register in map::registers(Input::Spheres).filter(|register| !counts.contains(&register.name)) {
        for word in 0..register.words {
            read.push((register.name, device.read_csr(register.offset + 4 * word).unwrap()));
        }
    }
    read
}

fn destination<T: Transport>(device: &T) -> Vec<Option<Line>> {
    let first = workspace().destination() / 64;
    (first..first + ROOM / 16).map(|line| device.line(line)).collect()
}

/// Jobs one after another, the last ones against the table that stays: every register and every byte of both devices is
/// the same, and the hits are those of the search.
#[test]
fn software_and_verilog_write_the_same() {
    let (before, probes) = (set("probes:200:300"), set("probes:650:1").second.unwrap());
    for (link, seed) in [("ideal", 3), ("hostile", 4)] {
        let afu = shared().model().instance(seed).unwrap();
        let (mut hardware, mut software) = (session(&afu, link, seed), software());
        let (mut one, other) = (hardware.transaction().send_spheres(&before).unwrap(), software.transaction());
        let mut other = other.send_spheres(&before).unwrap();
        let mut sent = before.clone();
        for next in sets().into_iter().map(Some).chain([None, None]) {
            let what = format!("{link}, {} spheres, {:?} more", sent.first.len(), sent.second.as_ref().map(Vec::len));
            let mut done = end(one).unwrap_or_else(|e| panic!("{what}: {e}"));
            let mut done_too = end(other).unwrap();
            assert_eq!(registers(done.transport_mut()), registers(done_too.transport_mut()), "{what}");
            let [lines, lines_too] = [destination(done.transport()), destination(done_too.transport())];
            assert!(lines == lines_too && lines.iter().flatten().count() < lines.len(), "{what}");
            let (got, got_too) = (done.retrieve().unwrap(), done_too.retrieve().unwrap());
            assert_eq!(got.results().hits, got_too.results().hits, "{what}");
            assert_eq!(got.results().first_invalid, got_too.results().first_invalid, "{what}");
            check(got.results(), &sent, &what);
            (one, other) = match &next {
                Some(sets) => (got.send_next_spheres(sets).unwrap(), got_too.send_next_spheres(sets).unwrap()),
                None => (got.send_against(&probes).unwrap(), got_too.send_against(&probes).unwrap()),
            };
            sent = next.unwrap_or(Spheres { first: sent.first, second: Some(probes.clone()) });
        }
    }
}

/// What happens to a short job.
#[derive(Clone, Copy, Debug, PartialEq)]
enum How {
    Abort,
    Gone,
    SystemReset,
}

#[test]
fn a_job_may_be_stopped_at_every_cycle() {
    let spoilt = Spheres { first: crowd(20), second: Some(crowd(18)) };
    let next = set("diamond:3");
    for how in [How::Abort, How::Gone, How::SystemReset] {
        let afu = shared().model().instance(7).unwrap();
        let mut session = session(&afu, "late", 7);
        session.transport_mut().hesitates = false;
        let mut aborted = 0;
        for moment in 0.. {
            // The other two ways are tried at fewer moments.
            if how != How::Abort && moment % 4 != 0 {
                continue;
            }
            let what = format!("{how:?} after {moment} cycles");
            let loaded = session.transaction().send_spheres(&spoilt).unwrap();
            let mut running = loaded.start().unwrap().confirm().unwrap();
            running.idle(moment).unwrap_or_else(|e| panic!("{what}: {e}"));
            let done = running.is_done();
            match how {
                How::Abort if !done => {
                    running.abort().unwrap();
                    let ended = running.wait().unwrap_or_else(|e| panic!("{what}: {e}"));
                    let outcome = ended.outcome();
                    if outcome.error == 1 {
                        let error = ended.retrieve().unwrap_err();
                        assert!(matches!(error, HostError::Job { code: 1, .. }), "{what}: {error}");
                        aborted += 1;
                    } else {
                        check(ended.retrieve().unwrap().results(), &spoilt, &what);
                    }
                }
                How::SystemReset => {
                    running.transport_mut().system_reset().unwrap_or_else(|e| panic!("{what}: {e}"));
                    std::mem::forget(running);
                }
                _ => std::mem::forget(running),
            }
            check(&session.find(&next).unwrap_or_else(|e| panic!("{what}: {e}")), &next, &what);
            if done {
                assert!(moment > 200 && (aborted > 200 || how != How::Abort), "{what}: {aborted} aborted");
                break;
            }
        }
    }
}

/// What cannot be a job is refused in one line: by the host, or by the AFU with an error and its advice.
#[test]
fn what_is_no_job_is_refused() {
    let afu = shared().model().instance(5).unwrap();
    let mut session = session(&afu, "ideal", 5);
    let large = Spheres { first: crowd(513), second: None };
    let error = session.find(&large).unwrap_err();
    assert_eq!(error, HostError::Set(SetTooLarge::First { spheres: 513, table: TABLE }));
    let long = Spheres { first: crowd(512), second: Some(crowd(800)) };
    let error = session.find(&long).unwrap_err().to_string();
    assert!(error.contains("take 328 lines, and the source has 304"), "{error}");
    let error = session.transaction().send(&[Default::default()]).unwrap_err().to_string();
    assert!(error.starts_with("this AFU takes spheres, not pairs") && error.contains("--input direct"), "{error}");
    // More contacts than there is room for: all are counted.
    let many = Spheres { first: crowd(100), second: None };
    let done = end(session.transaction().send_spheres(&many).unwrap()).unwrap();
    let outcome = done.outcome();
    let code = JobError::Overflow.code();
    assert_eq!((outcome.error, outcome.contacts, outcome.lines.len()), (code, 4950, ROOM as usize / 16));
    let error = done.retrieve().unwrap_err().to_string();
    assert!(error.contains("give the destination more lines"), "{error}");
    // Registers that no host of ours writes so.
    let machine = session.transport_mut();
    let mut job = |count: u32, others: u32, mode: u32| {
        for (register, value) in [(map::COUNT, count), (map::OTHERS, others), (map::MODE, mode)] {
            machine.write_register(register.offset, value).unwrap();
        }
        machine.write_register(map::CONTROL.offset, map::START.put(1)).unwrap();
        while map::ENDED.get(machine.read_register(map::STATUS.offset).unwrap()) == 0 {}
        map::ERROR.get(machine.read_register(map::STATUS.offset).unwrap()) as u8
    };
    let [mode, table] = [JobError::Mode, JobError::Table].map(JobError::code);
    let ended = [(0, 0, 3), (0, 0, 1 << 31), (0, 0, 1 << 4), (513, 0, 0), (0, 65_537, 1), (1 << 31, 0, 2)];
    assert_eq!(ended.map(|(count, others, what)| job(count, others, what)), [mode, mode, mode, table, table, 0]);
    // An AFU of pairs takes no spheres.
    let of_pairs = bench::config(1, 128);
    let layout = Expected::edited(&of_pairs).layout;
    let mut pairs = Session::new(
        Software::new(&of_pairs, LinkModel::ideal()).unwrap(),
        Workspace::contiguous(layout, 10).unwrap(),
        Expected::new(&of_pairs).unwrap(),
    );
    let error = pairs.find(&many).unwrap_err().to_string();
    assert!(error.starts_with("this AFU takes pairs, not spheres") && error.contains("--input spheres"), "{error}");
}

/// A driver of six methods takes spheres as it takes pairs.
#[test]
fn a_board_takes_spheres() {
    let afu = shared().model().instance(3).unwrap();
    let board = Board { machine: RefCell::new(machine(&afu, "hostile", Handshake::Free, 3)), waits: 0, is_gone: false };
    let workspace = Workspace::in_buffer(expected().layout, BUFFER).unwrap();
    let mut session = Session::new(Hardware::new(board, LinkModel::hostile(), 200.0), workspace, expected());
    for sets in sets() {
        let results = session.find(&sets).unwrap();
        check(&results, &sets, "a board");
        let named = results.strict(&sets).map_err(|error| error.to_string());
        let error = "2 invalid spheres; the x of the first, sphere 2, is NaN, infinite or a negative radius: correct it or \
                     leave it out";
        assert_eq!(named, if results.invalid == 0 { Ok(()) } else { Err(error.to_owned()) });
    }
    assert_eq!(session.reports().iter().map(|report| report.spheres).max(), Some(390));
}

/// File, what stands before the text, the text, what stands there instead, what comes of it.
const FAULTS: [(&str, &str, &str, &str, &str); 4] = [
    ("axi_control.v", "assign mode = ", "mode_2[3:0] | {4{|mode_2[31:4]}}", "4'd0", "wrong"),
    ("contact_afu_axi.v", ".others ", "control_others", "32'd16", "wrong"),
    ("axi_control.v", "(read_word == 10'd42) ? ", "core_candidates", "core_contacts", "wrong"),
    (
        "contact_afu_axi.v",
        ".destination_lines ",
        "control_destination_lines",
        "32'hffffffff",
        "outside the destination",
    ),
];

/// The Verilog with all faults. The number of a fault, from 1, in the scratch register chooses it.
fn spoilt() -> Model {
    let mut files = files(&config());
    for (number, (name, before, right, wrong, _)) in (1..).zip(FAULTS) {
        let file = files.iter_mut().find(|file| file.name == name).unwrap();
        let (start, rest) = file.text.rsplit_once(before).unwrap_or_else(|| panic!("{name}: {before}"));
        let scratch = if name == "axi_control.v" { "scratch" } else { "contact_afu_axi.control.scratch" };
        let chosen = format!("(({scratch} == 32'd{number}) ? ({wrong}) : ({right}))");
        assert!(rest.contains(right), "{name}: {right}");
        file.text = format!("{start}{before}{}", rest.replacen(right, &chosen, 1));
    }
    Model::build(&Source::new("contact_afu_axi", files), Trace::Off).unwrap()
}

#[test]
fn planted_faults_are_found() {
    let model = spoilt();
    let (probes, many) = (set("probes:90:300"), Spheres { first: crowd(100), second: None });
    for (fault, expected) in (0..).zip(["right"].into_iter().chain(FAULTS.map(|(.., expected)| expected))) {
        let afu = model.instance(1).unwrap();
        let mut session = session(&afu, "ideal", 1);
        session.transport_mut().write_register(map::SCRATCH.offset, fault).unwrap();
        session.max_cycles = Some(100_000);
        let results = session.find(&probes).unwrap();
        let hits: Vec<_> = found(&probes).hits.iter().map(|hit| hit.spheres).collect();
        let candidates = found(&probes).counts.candidates;
        let is_right = results.hits == hits && u64::from(results.candidates) == candidates;
        // There is no room for these.
        let overflow = session.find(&many).unwrap_err();
        // `afu cosim` counts a broken rule as a job that failed.
        let is_broken = matches!(overflow, HostError::Transport(_));
        assert_eq!(VerifyError::from(overflow.clone()).is_job_failure(), is_broken, "fault {fault}: {overflow}");
        let said = format!("{}, {overflow}", if is_right { "right" } else { "wrong" });
        assert!(said.contains(expected), "fault {fault}: expected `{expected}`, found `{said}`");
    }
}
