//! All combinations of numbers of SCPUs, counts of pairs, links and variants of SPL2; the AFU's writes and their order.

use contact_afu::afu::shell::spl2;
use contact_afu::afu::shell::spl2::map::{self, control, identity, latency, performance, scratch, status};
use contact_afu::config::Input;
use contact_afu::host::{HostError, Transport};
use contact_afu::link::LinkModel;
use contact_afu::link::spl2::Spl2Model;

use crate::bench::{Case, end, machine, model, quick, rough, run, session};

#[test]
fn jobs_one_after_another_over_every_link() {
    let cases = [177, 0, 1, 2, 3, 1_001].map(|count| Case::random(count, count + 5));
    for scpus in [1, 2, 3] {
        let model = model(scpus);
        for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
            for (name, spl) in [("as it is", Spl2Model::default()), ("rough", rough())] {
                let afu = model.instance(seed).unwrap();
                let mut session = session(machine(&afu, spl, link, seed), scpus, cases[5].workspace(1));
                let mut loaded = session.transaction().send(&cases[0].pairs).unwrap();
                for (number, case) in cases.iter().enumerate() {
                    let what = format!("{scpus} SCPUs, {link}, SPL2 {name}, {} pairs", case.pairs.len());
                    let done = end(loaded).unwrap_or_else(|e| panic!("{what}: {e}"));
                    case.check(&done.outcome(), &what);
                    loaded = done.send_next(&cases[(number + 1) % cases.len()].pairs).unwrap();
                }
                drop(loaded);
                let seen = session.transport().spl().seen();
                assert!(seen.on_both > 0, "{link}, {name}: acknowledgements came on both channels at once");
                if name == "rough" {
                    // SPL accepts four.
                    assert!(seen.after_almostfull > 0 && seen.most_after <= 2, "{link}: {seen:?}");
                }
            }
        }
    }
}

/// The device's writes at a job's end: latency, performance, status, in this order on every link.
#[test]
fn lines_of_the_dsm_come_in_order_and_before_the_status() {
    let case = Case::random(57, 3);
    let model = model(2);
    for seed in 1..20 {
        let afu = model.instance(seed).unwrap();
        let mut session = session(machine(&afu, quick(), "hostile", seed), 2, case.workspace(1));
        let mut loaded = session.transaction().send(&case.pairs).unwrap();
        for job in 0..3 {
            let before = loaded.transport().device_writes().len();
            let done = end(loaded).unwrap();
            case.check(&done.outcome(), "hostile");
            let writes = &done.transport().device_writes()[before..];
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
            loaded = done.send_next(&case.pairs).unwrap();
        }
    }
}

#[test]
fn the_registers_are_answered_in_the_dsm() {
    let model = model(2);
    let afu = model.instance(4).unwrap();
    let mut machine = machine(&afu, Spl2Model::default(), "late", 4);
    let dsm = (7 << 32 | 0x3000) / 64;
    machine.spl_mut().watch(dsm..dsm + map::DSM_BYTES / 64);
    machine.write_csr(map::SCRATCH.offset, 0x1234_5678).unwrap();
    machine.advance(500).unwrap();
    assert!(machine.device_writes().is_empty(), "nobody said where");
    machine.write_csr(map::DSM_BASE_HIGH.offset, 7).unwrap();
    machine.write_csr(map::DSM_BASE_LOW.offset, 0x3000).unwrap();
    machine.advance(500).unwrap();
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
    let workspace = case.workspace(1);
    let control = workspace.physical(workspace.source()).unwrap();
    let mut session = session(machine(&afu, quick(), "shuffled", 4), 2, workspace);
    let beyond = 2 * case.room() - 1;
    let mut loaded = session.transaction().send(&case.pairs).unwrap();
    for (field, value, error) in [(control::MODE, 1, 5), (control::COUNT, beyond, 8), (control::COUNT, u32::MAX, 8)] {
        let mut started = loaded.start().unwrap();
        let memory = started.transport_mut().memory_mut();
        let mut line = *memory.get(control).unwrap();
        field.set(&mut line, value.into());
        memory.set(control, &line);
        let done = started.confirm().unwrap().wait().unwrap();
        let outcome = done.outcome();
        assert_eq!((outcome.error, outcome.contacts, outcome.invalid, outcome.first_invalid), (error, 0, 0, None));
        let mut done = end(done.send_next(&case.pairs).unwrap()).unwrap();
        case.check(&done.outcome(), "after an error");
        // Neither a repeated sequence number nor a line without the start word starts a job.
        let before = done.transport().device_writes().len();
        done.transport_mut().advance(2_000).unwrap();
        loaded = done.send_next(&case.pairs).unwrap();
        loaded.transport_mut().advance(2_000).unwrap();
        assert_eq!(loaded.transport().device_writes().len(), before);
    }
    drop(loaded);
    let mut other = crate::bench::session(machine(&afu, quick(), "shuffled", 4), 3, case.workspace(1));
    let what = "SCPUs";
    assert_eq!(run(&mut other, &case).unwrap_err(), HostError::Capability { what, expected: 3, found: 2 });
}

/// `docs/spl2.md` ends with the memory map that the hardware implements.
#[test]
fn the_map_in_the_documentation_is_the_hardware_s() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/spl2.md");
    let text = std::fs::read_to_string(page).unwrap();
    let (before, found) = text.split_once("\n## Map\n\n").expect("a section of that name");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(page, format!("{before}\n## Map\n\n{}", spl2::markdown(Input::Direct))).unwrap();
    } else {
        assert!(found == spl2::markdown(Input::Direct), "run this test again with UPDATE_EXPECT=1");
    }
}
