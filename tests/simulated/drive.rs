//! Jobs over links, on the echo AFU: results, limits, protocol, faults, time-outs, abort and reset.

use std::path::Path;

use contact_afu::afu::JobError;
use contact_afu::cosim::drive::{DriveError, ProtocolError, Waiting};
use contact_afu::cosim::{Driver, Instance, Job, Model, Outcome, Source, Trace};
use contact_afu::link::{Fault, Line, Link, LinkModel};

fn echo_source() -> Source {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/echo");
    Source::from_folder(&folder, "contact_afu").unwrap()
}

fn echo(seed: u64) -> Instance {
    Model::build(&echo_source(), Trace::Off).unwrap().instance(seed).unwrap()
}

/// The echo AFU with one change in its Verilog.
fn broken(from: &str, to: &str) -> Instance {
    let mut files = echo_source().files().to_vec();
    let file = files.iter_mut().find(|file| file.name == "contact_afu.v").unwrap();
    assert_eq!(file.text.matches(from).count(), 1, "`{from}` is there once");
    file.text = file.text.replace(from, to);
    Model::build(&Source::new("contact_afu", files), Trace::Off).unwrap().instance(0).unwrap()
}

fn lines(count: u32) -> Vec<Line> {
    (0..count).map(|i| std::array::from_fn(|word| i << 8 | word as u32)).collect()
}

fn link(name: &str, seed: u64) -> Link {
    Link::new(name.parse().unwrap(), seed).unwrap()
}

fn run_on(afu: &Instance, link: Link, count: u32) -> Result<Outcome, DriveError> {
    let source = lines(count);
    Driver::new(afu, link)?.run(&Job::new(&source, 2 * count, count.into()))
}

fn written(outcome: &Outcome) -> Vec<Line> {
    outcome.lines.iter().map(|line| line.unwrap()).collect()
}

#[test]
fn every_link_brings_every_line() {
    for name in LinkModel::PRESETS {
        for (seed, count) in [(1, 0), (2, 1), (3, 64), (4, 65), (5, 1000)] {
            let afu = echo(seed);
            let outcome = run_on(&afu, link(name, seed), count).unwrap_or_else(|e| panic!("{name} {count}: {e}"));
            assert_eq!(written(&outcome), lines(count), "{name} {count}");
            assert_eq!((outcome.error, outcome.contacts), (0, count), "{name} {count}");
            assert_eq!((outcome.bytes_read, outcome.bytes_written), (64 * u64::from(count), 64 * u64::from(count)));
            assert_eq!(outcome.cycles_busy + 1, outcome.cycles, "the AFU counts what the driver counts but the start");
        }
    }
}

#[test]
fn the_ideal_link_is_used_every_cycle() {
    let afu = echo(0);
    let outcome = run_on(&afu, link("ideal", 0), 5000).unwrap();
    assert_eq!(outcome.limit_cycles, 5000.0);
    assert!(outcome.cycles < 5010, "{}", outcome.cycles);
    assert!(outcome.efficiency() > 0.99);
    assert_eq!(outcome.latency_cycles, Some(2), "data is stored, then sent from a register");
}

#[test]
fn the_same_seed_gives_the_same_cycles() {
    let cycles = |seed| run_on(&echo(0), link("hostile", seed), 500).unwrap().cycles;
    assert_eq!(cycles(9), cycles(9));
    assert_ne!(cycles(9), cycles(10));
}

#[test]
fn a_lost_read_is_a_time_out_that_says_so() {
    let afu = echo(0);
    let mut faulty = link("late", 0);
    faulty.plan(&[Fault::ReadLost(7)]);
    let error = run_on(&afu, faulty, 100).unwrap_err();
    let DriveError::TimedOut { waiting: Waiting::Response { is_read: true, tag, .. }, reads, .. } = error else {
        panic!("{error}");
    };
    assert_eq!(tag & 63, 7);
    assert_eq!(reads.0 - reads.1, 1);
    let text = error.to_string();
    assert!(
        text.starts_with("the job did not finish after ") && text.contains("waiting for the data of a read"),
        "{text}"
    );
}

#[test]
fn a_lost_write_is_a_time_out_that_says_so() {
    let afu = echo(0);
    let mut faulty = link("ideal", 0);
    faulty.plan(&[Fault::WriteLost(99)]);
    let error = run_on(&afu, faulty, 100).unwrap_err();
    assert!(matches!(error, DriveError::TimedOut { waiting: Waiting::Response { is_read: false, .. }, .. }), "{error}");
}

#[test]
fn the_watchdog_ends_what_would_time_out_and_the_next_job_is_right() {
    let afu = echo(0);
    let mut driver = Driver::new(&afu, link("ideal", 0)).unwrap();
    let source = lines(100);
    let job = Job { watchdog: 50, ..Job::new(&source, 200, 100) };
    driver.link_mut().plan(&[Fault::ReadLost(7)]);
    assert_eq!(driver.run(&job).unwrap().job_error(), Some(JobError::Watchdog));
    driver.link_mut().plan(&[]);
    let outcome = driver.run(&job).unwrap();
    assert_eq!((outcome.job_error(), written(&outcome)), (None, source));
}

#[test]
fn error_responses_end_the_job_with_their_code() {
    for (fault, expected) in [(Fault::ReadError(33), JobError::Read), (Fault::WriteError(3), JobError::Write)] {
        let afu = echo(0);
        let mut faulty = link("shuffled", 0);
        faulty.plan(&[fault]);
        assert_eq!(run_on(&afu, faulty, 100).unwrap().job_error(), Some(expected));
    }
}

#[test]
fn data_faults_reach_the_destination() {
    for (fault, different) in
        [(Fault::ReadSwapped(10), vec![10, 11]), (Fault::ReadFlipped { read: 20, bit: 511 }, vec![20])]
    {
        let afu = echo(0);
        let mut faulty = link("ideal", 0);
        faulty.plan(&[fault]);
        let outcome = run_on(&afu, faulty, 100).unwrap();
        let (got, right) = (written(&outcome), lines(100));
        assert_eq!((0..100).filter(|&i| got[i] != right[i]).collect::<Vec<_>>(), different);
    }
}

#[test]
fn abort_ends_the_job_and_the_next_is_right() {
    for name in LinkModel::PRESETS {
        let afu = echo(3);
        let mut driver = Driver::new(&afu, link(name, 3)).unwrap();
        let source = lines(500);
        let job = Job::new(&source, 1000, 500);
        driver.start(&job).unwrap();
        (0..100).for_each(|_| assert!(!driver.step().unwrap()));
        driver.abort();
        while !driver.step().unwrap() {}
        assert_eq!(driver.finish().unwrap().job_error(), Some(JobError::Aborted), "{name}");
        let outcome = driver.run(&job).unwrap();
        assert_eq!((outcome.job_error(), written(&outcome)), (None, source), "{name}");
    }
}

#[test]
fn reset_in_mid_job_and_the_next_is_right_though_old_responses_still_come() {
    for name in LinkModel::PRESETS {
        let afu = echo(4);
        let mut driver = Driver::new(&afu, link(name, 4)).unwrap();
        let (first, second) = (lines(500), lines(300));
        driver.start(&Job::new(&first, 1000, 500)).unwrap();
        (0..90).for_each(|_| assert!(!driver.step().unwrap()));
        driver.reset().unwrap();
        assert!(name == "ideal" || driver.link().in_flight().0 > 0, "{name}: something stale must be on its way");
        let elsewhere = Job { destination_address: 1 << 41, ..Job::new(&second, 600, 300) };
        let outcome = driver.run(&elsewhere).unwrap();
        assert_eq!((outcome.job_error(), written(&outcome)), (None, second), "{name}");
    }
}

#[test]
fn a_wrong_mode_is_the_afus_error_and_a_wrong_afu_ours() {
    let afu = echo(0);
    let mut driver = Driver::new(&afu, link("ideal", 0)).unwrap();
    let source = lines(4);
    let job = Job::new(&source, 8, 4);
    assert_eq!(driver.run(&Job { mode: 3, ..job.clone() }).unwrap().job_error(), Some(JobError::Mode));
    let error = driver.run(&Job { scpus: Some(9), ..job.clone() }).unwrap_err();
    assert_eq!(error.to_string(), "expected an AFU with SCPUs = 9, found 10");
    let error = driver.run(&Job { destination_address: job.source_address + 3, ..job.clone() }).unwrap_err();
    assert_eq!(error.to_string(), "the job does not fit: source and destination overlap");
    assert_eq!(driver.run(&Job { scpus: Some(10), ..job }).unwrap().job_error(), None);
}

/// Each violation of the protocol is detected and reported as what it is.
#[test]
fn the_monitor_finds_what_a_broken_afu_does() {
    let found = |from: &str, to: &str, name: &str| match run_on(&broken(from, to), link(name, 1), 300) {
        Err(DriveError::Protocol { what, .. }) => what,
        other => panic!("`{to}`: {other:?}"),
    };
    let unstable = found("(!rd_req_valid || rd_req_ready)", "1'b1", "hostile");
    assert_eq!(unstable, ProtocolError::Unstable { is_read: true });
    let unstable = found("(!wr_req_valid || wr_req_ready)", "1'b1", "hostile");
    assert_eq!(unstable, ProtocolError::Unstable { is_read: false });
    let reused = found("&& !held[ask_slot] ", "", "late");
    assert!(matches!(reused, ProtocolError::TagReused { is_read: true, .. }), "{reused}");
    let epoch = found("rd_req_tag <= {job, ask_slot}", "rd_req_tag <= {job + 4'd1, ask_slot}", "ideal");
    assert!(matches!(epoch, ProtocolError::WrongEpoch { is_read: true, .. }), "{epoch}");
    let early = found("!outstanding && (stopping || sent == lines)", "sent == lines", "late");
    assert!(matches!(early, ProtocolError::DoneEarly { .. } | ProtocolError::Idle { .. }), "{early}");
    let past =
        found("lines <= {1'b0, count[31:1]} + {31'd0, count[0]}", "lines <= {1'b0, count[31:1]} + 32'd1", "ideal");
    assert!(matches!(past, ProtocolError::Memory(_)), "{past}");
    let twice =
        found("wr_req_address <= destination_base + {26'd0, sent}", "wr_req_address <= destination_base", "ideal");
    assert!(matches!(twice, ProtocolError::Memory(_)), "{twice}");
    let unwritten =
        found("lines <= {1'b0, count[31:1]} + {31'd0, count[0]}", "lines <= {1'b0, count[31:1]} - 32'd1", "ideal");
    assert!(matches!(unwritten, ProtocolError::Unwritten(_)), "{unwritten}");
}

/// If the link has no faults, the error says that the AFU hangs, not the link.
#[test]
fn an_afu_that_hangs_is_named() {
    let hung = broken("!outstanding && (stopping || sent == lines)", "1'b0");
    let error = run_on(&hung, link("ideal", 0), 10).unwrap_err();
    assert!(matches!(error, DriveError::TimedOut { waiting: Waiting::Afu, cycles: ..1_000, .. }), "{error}");
    // If it hangs at the beginning of a long job, the driver does not wait as long as the job would take.
    let hung = broken("(!wr_req_valid || wr_req_ready)", "1'b0");
    let error = run_on(&hung, link("late", 0), 50_000).unwrap_err();
    assert!(matches!(error, DriveError::TimedOut { waiting: Waiting::Afu, cycles: ..5_000, .. }), "{error}");
}
