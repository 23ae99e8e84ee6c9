//! All combinations of widths of the bus, numbers of SCPUs, counts of pairs, links and handshakes.

use contact_afu::config::{Config, Results};
use contact_afu::link::LinkModel;
use contact_afu::link::axi::Handshake;
use contact_afu::pairs::Set;
use contact_afu::verify::Bench;

use crate::bench::{Case, config, end, machine, model, session};

const HANDSHAKES: [Handshake; 3] = [Handshake::Free, Handshake::AddressFirst, Handshake::DataFirst];

#[test]
fn jobs_one_after_another_over_every_link() {
    let cases = [177, 0, 1, 2, 3, 1_001].map(|count| Case::random(count, count + 5));
    for (scpus, bus) in [(1, 512), (3, 256), (2, 128)] {
        let config = config(scpus, bus);
        let model = model(&config);
        for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
            for handshake in HANDSHAKES {
                let afu = model.instance(seed).unwrap();
                // The buffers begin at the end of 4 KB, and in its middle.
                let workspace = cases[5].workspace(61, 13);
                let mut session = session(machine(&afu, link, handshake, seed), &config, workspace);
                let mut loaded = session.transaction().send(&cases[0].pairs).unwrap();
                for (number, case) in cases.iter().enumerate() {
                    let what = format!("{bus} bits, {link}, {handshake:?}, {} pairs", case.pairs.len());
                    let done = end(loaded).unwrap_or_else(|e| panic!("{what}: {e}"));
                    let outcome = done.outcome();
                    case.check(&outcome, &what);
                    let lines = case.pairs.len().div_ceil(2) as u64;
                    assert_eq!((outcome.bytes_read, outcome.bytes_written), (64 * lines, 64 * lines), "{what}");
                    loaded = done.send_next(&cases[(number + 1) % cases.len()].pairs).unwrap();
                }
            }
        }
    }
}

/// The bench of other crates' tests takes the shell like any other: records of contacts alone, of 16 bits, of one bit.
#[test]
fn every_kind_of_record() {
    let with = |contact: &str, results: Results, outstanding: u32| Config {
        contact: contact.parse().unwrap(),
        results,
        outstanding,
        ..config(2, 256)
    };
    let pairs = Set::Random(701).pairs(3);
    for config in [
        with("hit,depth,normal,position", Results::Hits, 16),
        with("hit", Results::All, 64),
        Config { record: "f16".parse().unwrap(), ..with("depth", Results::All, 256) },
    ] {
        let bench = Bench::new(&config).unwrap();
        for link in [LinkModel::ideal(), LinkModel::hostile()] {
            bench.run(&pairs, &link, 5).unwrap().assert_good();
        }
    }
}
