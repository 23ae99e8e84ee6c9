//! Intervals above 1: every word over every link, also after aborts, and a throughput of SCPUs / interval pairs per
//! cycle.

use contact_afu::config::{Config, Profile, Results};
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::verify::Bench;

use crate::bench::{Case, driver, generated, of};

/// Checks every word over every link on an AFU that is never reset, then the pairs per cycle over the ideal link.
fn check(config: &Config) {
    let (scpus, interval) = (config.scpus, config.interval);
    let model = generated(config);
    let cases = [0, 1, 2, 3, 178].map(|count| Case::random(config, count, count + 3));
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut driver = driver(&afu, link, seed);
        assert_eq!((driver.capability().scpus, driver.capability().interval), (scpus, interval));
        for case in &cases {
            let what = format!("{scpus} SCPUs, interval {interval}, {link}, {} pairs", case.pairs.len());
            let outcome = driver.run(&case.job()).unwrap_or_else(|e| panic!("{what}: {e}"));
            case.check(&outcome, &what);
        }
    }
    let case = Case::new(config, Set::Diamond(10).pairs(0));
    let afu = model.instance(1).unwrap();
    let outcome = driver(&afu, "ideal", 1).run(&case.job()).unwrap();
    case.check(&outcome, "diamond:10");
    // With more SCPUs than `whole`, only a multiple of `whole` take turns.
    let whole = 2 * interval;
    let in_turn = if scpus > whole { scpus / whole * whole } else { scpus };
    let pairs_a_cycle = (f64::from(in_turn) / f64::from(interval)).min(2.0);
    let reached = case.pairs.len() as f64 / outcome.cycles as f64 / pairs_a_cycle;
    assert!(
        (0.95..=1.0).contains(&reached),
        "{scpus} SCPUs, interval {interval}: {reached} of {pairs_a_cycle} a cycle"
    );
}

fn every(interval: u32, scpus: u32) -> Config {
    Config { interval, ..of(scpus) }
}

#[test]
fn ten_at_five_take_a_line_a_cycle() {
    check(&every(5, 10));
}

#[test]
fn three_at_two_take_three_in_two_cycles() {
    check(&every(2, 3));
}

/// The fifth SCPU would never have a turn, so it is not generated.
#[test]
fn five_at_two_use_four() {
    check(&Config { profile: "half".parse().unwrap(), ..every(2, 5) });
}

#[test]
fn one_at_sixteen_gives_hits_alone() {
    check(&Config { results: Results::Hits, ..every(16, 1) });
}

#[test]
#[ignore = "a minute or two: more sizes and intervals"]
fn every_interval_and_size() {
    for interval in [1, 2, 3, 5, 8, 16, 64] {
        [1, 2, 3, 10].into_iter().for_each(|scpus| check(&every(interval, scpus)));
    }
    check(&every(5, 64));
    check(&Config { contact: contact_afu::query::Fields::HIT, results: Results::Hits, ..every(3, 10) });
    check(&Config { radius: Some(0.5), ..every(4, 7) });
}

#[test]
#[ignore = "half a minute: the exact profile at an interval, with unsettled pairs resolved by the host"]
fn the_exact_profile() {
    for (scpus, interval) in [(3, 2), (2, 8)] {
        let config = Config { scpus, interval, profile: Profile::EXACT, ..Config::default() };
        let bench = Bench::new(&config).expect("a model");
        let run = bench.run(&Set::Hard(1_700).pairs(8), &LinkModel::hostile(), 5).expect("a job");
        assert!(run.is_good(), "{:?} {:?}", run.mismatches.first(), run.failed_checks);
        assert!(run.unsettled > 50, "{} unsettled", run.unsettled);
    }
}
