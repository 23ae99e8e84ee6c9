//! Only contacts come back: in order and densely packed, however many there are in a row.

use contact_afu::afu::Spec;
use contact_afu::config::{Config, Results};

use crate::bench::{Bench, mixed};

fn only_hits(scpus: u32, contact: &str, line_bits: u32) -> Spec {
    let config = Config { scpus, results: Results::Hits, contact: contact.parse().unwrap(), ..Config::default() };
    Spec { line_bits, ..Spec::from(config) }
}

/// One, two, four and eight pairs per line; from less than one record per cycle to sixteen per line; no, few, half and
/// all pairs hit.
#[test]
fn hits_come_back_in_order_and_dense() {
    let kinds: [fn(u64) -> bool; 4] = [|_| false, |pair| pair % 19 == 3, |pair| mixed(pair) & 1 == 1, |_| true];
    for (contact, line_bits) in
        [("position,normal,depth", 512), ("hit", 512), ("depth", 256), ("position", 1024), ("normal,depth", 2048)]
    {
        for (scpus, eagerness) in [(1, 8), (2, 5), (3, 2), (7, 8), (10, 5), (16, 8)] {
            let mut bench = Bench::of(only_hits(scpus, contact, line_bits), eagerness, u64::from(scpus));
            let counts = [0, 1, 2, 3, 100, 37].into_iter().flat_map(|count| kinds.map(|hits| (count, hits)));
            for (epoch, (count, hits)) in counts.enumerate() {
                bench.hits = hits;
                bench.set("destination_lines", count);
                bench.start(count, epoch as u64 % 16);
                bench.finish();
                bench.check_hits(count, count);
            }
        }
    }
}

/// With a dispatcher as small as possible, no hit is lost when pairs arrive at full rate and the link rarely accepts a
/// line.
#[test]
fn a_small_dispatcher_loses_no_hits() {
    for dispatch_cycles in [1, 4, 8] {
        for contact in ["position,normal,depth", "hit"] {
            let spec = Spec { dispatch_cycles, ..only_hits(4, contact, 512) };
            let mut bench = Bench::of(spec, 8, u64::from(dispatch_cycles));
            bench.write_eagerness = 1;
            bench.hits = |_| true;
            bench.set("destination_lines", 300);
            bench.start(300, 1);
            bench.finish();
            bench.check_hits(300, 300);
        }
    }
}

/// Contacts without room are counted but not written, and the next job is not affected.
#[test]
fn more_hits_than_there_is_room_for_end_in_an_error() {
    for contact in ["position,normal,depth", "depth"] {
        let mut bench = Bench::of(only_hits(3, contact, 512), 5, 1);
        for (epoch, room) in [0, 1, 5, 49, 50, 0, 100].into_iter().enumerate() {
            bench.set("destination_lines", room);
            bench.start(100, epoch as u64);
            bench.finish();
            bench.check_hits(100, room);
        }
    }
}

#[test]
fn few_hits_leave_the_input_at_full_speed() {
    let mut bench = Bench::of(only_hits(2, "position,normal,depth", 512), 8, 1);
    // One pair in ten hits, and sometimes forty in a row.
    bench.hits = |pair| pair % 20 == 7 || pair % 800 < 40;
    bench.set("destination_lines", 4000);
    bench.start(4000, 1);
    let cycles = bench.finish();
    bench.check_hits(4000, 4000);
    assert!(cycles < 2000 + 80, "4000 pairs on two SCPUs took {cycles} cycles");
    // All pairs hit: one line per cycle leaves.
    bench.hits = |_| true;
    bench.start(1000, 2);
    let cycles = bench.finish();
    bench.check_hits(1000, 4000);
    assert!(cycles < 1000 + 80, "1000 lines took {cycles} cycles");
}

#[test]
fn an_aborted_job_leaves_no_hits_to_the_next() {
    for at in 0..80 {
        let mut bench = Bench::of(only_hits(3, "position,normal,depth", 512), 5, at);
        bench.hits = |pair| pair % 4 != 1;
        bench.set("destination_lines", 60);
        bench.start(60, 1);
        for _ in 0..at {
            bench.cycle();
        }
        bench.set("abort_job", 1);
        bench.cycle();
        bench.set("abort_job", 0);
        bench.finish();
        assert!(bench.reads.is_empty() && bench.writes.is_empty(), "ended with requests unanswered");
        bench.start(33, 2);
        bench.finish();
        bench.check_hits(33, 60);
    }
}
