//! Numbers of SCPUs, counts of pairs, links and kinds of SPL2, each with each; what the AFU writes, and in what order.

use contact_afu::afu::shell::spl2::map::{self, identity, latency, performance, scratch, status};
use contact_afu::cosim::Job;
use contact_afu::cosim::spl2::{MachineError, Session};
use contact_afu::link::LinkModel;
use contact_afu::link::spl2::Spl2Model;

use crate::bench::{Case, machine, model, quick, rough};

#[test]
fn jobs_one_after_another_over_every_link() {
    let cases = [177, 0, 1, 2, 3, 1_001].map(|count| Case::random(count, count + 5));
    for scpus in [1, 2, 3] {
        let model = model(scpus);
        for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
            for (name, spl) in [("as it is", Spl2Model::default()), ("rough", rough())] {
                let afu = model.instance(seed).unwrap();
                let mut machine = machine(&afu, spl, link, seed);
                let mut session = Session::open(&mut machine, cases[5].place(), Some(scpus)).unwrap();
                for case in &cases {
                    let what = format!("{scpus} SCPUs, {link}, SPL2 {name}, {} pairs", case.pairs.len());
                    let outcome = session.run(&case.job()).unwrap_or_else(|e| panic!("{what}: {e}"));
                    case.check(&outcome, &what);
                }
                let seen = machine.spl().seen();
                assert!(seen.on_both > 0, "{link}, {name}: acknowledgements came on both channels at once");
                if name == "rough" {
                    // SPL takes four.
                    assert!(seen.after_almostfull > 0 && seen.most_after <= 2, "{link}: {seen:?}");
                }
            }
        }
    }
}

/// The device's writes at a job's end: latency, performance, status, in this order whatever the link does.
#[test]
fn lines_of_the_dsm_come_in_order_and_before_the_status() {
    let case = Case::random(57, 3);
    let model = model(2);
    for seed in 1..20 {
        let afu = model.instance(seed).unwrap();
        let mut machine = machine(&afu, quick(), "hostile", seed);
        let mut session = Session::open(&mut machine, case.place(), Some(2)).unwrap();
        for job in 0..3 {
            let before = session.machine().device_writes().len();
            let outcome = session.run(&case.job()).unwrap();
            case.check(&outcome, "hostile");
            let writes = &session.machine().device_writes()[before..];
            let (dsm, last) = writes.split_at(writes.len() - 1);
            let mut numbers: Vec<u64> = dsm.iter().map(|write| write.address % 64).collect();
            numbers.sort_unstable();
            assert_eq!(numbers, [map::LATENCY_LINE, map::PERFORMANCE_LINE].map(u64::from), "seed {seed}, job {job}");
            let line_of = |number: u32| dsm.iter().find(|write| write.address % 64 == u64::from(number)).unwrap().data;
            let sequence = status::SEQUENCE.get(&last[0].data);
            assert_eq!(latency::SEQUENCE.get(&line_of(map::LATENCY_LINE)), sequence);
            assert_eq!(performance::SEQUENCE.get(&line_of(map::PERFORMANCE_LINE)), sequence);
            assert_eq!(status::AFU_ID.get(&last[0].data), map::AFU_ID);
            assert_eq!(status::VERSION.get(&last[0].data), map::VERSION.into());
        }
    }
}

#[test]
fn the_registers_are_answered_in_the_dsm() {
    let model = model(2);
    let afu = model.instance(4).unwrap();
    let mut machine = machine(&afu, Spl2Model::default(), "late", 4);
    machine.write_csr(map::SCRATCH.offset, 0x1234_5678).unwrap();
    machine.advance(500).unwrap();
    assert!(machine.device_writes().is_empty(), "nobody said where");
    machine.write_csr(map::DSM_BASE_HIGH.offset, 7).unwrap();
    machine.write_csr(map::DSM_BASE_LOW.offset, 0x3000).unwrap();
    machine.advance(500).unwrap();
    let dsm = (7 << 32 | 0x3000) / 64;
    let line = *machine.memory().get(dsm).unwrap();
    assert_eq!((identity::AFU_ID.get(&line), identity::VERSION.get(&line)), (map::AFU_ID, map::VERSION.into()));
    assert_eq!(identity::CAPABILITY.get(&line) & 0xff, 2);
    let at = dsm + u64::from(map::SCRATCH_LINE);
    assert_eq!(scratch::VALUE.get(machine.memory().get(at).unwrap()), 0x1234_5678);
    machine.write_csr(map::SCRATCH.offset, 9).unwrap();
    machine.advance(500).unwrap();
    assert_eq!(scratch::VALUE.get(machine.memory().get(at).unwrap()), 9);
    assert_eq!(machine.device_writes().len(), 3);
}

#[test]
fn what_is_no_job_ends_with_an_error_and_the_next_is_right() {
    let case = Case::random(57, 3);
    let afu = model(2).instance(4).unwrap();
    let mut machine = machine(&afu, quick(), "shuffled", 4);
    let mut session = Session::open(&mut machine, case.place(), Some(2)).unwrap();
    let beyond = 2 * case.place().lines - 1;
    for (job, error) in [
        (Job { mode: 1, ..case.job() }, 5),
        (Job { pairs: beyond, ..case.job() }, 8),
        (Job { pairs: u32::MAX, ..case.job() }, 8),
    ] {
        let outcome = session.run(&job).unwrap();
        assert_eq!((outcome.error, outcome.contacts, outcome.invalid, outcome.first_invalid), (error, 0, 0, None));
        case.check(&session.run(&case.job()).unwrap(), "after an error");
    }
    // Neither the same number again nor a line without the start word is a job.
    let before = session.machine().device_writes().len();
    session.machine().advance(2_000).unwrap();
    assert_eq!(session.machine().device_writes().len(), before);
    let other = Session::open(&mut machine, case.place(), Some(3)).unwrap_err();
    assert_eq!(other, MachineError::Scpus { expected: 3, found: 2 });
}

/// `docs/spl2.md` ends with the map as the hardware has it.
#[test]
fn the_map_in_the_documentation_is_the_hardware_s() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/spl2.md");
    let text = std::fs::read_to_string(page).unwrap();
    let (before, found) = text.split_once("\n## Map\n\n").expect("a section of that name");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(page, format!("{before}\n## Map\n\n{}", map::markdown())).unwrap();
    } else {
        assert!(found == map::markdown(), "run this test again with UPDATE_EXPECT=1");
    }
}
