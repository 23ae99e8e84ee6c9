//! The AFU as generated today against the reference kernel, over every preset link.
#![cfg(feature = "cosim")]

use contact_afu::config::{Config, Multipliers, Record, Results, Shell};
use contact_afu::kernel::PairRecord;
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::verify::{Bench, Verdict};

fn good(verdict: &Verdict, what: &str) {
    let first = verdict.mismatches.first();
    assert!(verdict.is_good(), "{what}: {} mismatches, first {first:?}; {:?}", verdict.mismatches.len(), verdict.unmet);
}

#[test]
fn the_diamond_comes_back_right_and_at_the_link_s_speed() {
    let bench = Bench::new(&Config::shipped()).expect("a model");
    let pairs = Set::Diamond(10).pairs(0);
    let verdict = bench.run(&pairs, &LinkModel::ideal(), 1).expect("it finishes");
    good(&verdict, "diamond");
    assert_eq!(verdict.flows(bench.config()), [0, 9_420, 0, 2_934]);
    assert!(verdict.outcome.efficiency() > 0.95, "{:?}", verdict.outcome.cycles);
    let verdict = bench.run(&Set::Random(20_000).pairs(3), &LinkModel::ideal(), 1).expect("it finishes");
    good(&verdict, "random");
}

/// Spheres of one radius: it is in no record, and not in the hardware's ports; the bits are the same.
#[test]
fn one_radius_is_in_no_record_and_changes_no_bit() {
    let sphere = |i: u32, f: f32| [(i % 5) as f32 * f, (i % 3) as f32, (i % 2) as f32, 0.375];
    let pairs: Vec<_> = (0..150).map(|i| PairRecord::from_spheres(sphere(0, 0.0), sphere(i, 0.25))).collect();
    for (profile, contact, shell) in
        [("e8f3z", "depth,normal,position", Shell::Spl2), ("wide", "hit", Shell::Line), ("exact", "depth", Shell::Line)]
    {
        let [profile, contact] = [profile.to_owned(), contact.to_owned()];
        let config = Config {
            scpus: 3,
            profile: profile.parse().expect("a profile"),
            contact: contact.parse().expect("fields"),
            radius: Some(0.375),
            shell,
            ..Config::default()
        };
        let bench = Bench::new(&config).expect("a model");
        let verdict = bench.run(&pairs, &LinkModel::shuffled(), 1).expect("it finishes");
        good(&verdict, &profile);
        assert!((10..140).contains(&verdict.outcome.contacts), "{profile}: {}", verdict.outcome.contacts);
        let mut other = pairs.clone();
        other[7].0[7] = 0.5_f32.to_bits();
        let error = bench.run(&other, &LinkModel::ideal(), 1).expect_err("another radius").to_string();
        assert!(error.starts_with("pair 7: its r2 is 0.5, and this AFU computes with radius 0.375"), "{error}");
    }
}

/// Records of 16 bits, four pairs a line: all of them and contacts alone, a radius of the hardware's, contacts of one
/// bit, operators shared; bit for bit the reference that reads the same words.
#[test]
fn records_of_16_bits_come_back_as_the_reference_has_them() {
    let random = Set::Random(701).pairs(9);
    let diamond = Set::Diamond(5).pairs(1);
    for (scpus, interval, record, contact, results, shell, radius) in [
        (1, 1, Record::F16, "depth,normal,position", Results::All, Shell::Line, Some(0.5)),
        (3, 1, Record::F16, "hit", Results::All, Shell::Line, None),
        (5, 3, Record::F16, "depth,normal,position", Results::All, Shell::Line, None),
        (10, 1, Record::Bf16, "depth,normal,position", Results::Hits, Shell::Spl2, None),
    ] {
        let profile = "e8f3z".parse().expect("a format");
        let contact = contact.parse().expect("fields");
        let config = Config { scpus, interval, record, contact, results, shell, radius, profile, ..Config::default() };
        let bench = Bench::new(&config).expect("a model");
        let what = format!("{scpus} SCPUs at interval {interval}, {record}");
        let verdict = bench.run(&diamond, &LinkModel::shuffled(), 1).expect("it finishes");
        good(&verdict, &format!("{what}, the diamond"));
        // Below SPL2 the shell reads lines of its own.
        let lines = verdict.outcome.bytes_read / 64;
        let pairs = diamond.len().div_ceil(4) as u64;
        assert!(shell == Shell::Spl2 || lines == pairs, "four pairs a line: {lines} lines");
        if radius.is_none() {
            let verdict = bench.run(&random, &LinkModel::shuffled(), 2).expect("it finishes");
            good(&verdict, &format!("{what}, at random"));
            assert!(verdict.outcome.contacts > 20 && verdict.outcome.invalid > 20, "{:?}", verdict.outcome.contacts);
        }
    }
}

/// Roots and reciprocals digit by digit in the place of tables: more cycles, and the same bits.
#[test]
fn spared_multiplier_blocks_change_no_bit() {
    let pairs = Set::Random(3_001).pairs(5);
    let latency = [Multipliers::Use, Multipliers::Spare].map(|multipliers| {
        let profile = "e8f7z".parse().expect("a format");
        let config = Config { scpus: 1, profile, multipliers, shell: Shell::Line, ..Config::default() };
        let bench = Bench::new(&config).expect("a model");
        let verdict = bench.run(&pairs, &LinkModel::ideal(), 1).expect("it finishes");
        good(&verdict, &multipliers.to_string());
        assert!(verdict.outcome.contacts > 500, "{}", verdict.outcome.contacts);
        verdict.outcome.cycles
    });
    assert!(latency[0] != latency[1], "the hardware is another: {latency:?} cycles");
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
