//! Spheres and planes in hardware: every bit of memory for every kind of record, with both shells.

use contact_afu::config::{Config, Shell};
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::query::{PairRecord, Query};
use contact_afu::verify::Bench;

use crate::evaluated::{at_the_line_port, destination};

fn pairs(seed: u64) -> Vec<PairRecord> {
    let of = |set: Set| set.pairs_of(Query::SpherePlane, seed).unwrap();
    [of(Set::Random(40)), of(Set::Hard(24))].concat()
}

fn config(profile: &str, contact: &str, record: &str, results: &str, scpus: u32, interval: u32) -> Config {
    Config {
        query: Query::SpherePlane,
        profile: profile.parse().unwrap(),
        contact: contact.parse().unwrap(),
        record: record.parse().unwrap(),
        results: results.parse().unwrap(),
        scpus,
        interval,
        shell: Shell::Line,
        ..Config::default()
    }
}

/// Compares the destination lines of a job with the reference's records, laid out independently.
#[track_caller]
fn check(config: &Config, seed: u64) {
    let pairs = pairs(seed);
    let contacts = config.reference().run_all(&pairs);
    let words: Vec<_> = pairs.iter().map(|pair| pair.0).collect();
    let (found, wanted) = (at_the_line_port(config, &words), destination(config, &contacts));
    assert!(found == wanted, "{config:?}: {found:x?}, not {wanted:x?}");
}

#[test]
fn every_subset_of_fields_in_every_record() {
    let subsets = ["hit", "depth", "normal", "depth,normal", "position", "depth,position", "normal,position"];
    for (number, contact) in (0..).zip(subsets.into_iter().chain(["depth,normal,position"])) {
        for (profile, record) in [("e8f3z", "f32"), ("half", "f16"), ("bfloat", "bf16")] {
            for results in ["all", "hits"] {
                check(&config(profile, contact, record, results, 1 + number % 3, 1), number.into());
            }
        }
    }
}

#[test]
fn every_profile_at_several_intervals() {
    for (seed, profile) in (0..).zip(["paper", "wide", "half", "bfloat", "e6f9", "e11f30", "e8f23z"]) {
        for (interval, scpus, results) in [(1, 2, "all"), (2, 4, "hits"), (5, 3, "all"), (9, 1, "hits")] {
            check(&config(profile, "depth,normal,position", "f32", results, scpus, interval), seed);
        }
    }
}

/// The simulated AFU and the host, over a link that reorders and stalls.
#[test]
fn jobs_over_a_hostile_link_below_every_shell() {
    for (shell, profile, record, results, interval) in [
        (Shell::Line, "wide", "f32", "hits", 2),
        (Shell::Spl2, "paper", "f32", "all", 1),
        (Shell::Spl2, "half", "f16", "hits", 1),
        (Shell::Axi, "half", "f16", "hits", 1),
    ] {
        let config = Config { shell, ..config(profile, "depth,normal,position", record, results, 3, interval) };
        let bench = Bench::new(&config).unwrap();
        for seed in 1..4 {
            bench.run(&pairs(seed).repeat(9), &LinkModel::hostile(), seed).unwrap().assert_good();
        }
    }
}

/// The comparison can fail: it detects one flipped bit in a word of the kernel's input.
#[test]
#[should_panic(expected = "not [[")]
fn another_pair_is_another_image() {
    let config = config("wide", "depth", "f32", "all", 1, 1);
    let pairs = pairs(1);
    let contacts = config.reference().run_all(&pairs);
    let mut words: Vec<_> = pairs.iter().map(|pair| pair.0).collect();
    words[0][7] ^= 1 << 20;
    let (found, wanted) = (at_the_line_port(&config, &words), destination(&config, &contacts));
    assert!(found == wanted, "{found:x?}, not {wanted:x?}");
}
