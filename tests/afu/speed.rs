//! The throughput of the AFU alone, and its counters when something else is slower.

use contact_afu::link::{Direction, Link, LinkModel, Order};
use contact_afu::pairs::Set;

use crate::bench::{Case, driver, full_rate, of};

#[test]
fn one_line_a_cycle_or_one_pair_a_cycle_and_scpu() {
    let case = Case::new(&of(1), Set::Diamond(10).pairs(0));
    let pairs = case.pairs.len() as f64;
    for (scpus, cycles_per_pair) in [(1, 1.0), (2, 0.5), (3, 0.5), (10, 0.5), (16, 0.5)] {
        let afu = full_rate(scpus).instance(1).unwrap();
        let outcome = driver(&afu, "ideal", 1).run(&case.job()).unwrap();
        case.check(&outcome, "diamond:10");
        let reached = pairs * cycles_per_pair / outcome.cycles as f64;
        assert!((0.95..=1.0).contains(&reached), "{scpus} SCPUs: {} cycles, {reached} of the limit", outcome.cycles);
        let latency = afu.output("capability", 64).unwrap().get() >> 32 & 0xfff;
        let seen = outcome.latency_cycles.unwrap();
        assert!(
            (latency..latency + 19 + u64::from(scpus)).contains(&seen),
            "an SCPU of {latency} cycles, {seen} with all round it"
        );
    }
}

/// The AFU's counters attribute the wait to the slow direction.
#[test]
fn the_counters_name_the_slower_side() {
    let case = Case::random(&of(3), 8_000, 9);
    let afu = full_rate(3).instance(1).unwrap();
    let slow = Direction { lines_per_cycle: 0.25, ..Direction::steady(5, 0) };
    let fast = Direction::steady(5, 0);
    for (read, write) in [(fast, slow), (slow, fast)] {
        let name = "lopsided".to_owned();
        let model = LinkModel { name, read, write, order: Order::InOrder, ..LinkModel::ideal() };
        let mut driver = contact_afu::cosim::Driver::new(&afu, Link::new(model, 1).unwrap()).unwrap();
        let outcome = driver.run(&case.job()).unwrap();
        case.check(&outcome, "lopsided");
        assert!(outcome.efficiency() > 0.95, "{} cycles for {}", outcome.cycles, outcome.limit_cycles);
        // It waits in three of four cycles. It waits for its output only once the pipeline and the lines behind it are
        // full.
        let (waits, rests) = match read == slow {
            true => (outcome.cycles_input, outcome.cycles_output),
            false => (outcome.cycles_output, outcome.cycles_input),
        };
        let share = waits as f64 / outcome.cycles_busy as f64;
        assert!((0.65..0.8).contains(&share), "{share} of the time, {outcome:?}");
        assert!(rests < 50, "{rests} cycles for the other side");
    }
}
