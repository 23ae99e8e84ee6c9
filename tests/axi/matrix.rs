//! All combinations of widths of the bus, numbers of SCPUs, counts of pairs, links and handshakes.

use contact_afu::afu::shell::axi::map;
use contact_afu::config::{Config, Input, Results};
use contact_afu::host::{Expected, Session, Software, Transport, Workspace};
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

/// The same transactions with the AFU in software: every register but those that count cycles, and every byte of the
/// destination, are the same.
#[test]
fn software_and_verilog_write_the_same() {
    let config = Config { results: Results::Hits, ..config(3, 256) };
    let model = model(&config);
    let workspace = || {
        let layout = Expected::edited(&config).layout;
        Workspace::contiguous(layout, 1000).unwrap().with_buffers(7, 1200, 1000).unwrap()
    };
    let counts = ["cycles_busy", "cycles_input", "cycles_output", "first_read", "first_write"];
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut hardware = session(machine(&afu, link, Handshake::Free, seed), &config, workspace());
        let software = Software::new(&config, LinkModel::ideal()).unwrap();
        let mut software = Session::new(software, workspace(), Expected::new(&config).unwrap());
        let mut one = hardware.transaction().send(&[]).unwrap();
        let mut other = software.transaction().send(&[]).unwrap();
        for count in [301, 1, 2, 3, 1000, 0] {
            let what = format!("{link}, before {count} pairs");
            let mut done = one.start().unwrap().confirm().unwrap().wait().unwrap();
            let mut done_too = other.start().unwrap().confirm().unwrap().wait().unwrap();
            for register in map::registers(Input::Direct).filter(|register| !counts.contains(&register.name)) {
                for word in 0..register.words {
                    let at = register.offset + 4 * word;
                    let read = done.transport_mut().read_csr(at).unwrap();
                    assert_eq!(read, done_too.transport_mut().read_csr(at).unwrap(), "{what}: {}", register.name);
                }
            }
            let first = workspace().destination() / 64;
            for line in first..first + 1000 {
                assert_eq!(done.transport().line(line), done_too.transport().line(line), "{what}: line {line:#x}");
            }
            // Each line that was written has its cycle, in the order of the lines.
            let outcome = done.outcome();
            let cycles: Vec<u64> = outcome.write_cycles.iter().flatten().copied().collect();
            assert_eq!(cycles.len(), outcome.lines.iter().flatten().count(), "{what}");
            assert!(cycles.is_sorted() && cycles.iter().all(|&cycle| cycle < outcome.cycles), "{what}: {cycles:?}");
            let (got, got_too) = (done.retrieve().unwrap(), done_too.retrieve().unwrap());
            assert_eq!(got.results().contacts, got_too.results().contacts, "{what}");
            let pairs = Set::Random(count).pairs(count);
            (one, other) = (got.send_next(&pairs).unwrap(), got_too.send_next(&pairs).unwrap());
        }
        std::mem::forget((one, other));
    }
}
