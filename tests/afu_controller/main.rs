//! The controller around a kernel of fixed delay, run in the evaluator over small link models of its own: every pair
//! comes back once, in order, whatever the link does.

mod bench;
mod hits;
mod responses;

use bench::Bench;
use contact_afu::afu::Spec;
use contact_afu::config::Config;

#[test]
fn every_pair_comes_back_once_and_in_order() {
    for scpus in [1, 2, 3, 7, 10, 16] {
        for eagerness in [8, 5, 2] {
            let mut bench = Bench::new(scpus, eagerness, u64::from(scpus));
            for (epoch, count) in [0, 1, 2, 3, 257, 128, 1].into_iter().enumerate() {
                bench.start(count, epoch as u64);
                bench.finish();
                bench.check(count);
            }
        }
    }
}

/// If a line waited for more results than there is room for, it would wait for ever.
#[test]
fn a_small_dispatcher_keeps_no_pair_out() {
    for (dispatch_cycles, contact) in [(1, "hit"), (1, "position,normal,depth"), (2, "hit")] {
        let config = Config { contact: contact.parse().unwrap(), scpus: 2, ..Config::default() };
        let mut bench = Bench::of(Spec { dispatch_cycles, ..Spec::from(config) }, 3, 1);
        bench.start(1_203, 1);
        bench.finish();
        assert_eq!(bench.get("error"), 0);
        assert_eq!(bench.written.len(), if contact == "hit" { 3 } else { 602 });
    }
}

#[test]
fn an_ideal_link_is_kept_busy() {
    let mut bench = Bench::new(2, 8, 1);
    bench.start(4000, 1);
    let cycles = bench.finish();
    assert!(cycles < 2000 + 60, "4000 pairs on two SCPUs took {cycles} cycles");
    let mut bench = Bench::new(1, 8, 1);
    bench.start(4000, 1);
    let cycles = bench.finish();
    assert!(cycles < 4000 + 60, "4000 pairs on one SCPU took {cycles} cycles");
}

#[test]
fn an_aborted_job_ends_and_the_next_is_right() {
    for at in 0..120 {
        let mut bench = Bench::new(3, 5, at);
        bench.start(60, 1);
        for _ in 0..at {
            bench.cycle();
        }
        let ended = bench.get("done") == 1;
        bench.set("abort_job", 1);
        bench.cycle();
        bench.set("abort_job", 0);
        bench.finish();
        if !ended {
            let error = bench.get("error");
            assert!(error == 1 || error == 0 && bench.written.len() == 30, "aborted after {at} cycles: error {error}");
        }
        assert!(bench.reads.is_empty() && bench.writes.is_empty(), "ended with requests unanswered");
        bench.start(33, 2);
        bench.finish();
        bench.check(33);
    }
}

#[test]
fn after_a_reset_stale_responses_do_no_harm() {
    for at in 0..120 {
        let mut bench = Bench::new(3, 3, at);
        bench.start(60, 1);
        for _ in 0..at {
            bench.cycle();
        }
        bench.run.reset();
        bench.start(33, 2);
        bench.finish();
        bench.reads.retain(|(_, tag)| tag >> 6 == 2);
        bench.writes.retain(|tag| tag >> 6 == 2);
        bench.check(33);
    }
}

#[test]
fn a_lost_response_ends_in_the_watchdog() {
    let mut bench = Bench::new(3, 8, 1);
    bench.set("watchdog", 50);
    bench.start(60, 1);
    for _ in 0..10 {
        bench.cycle();
    }
    bench.reads.remove(0);
    bench.finish();
    assert_eq!(bench.get("error"), 4);
    bench.start(33, 2);
    bench.finish();
    bench.check(33);
}

#[test]
fn error_responses_and_unknown_modes_end_the_job() {
    for (port, code) in [("rd_rsp_error", 2), ("wr_rsp_error", 3)] {
        let mut bench = Bench::new(3, 8, 1);
        bench.start(300, 1);
        for _ in 0..40 {
            bench.cycle();
        }
        bench.set(port, 1);
        for _ in 0..3 {
            bench.cycle();
        }
        bench.set(port, 0);
        bench.finish();
        assert_eq!(bench.get("error"), code);
        bench.start(33, 2);
        bench.finish();
        bench.check(33);
    }
    let mut bench = Bench::new(3, 8, 1);
    bench.set("mode", 1);
    bench.start(33, 1);
    bench.finish();
    assert_eq!(bench.get("error"), 5);
    bench.set("mode", 0);
    bench.start(33, 2);
    bench.finish();
    bench.check(33);
}
