//! The AFU as generated today against the reference kernel, over every preset link.
#![cfg(feature = "cosim")]

use contact_afu::config::{Config, Results, Shell};
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::verify::{Bench, Verdict};

fn good(verdict: &Verdict, what: &str) {
    let first = verdict.mismatches.first();
    assert!(verdict.is_good(), "{what}: {} mismatches, first {first:?}; {:?}", verdict.mismatches.len(), verdict.unmet);
}

#[test]
fn the_diamond_comes_back_right_and_at_the_link_s_speed() {
    let bench = Bench::new(&Config::default()).expect("a model");
    let pairs = Set::Diamond(10).pairs(0);
    let verdict = bench.run(&pairs, &LinkModel::ideal(), 1).expect("it finishes");
    good(&verdict, "diamond");
    assert_eq!(verdict.flows(&Config::default()), [0, 9_420, 0, 2_934]);
    assert!(verdict.outcome.efficiency() > 0.95, "{:?}", verdict.outcome.cycles);
    let verdict = bench.run(&Set::Random(20_000).pairs(3), &LinkModel::ideal(), 1).expect("it finishes");
    good(&verdict, "random");
}

/// Only contacts, below the paper's platform: as many lines as there are contacts.
#[test]
fn hits_come_back_through_spl2() {
    let profile = "e8f3z".parse().expect("a format");
    let config = Config { scpus: 3, profile, results: Results::Hits, shell: Shell::Spl2, ..Config::default() };
    let bench = Bench::new(&config).expect("a model");
    for (pairs, seed) in [(501, 1), (0, 2), (1, 3)] {
        let verdict = bench.run(&Set::Random(pairs).pairs(seed), &LinkModel::shuffled(), seed).expect("it finishes");
        good(&verdict, "hits through spl2");
        assert_eq!(verdict.numbers.len(), verdict.outcome.contacts as usize);
        assert_eq!(verdict.outcome.lines.iter().flatten().count(), verdict.numbers.len());
    }
}
