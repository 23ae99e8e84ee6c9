//! Hashes of the destination memory after a job, for forty AFUs that cover every part of a record's layout. Hardware
//! and host share one layout, so both could be wrong in the same way. These hashes were taken before they shared it.
//!
//! Without a shell the crate's own evaluator runs the hardware, which needs no model. With SPL2 the hardware is
//! Verilated.

use crate::evaluated::at_the_line_port;
use contact_afu::config::{Config, Shell};
use contact_afu::link::{Line, LinkModel};
use contact_afu::pairs::Set;
use contact_afu::verify::Bench;
use sha2::{Digest, Sha256};

const PAIRS: u64 = 67;

/// Profile, fields, record, results, SCPUs, interval, radius, and the hash of the destination memory.
type Image = (&'static str, &'static str, &'static str, &'static str, u32, u32, Option<f32>, &'static str);

const ALL: &str = "depth,normal,position";

const LINE: [Image; 32] = [
    ("e8f3z", "hit", "f32", "all", 3, 1, None, "02d899b38eb9e563"),
    ("e8f3z", "depth", "f32", "all", 3, 1, None, "50521e38fa309326"),
    ("e8f3z", "normal", "f32", "all", 3, 1, None, "b88053fb6039738b"),
    ("e8f3z", "depth,normal", "f32", "all", 3, 1, None, "499bac55ae05f7a9"),
    ("e8f3z", "position", "f32", "all", 3, 1, None, "5e487596a775dc79"),
    ("e8f3z", "depth,position", "f32", "all", 3, 1, None, "ba9ef73f95dc310c"),
    ("e8f3z", "normal,position", "f32", "all", 3, 1, None, "a9c4fd474ebd83c2"),
    ("e8f3z", ALL, "f32", "all", 3, 1, None, "702c02cdccd9e77d"),
    ("e8f3z", "hit", "f32", "hits", 3, 1, None, "537ca40009122c92"),
    ("e8f3z", "depth", "f32", "hits", 3, 1, None, "18f369ef1448e958"),
    ("e8f3z", "normal", "f32", "hits", 3, 1, None, "9fd988cc072646ec"),
    ("e8f3z", "depth,normal", "f32", "hits", 3, 1, None, "2fa3b8a0753008c2"),
    ("e8f3z", "position", "f32", "hits", 3, 1, None, "2ae4e2ae6eaf2c84"),
    ("e8f3z", "depth,position", "f32", "hits", 3, 1, None, "e319459774c5ac6f"),
    ("e8f3z", "normal,position", "f32", "hits", 3, 1, None, "7dbcfdbf252826b5"),
    ("e8f3z", ALL, "f32", "hits", 3, 1, None, "2fcff89dac023616"),
    ("half", "hit", "f16", "all", 2, 1, None, "05cf42abaee7b94c"),
    ("half", "depth", "f16", "all", 2, 1, None, "cb134bbfe493f2e5"),
    ("half", "normal", "f16", "all", 3, 2, None, "175276aef57aca47"),
    ("half", ALL, "f16", "all", 4, 1, None, "357b22340740247e"),
    ("half", "hit", "f16", "hits", 2, 1, None, "10c1ba70e910b1ec"),
    ("half", "depth", "f16", "hits", 5, 2, None, "f02041d7cdcf25fc"),
    ("half", "normal", "f16", "hits", 2, 1, None, "9aeb664c53778d3e"),
    ("half", ALL, "f16", "hits", 1, 1, None, "7e935e813c9b4ba7"),
    ("bfloat", ALL, "bf16", "all", 1, 1, Some(0.5), "a631ef1bc79a2758"),
    ("bfloat", "depth,position", "bf16", "all", 1, 1, Some(0.5), "1fcbef9a902eaf02"),
    ("bfloat", ALL, "bf16", "hits", 1, 1, Some(0.5), "20a4e755e5cca43d"),
    ("e8f3z", "depth,position", "f32", "hits", 2, 1, Some(0.5), "beffc2e6625a72b5"),
    ("paper", ALL, "f32", "all", 1, 1, None, "5b1c525472d200d3"),
    ("wide", ALL, "f32", "all", 2, 2, None, "6826257ae8fec426"),
    ("wide", ALL, "f32", "hits", 2, 2, None, "7482d4e391915c2f"),
    ("exact", ALL, "f32", "all", 1, 1, None, "ff550ff390ce5c6d"),
];

const SPL2: [Image; 8] = [
    ("wide", ALL, "f32", "all", 10, 5, None, "6826257ae8fec426"),
    ("e8f3z", ALL, "f32", "hits", 3, 1, None, "2fcff89dac023616"),
    ("e8f3z", "hit", "f32", "all", 3, 1, None, "02d899b38eb9e563"),
    ("e8f3z", "depth,normal", "f32", "all", 2, 2, None, "499bac55ae05f7a9"),
    ("half", "depth", "f16", "hits", 2, 1, None, "f02041d7cdcf25fc"),
    ("half", ALL, "f16", "all", 2, 1, None, "357b22340740247e"),
    ("bfloat", "depth,position", "bf16", "all", 1, 1, Some(0.5), "1fcbef9a902eaf02"),
    ("e8f3z", "hit", "f32", "hits", 1, 1, Some(0.5), "056603a85e12f2ee"),
];

fn config(&(profile, contact, record, results, scpus, interval, radius, _): &Image, shell: Shell) -> Config {
    Config {
        profile: profile.parse().unwrap(),
        contact: contact.parse().unwrap(),
        record: record.parse().unwrap(),
        results: results.parse().unwrap(),
        scpus,
        interval,
        radius,
        shell,
        ..Config::default()
    }
}

/// Pairs of every flow, with the common radius if there is one.
fn pairs(config: &Config) -> Vec<[u32; 8]> {
    let mut pairs: Vec<_> = Set::Random(PAIRS).pairs(7).into_iter().map(|pair| pair.0).collect();
    for pair in &mut pairs {
        for word in [3, 7] {
            pair[word] = config.radius.map_or(pair[word], f32::to_bits);
        }
    }
    pairs
}

fn hash(lines: &[Line]) -> String {
    let mut hash = Sha256::new();
    lines.iter().flatten().for_each(|word| hash.update(word.to_le_bytes()));
    hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

/// The destination lines of a job with a shell that has registers.
fn below_a_shell(config: &Config) -> Vec<Line> {
    let pairs: Vec<_> = pairs(config).into_iter().map(contact_afu::PairRecord).collect();
    let verdict = Bench::new(config).unwrap().run(&pairs, &LinkModel::ideal(), 1).unwrap();
    verdict.assert_good();
    verdict.outcome.lines.into_iter().map_while(|line| line).collect()
}

fn compare(images: &[Image], shell: Shell, run: fn(&Config) -> Vec<Line>) {
    let different = |image: &Image| {
        let found = hash(&run(&config(image, shell)));
        (found != image.7).then(|| format!("{image:?}: {found}"))
    };
    let different: Vec<_> = images.iter().filter_map(different).collect();
    assert!(different.is_empty(), "{}", different.join("\n"));
}

#[test]
fn images_at_the_line_port_are_what_they_were() {
    compare(&LINE, Shell::Line, |config| at_the_line_port(config, &pairs(config)));
}

#[test]
fn images_below_spl2_are_what_they_were() {
    compare(&SPL2, Shell::Spl2, below_a_shell);
}

/// What lies in memory does not depend on the shell.
#[test]
fn images_behind_axi_are_those_below_spl2() {
    compare(&SPL2, Shell::Axi, below_a_shell);
}
