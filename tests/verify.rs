//! The AFU as generated today against the reference kernel, over every preset link.
#![cfg(feature = "cosim")]

use contact_afu::config::Config;
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
