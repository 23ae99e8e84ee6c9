//! The Verilated AFU: compared with its model in software over three links, and with faults of the link.

use std::sync::LazyLock;

use contact_afu::afu::shell::spl2::map::{self, identity, latency, performance, status};
use contact_afu::config::{Config, Results};
use contact_afu::cosim::Instance;
use contact_afu::cosim::spl2::Machine;
use contact_afu::host::{Expected, HostError, Session, Software, Transport, Workspace};
use contact_afu::kernel::Engine;
use contact_afu::link::spl2::{DeviceWrite, Spl2, Spl2Model};
use contact_afu::link::{Description, Fault, Line, Link, LinkModel};
use contact_afu::verify::Bench;

use super::{config, contacts, pairs, session};

fn afu() -> Instance {
    static BENCH: LazyLock<Bench> = LazyLock::new(|| Bench::new(&config()).unwrap());
    BENCH.model().instance(3).unwrap()
}

fn link(name: &str) -> LinkModel {
    name.parse::<Description>().unwrap().at(config().clock_mhz).unwrap()
}

fn machine<'a>(afu: &'a Instance, name: &str, seed: u64) -> Machine<'a> {
    Machine::new(afu, Spl2::new(Spl2Model::default(), Link::new(link(name), seed).unwrap(), seed)).unwrap()
}

/// A line of the DSM without cycle counts, which the software does not have.
fn without_time(number: u64, line: Line) -> Line {
    let mut kept = [0; 16];
    if number == u64::from(map::LATENCY_LINE) {
        latency::SEQUENCE.set(&mut kept, latency::SEQUENCE.get(&line));
    } else if number == u64::from(map::PERFORMANCE_LINE) {
        performance::SEQUENCE.set(&mut kept, performance::SEQUENCE.get(&line));
    } else {
        return line;
    }
    kept
}

/// All memory that both sides share, after a job: the workspace and the DSM.
fn memory<T: Transport>(device: &T, lines: &[u64], dsm: u64) -> (Vec<Option<Line>>, Vec<Option<Line>>) {
    let workspace = lines.iter().map(|&line| device.line(line)).collect();
    let dsm = (0..64).map(|number| Some(without_time(number, device.line(dsm + number)?))).collect();
    (workspace, dsm)
}

/// Writes of identities and statuses, in order.
fn statuses(log: &[DeviceWrite]) -> Vec<(u64, Line)> {
    let ours = |line: &Line| [identity::AFU_ID.get(line), status::AFU_ID.get(line)].contains(&map::AFU_ID);
    log.iter().filter(|write| ours(&write.data)).map(|write| (write.address, write.data)).collect()
}

/// Runs the same transactions on both devices: every byte and every write is equal, over three links.
#[test]
fn software_and_verilog_write_the_same() {
    let afu = afu();
    for (name, seed) in [("ideal", 1), ("harp1", 2), ("hostile", 3)] {
        let mut hardware = session(machine(&afu, name, seed), 1);
        let mut software = session(Software::new(&config(), link(name)).unwrap(), 1);
        let workspace = hardware.workspace().clone();
        let first = workspace.context();
        let lines: Vec<u64> = (0..32_768).map(|line| workspace.physical(first + 64 * line).unwrap()).collect();
        for count in [0, 1, 2, 3, 257, 1000] {
            let pairs = pairs(count);
            let one = hardware.transaction().send(&pairs).unwrap().start().unwrap().confirm().unwrap();
            let one = one.wait().unwrap().retrieve().unwrap();
            let other = software.transaction().send(&pairs).unwrap().start().unwrap().confirm().unwrap();
            let other = other.wait().unwrap().retrieve().unwrap();
            let dsm = other.transport().device_writes()[0].address;
            let (one_memory, other_memory) =
                (memory(one.transport(), &lines, dsm), memory(other.transport(), &lines, dsm));
            for (number, (one, other)) in one_memory.0.iter().zip(&other_memory.0).enumerate() {
                assert_eq!(one, other, "{name}, {count} pairs: line {number} of the workspace");
            }
            assert_eq!(one_memory.1, other_memory.1, "{name}, {count} pairs: the DSM");
            let (one, other) = (one.end().unwrap(), other.end().unwrap());
            assert_eq!(one.contacts, contacts(&pairs));
            assert_eq!((one.contacts, one.hits, one.invalid), (other.contacts, other.hits, other.invalid));
            assert_eq!(one.first_invalid, other.first_invalid);
        }
        let (one, other) = (hardware.transport().device_writes(), software.transport().device_writes());
        assert_eq!(statuses(one), statuses(other), "{name}: the order of what says who and when");
        assert_eq!(statuses(one).len(), 12, "an identity and a status for each of six");
    }
}

/// Ninety thousand pairs over harp1, with registers, control memory, fence and status.
#[test]
fn harp1_carries_what_it_allows() {
    let afu = afu();
    let mut session = session(machine(&afu, "harp1", 1), 3);
    let pairs = pairs(90_000);
    assert_eq!(session.contacts(&pairs).unwrap(), contacts(&pairs));
    let [report] = session.reports() else { panic!("one transaction") };
    assert!((0.95..=1.0).contains(&report.efficiency()), "{report:?}");
    assert!(report.stated_set_up == 400 && report.set_up > 9 * 145, "{report:?}");
    println!("{report:?}: {:.2} ns a pair", report.stated_ns(200.0) / 90_000.0);
}

/// Only contacts come back, job after job: both devices write the same lines, and the cycle of each line is known.
#[test]
fn hits_come_back_and_each_line_has_its_cycle() {
    let config = Config { scpus: 3, profile: "e8f3z".parse().unwrap(), results: Results::Hits, ..config() };
    let bench = Bench::new(&config).unwrap();
    let afu = bench.model().instance(3).unwrap();
    let expected = Expected::new(&config).unwrap();
    let workspace = || Workspace::new(expected.layout, 1, 7).unwrap();
    let mut hardware = Session::new(machine(&afu, "harp1", 3), workspace(), expected);
    let mut software = Session::new(Software::new(&config, link("harp1")).unwrap(), workspace(), expected);
    let mut loaded = hardware.transaction().send(&[]).unwrap();
    for count in [301, 0, 1000] {
        let pairs = pairs(count);
        let done = loaded.start().unwrap().confirm().unwrap().wait().unwrap();
        let retrieved = done.send_next(&pairs).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
        let outcome = retrieved.outcome();
        let retrieved = retrieved.retrieve().unwrap();
        let other = software.transaction().send(&pairs).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
        assert_eq!(outcome.lines, other.outcome().lines, "{count}");
        let results = retrieved.results();
        let touching: Vec<bool> = config.reference().run_all(&pairs).iter().map(|one| one.is_contact()).collect();
        assert_eq!(results.by_pair().iter().map(|one| one.is_contact()).collect::<Vec<_>>(), touching, "{count}");
        let written = outcome.write_cycles.iter().map(Option::is_some);
        assert!(written.eq(outcome.lines.iter().map(Option::is_some)), "{count}");
        let cycles: Vec<u64> = outcome.write_cycles.iter().flatten().copied().collect();
        assert!(cycles.is_sorted() && cycles.iter().all(|&cycle| (50..outcome.cycles).contains(&cycle)), "{cycles:?}");
        loaded = retrieved.send_next(&[]).unwrap();
    }
}

/// If the response of a read is lost, there is a timeout and never data. The next transaction succeeds.
#[test]
fn a_lost_response_is_a_time_out_and_the_next_transaction_is_right() {
    let afu = afu();
    let pairs = pairs(500);
    let mut session = session(machine(&afu, "harp1", 4), 1);
    session.transport_mut().spl_mut().link_mut().plan(&[Fault::ReadLost(9)]);
    let error = session.run(&pairs).unwrap_err();
    assert!(matches!(error, HostError::NoStatus { reads: 1.., .. }), "{error}");
    session.transport_mut().spl_mut().link_mut().plan(&[]);
    assert_eq!(session.run(&pairs).unwrap(), contacts(&pairs), "after {error}");
}

#[test]
fn an_abort_and_a_drop_in_mid_job_leave_the_next_transaction_right() {
    let afu = afu();
    let pairs = pairs(4000);
    let mut session = session(machine(&afu, "harp1", 5), 1);
    let mut running = session.transaction().send(&pairs).unwrap().start().unwrap().confirm().unwrap();
    running.idle(1500).unwrap();
    running.abort().unwrap();
    let error = running.wait().unwrap().retrieve().unwrap_err();
    assert!(matches!(error, HostError::Job { code: 1, .. }), "{error}");
    assert_eq!(session.run(&pairs).unwrap(), contacts(&pairs));
    let mut running = session.transaction().send(&pairs).unwrap().start().unwrap().confirm().unwrap();
    running.idle(1500).unwrap();
    drop(running);
    assert_eq!(session.run(&pairs).unwrap(), contacts(&pairs));
}

/// More transactions than there are epochs, with pages that are far apart.
#[test]
fn many_in_a_row_in_two_gigabytes() {
    let afu = afu();
    let mut session: Session<Machine> = session(machine(&afu, "ideal", 6), 1024);
    for count in (1..40).chain([3000]) {
        let pairs = pairs(count);
        assert_eq!(session.run(&pairs).unwrap(), contacts(&pairs), "{count}");
    }
    assert_eq!(session.reports().len(), 40);
}
