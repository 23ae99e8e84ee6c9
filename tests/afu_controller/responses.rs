//! Responses that were not requested, that arrive at the last moment, or that never arrive; requests that the link
//! never accepts.

use contact_afu::afu::{DRAIN_CYCLES, JobError};

use crate::bench::Bench;

const WATCHDOG: u64 = 40;

fn code(error: JobError) -> u64 {
    error as u64
}

/// Runs to the end of the job, and fails if it takes more than `cycles` cycles.
fn ends_within(bench: &mut Bench, cycles: u64, what: &str) {
    let took = bench.finish();
    assert!(took <= cycles, "{what}: {took} cycles");
}

/// Checks that the next job is right, whatever state the last one left behind.
fn next_is_right(bench: &mut Bench, epoch: u64) {
    bench.set("abort_job", 0);
    bench.start(33, epoch);
    bench.finish();
    bench.check(33);
}

/// In each cycle of a job, a response arrives whose request was already answered or never made. It has the job's epoch,
/// as can happen after 16 jobs.
#[test]
fn a_response_that_no_request_waits_for_is_an_error() {
    for port in ["rd", "wr"] {
        let (mut found, mut late) = (0, 0);
        for at in 2..140 {
            let mut bench = Bench::new(3, 5, at);
            bench.start(60, 1);
            for _ in 0..at {
                bench.cycle();
            }
            let ended = bench.get("done") == 1;
            let waits = |slot: &u64| bench.reads.iter().any(|(_, tag)| tag & 63 == *slot);
            let slot = match port {
                "rd" => (0..64).find(|slot| !waits(slot)),
                _ => (0..64).find(|slot| bench.writes.iter().all(|tag| tag & 63 != *slot)),
            };
            bench.forged = Some((port, 1 << 6 | slot.expect("a slot")));
            bench.cycle();
            bench.finish();
            match bench.get("error") {
                0 => {
                    bench.check(60);
                    late += u64::from(!ended);
                }
                error => {
                    assert_eq!(error, code(JobError::Response), "{port}, cycle {at}");
                    found += 1;
                }
            }
            assert!(bench.reads.is_empty() && bench.writes.is_empty(), "ended with requests unanswered");
            next_is_right(&mut bench, 2);
        }
        // It can be too late only in the cycles in which a job completes.
        assert!(found > 50 && late <= 7, "{port}: {found} found, {late} too late");
    }
}

/// The error of a job whose last acknowledgement arrives `cycles` cycles after its request was accepted.
fn acknowledged_after(cycles: u64) -> u64 {
    let mut bench = Bench::new(1, 8, 1);
    bench.set("watchdog", WATCHDOG);
    bench.start(2, 1);
    while bench.writes.is_empty() {
        bench.cycle();
    }
    bench.answers = false;
    for _ in 1..cycles {
        bench.cycle();
    }
    bench.answers = true;
    bench.finish();
    if bench.get("error") == 0 {
        bench.check(2);
    }
    let error = bench.get("error");
    bench.writes.clear();
    next_is_right(&mut bench, 2);
    error
}

/// The watchdog has a single boundary: an acknowledgement is either in time, or the job ends with the watchdog's error.
#[test]
fn the_last_acknowledgement_is_in_time_until_the_watchdog_has_expired() {
    let errors: Vec<u64> = (1..=WATCHDOG + 6).map(acknowledged_after).collect();
    let in_time = errors.iter().take_while(|error| **error == 0).count() as u64;
    assert!(errors[in_time as usize..].iter().all(|error| *error == code(JobError::Watchdog)), "{errors:?}");
    // The count includes the cycle in which the request is on the port.
    assert_eq!(in_time, WATCHDOG - 1);
}

/// An abort ends even without a watchdog, and reports that responses may still arrive.
#[test]
fn an_abort_ends_though_a_response_is_lost() {
    let most = u64::from(DRAIN_CYCLES) + 100;
    for (watchdog, within) in [(0, most), (WATCHDOG, WATCHDOG + 100)] {
        for port in ["rd", "wr"] {
            let mut bench = Bench::new(3, 8, 1);
            bench.set("watchdog", watchdog);
            bench.start(60, 1);
            while if port == "rd" { bench.reads.is_empty() } else { bench.writes.is_empty() } {
                bench.cycle();
            }
            match port {
                "rd" => drop(bench.reads.remove(0)),
                _ => drop(bench.writes.remove(0)),
            }
            bench.set("abort_job", 1);
            ends_within(&mut bench, within, port);
            assert_eq!(bench.get("error"), code(JobError::Watchdog), "{port}, watchdog {watchdog}");
            next_is_right(&mut bench, 2);
        }
    }
}

/// The link stops accepting requests: the job ends, its request stays on the port unchanged, and the next job is right
/// once the link accepts again.
#[test]
fn a_link_that_accepts_nothing_does_not_keep_a_job() {
    for (watchdog, aborts) in [(WATCHDOG, false), (WATCHDOG, true), (0, true)] {
        for at in [2, 5, 11, 40, 60] {
            let what = format!("cycle {at}, watchdog {watchdog}, aborts: {aborts}");
            let mut bench = Bench::new(3, 8, 1);
            bench.set("watchdog", watchdog);
            bench.start(600, 1);
            for _ in 0..at {
                bench.cycle();
            }
            bench.accepts = false;
            bench.set("abort_job", u64::from(aborts));
            let within = if watchdog > 0 { 2 * WATCHDOG + 100 } else { u64::from(DRAIN_CYCLES) + 100 };
            ends_within(&mut bench, within, &what);
            assert_eq!(bench.get("error"), code(JobError::Watchdog), "{what}");
            // What is on a port: an address and a tag if it is valid.
            let requests = |bench: &mut Bench| {
                ["rd_req", "wr_req"].map(|port| {
                    let mut get = |field: &str| bench.get(&format!("{port}_{field}"));
                    (get("valid") == 1).then(|| (get("address"), get("tag")))
                })
            };
            let stood = requests(&mut bench);
            assert_ne!(stood, [None, None], "{what}: nothing on the port");
            bench.set("abort_job", 0);
            bench.start(33, 2);
            for _ in 0..10 {
                bench.cycle();
                assert_eq!(requests(&mut bench), stood, "{what}: a request was withdrawn or changed");
            }
            bench.accepts = true;
            bench.finish();
            let old = 5000..5000 + 300;
            let write = stood[1].map(|(address, _)| address);
            bench.written.retain(|(address, _)| Some(*address) != write || !old.contains(address));
            assert_eq!(bench.get("error"), 0, "{what}");
            assert!(bench.reads.is_empty() && bench.writes.is_empty(), "{what}");
        }
    }
}

/// When the link accepts again after a job was given up, it gets the requests that stood on its ports, and no others:
/// the host may use the job's memory for something else.
#[test]
fn nothing_follows_a_request_that_was_given_up() {
    for at in [2, 5, 11, 40, 60] {
        let mut bench = Bench::new(3, 8, 1);
        bench.set("watchdog", WATCHDOG);
        bench.start(600, 1);
        for _ in 0..at {
            bench.cycle();
        }
        bench.accepts = false;
        bench.finish();
        assert_eq!(bench.get("error"), code(JobError::Watchdog), "cycle {at}");
        let stood = (bench.get("rd_req_valid") as usize, bench.get("wr_req_valid") as usize);
        let before = (bench.reads.len(), bench.writes.len());
        bench.answers = false;
        bench.accepts = true;
        for _ in 0..20 {
            bench.cycle();
        }
        let came = (bench.reads.len() - before.0, bench.writes.len() - before.1);
        assert_eq!(came, stood, "cycle {at}: reads and writes after the end");
    }
}
