//! Jobs one after another: nothing of a job reaches the next. Registers that are written while a job runs are the next
//! job's, and a start while a job runs is none.

use contact_afu::afu::shell::axi::map;
use contact_afu::cosim::axi::Machine;
use contact_afu::host::{HostError, Session};
use contact_afu::link::axi::Handshake;

use crate::bench::{Case, config, end, machine, model, run, session};

const SCPUS: u32 = 3;
/// Byte addresses of the buffers of two jobs.
const OLD: [u64; 2] = [0x1_0000_0FC0, 0x1_0001_0040];
const NEW: [u64; 2] = [0x2_0000_0000, 0x2_0001_0FC0];

/// The interval between the start of a job and its interrupt does not depend on what was before.
#[test]
fn a_job_takes_as_long_whenever_it_starts() {
    let case = Case::random(20, 41);
    let config = config(SCPUS, 512);
    let model = model(&config);
    let afu = model.instance(1).unwrap();
    let mut session = session(machine(&afu, "ideal", Handshake::Free, 1), &config, case.workspace(0, 0));
    session.transport_mut().hesitates = false;
    let mut loaded = session.transaction().send(&case.pairs).unwrap();
    let mut cycles = Vec::new();
    for pause in [0, 0, 0, 1, 7, 31, 32, 33, 600, 0] {
        loaded.transport_mut().advance(pause).unwrap();
        let done = end(loaded).unwrap();
        let outcome = done.outcome();
        case.check(&outcome, "a job after another");
        cycles.push(outcome.cycles);
        loaded = done.send_next(&case.pairs).unwrap();
    }
    assert!(cycles.iter().all(|one| *one == cycles[0]), "{cycles:?}");
}

/// More transactions than there are epochs, each with its soft reset.
#[test]
fn many_in_a_row() {
    let (config, large) = (config(SCPUS, 128), Case::random(3000, 6));
    let model = model(&config);
    let afu = model.instance(6).unwrap();
    let machine = machine(&afu, "shuffled", Handshake::Free, 6);
    let mut session: Session<Machine<'_>> = session(machine, &config, large.workspace(63, 1));
    for count in (1..40).chain([3000]) {
        let case = Case::random(count, count);
        case.check(&run(&mut session, &case).unwrap(), &format!("{count} pairs"));
    }
}

fn write(machine: &mut Machine<'_>, register: map::Register, value: u64) {
    for word in 0..register.words {
        machine.write_register(register.offset + 4 * word, (value >> (32 * word)) as u32).unwrap();
    }
}

/// The registers of a job.
fn write_job(machine: &mut Machine<'_>, case: &Case, [source, destination]: [u64; 2], mode: u64) {
    write(machine, map::SOURCE, source);
    write(machine, map::DESTINATION, destination);
    write(machine, map::COUNT, case.pairs.len() as u64);
    write(machine, map::MODE, mode);
}

fn put(machine: &mut Machine<'_>, case: &Case, [source, _]: [u64; 2]) {
    let memory = &mut machine.memory_mut().link_mut().memory;
    (source / 64..).zip(case.source()).for_each(|(at, line)| memory.set(at, &line));
}

fn start(machine: &mut Machine<'_>) {
    write(machine, map::CONTROL, map::START.put(1).into());
}

/// Waits for the end of a job. Returns its error.
#[track_caller]
fn ended(machine: &mut Machine<'_>, what: &str) -> u32 {
    for _ in 0..10_000 {
        let status = machine.read_register(map::STATUS.offset).unwrap();
        if map::ENDED.get(status) == 1 {
            return map::ERROR.get(status);
        }
    }
    panic!("{what}: it does not end");
}

/// The case's results that are in memory, from the first one on.
fn results(machine: &Machine<'_>, case: &Case, [_, destination]: [u64; 2]) -> usize {
    let memory = &machine.memory().link().memory;
    (destination / 64..).zip(case.wanted()).take_while(|&(at, line)| memory.get(at) == Some(line)).count()
}

/// Registers that are written while a job runs are those of the next job alone, whenever they are written; an unknown
/// mode among them ends the next job.
#[test]
fn registers_written_again_count_from_the_next_job_on() {
    let (old, new) = (Case::random(60, 42), Case::random(33, 43));
    let model = model(&config(SCPUS, 256));
    for moment in (0..160).step_by(3) {
        let what = format!("after {moment} cycles");
        let afu = model.instance(moment).unwrap();
        let mut machine = machine(&afu, "late", Handshake::Free, moment);
        machine.hesitates = false;
        put(&mut machine, &old, OLD);
        put(&mut machine, &new, NEW);
        write_job(&mut machine, &old, OLD, 0);
        start(&mut machine);
        machine.advance(moment).unwrap();
        let mode = moment % 2;
        write_job(&mut machine, &new, NEW, mode);
        assert_eq!(ended(&mut machine, &what), 0, "{what}");
        assert_eq!((results(&machine, &old, OLD), results(&machine, &new, NEW)), (old.wanted().len(), 0), "{what}");
        start(&mut machine);
        let (error, lines) = if mode == 0 { (0, new.wanted().len()) } else { (5, 0) };
        assert_eq!(ended(&mut machine, &what), error, "{what}");
        assert_eq!(results(&machine, &new, NEW), lines, "{what}");
    }
}

/// A start while a job runs is none; when the job has ended, it is one.
#[test]
fn a_start_while_a_job_runs_is_none() {
    let case = Case::random(9, 44);
    let model = model(&config(SCPUS, 512));
    for moment in 0.. {
        let what = format!("after {moment} cycles");
        let afu = model.instance(moment).unwrap();
        let mut machine = machine(&afu, "late", Handshake::Free, moment);
        machine.hesitates = false;
        put(&mut machine, &case, OLD);
        write_job(&mut machine, &case, OLD, 0);
        start(&mut machine);
        machine.advance(moment).unwrap();
        start(&mut machine);
        assert_eq!(ended(&mut machine, &what), 0, "{what}");
        // If the second start was one, its job may still run.
        machine.advance(500).unwrap();
        let busy = map::BUSY.get(machine.read_register(map::STATUS.offset).unwrap());
        assert_eq!((busy, results(&machine, &case, OLD)), (0, case.wanted().len()), "{what}");
        match machine.read_register(map::JOBS.offset).unwrap() {
            1 => assert!(moment < 1_000, "{what}: the job is over"),
            jobs => {
                assert!(moment > 60 && jobs == 2, "{what}: {jobs} jobs");
                break;
            }
        }
    }
}

/// What is no job ends with an error, and the next one is right. An accelerator of another size is refused.
#[test]
fn what_is_no_job_ends_with_an_error_and_the_next_is_right() {
    let (case, config) = (Case::random(57, 3), config(2, 128));
    let model = model(&config);
    let afu = model.instance(4).unwrap();
    let mut first = session(machine(&afu, "shuffled", Handshake::Free, 4), &config, case.workspace(3, 9));
    let mut loaded = first.transaction().send(&case.pairs).unwrap();
    for mode in [1, 2, 15, 16, 1 << 31] {
        loaded.transport_mut().write_register(map::MODE.offset, mode).unwrap();
        start(loaded.transport_mut());
        assert_eq!(ended(loaded.transport_mut(), "an unknown mode"), 5);
        write(loaded.transport_mut(), map::INTERRUPT_STATUS, map::DONE_EVENT.put(1).into());
        let done = end(loaded).unwrap();
        case.check(&done.outcome(), "after an error");
        loaded = done.send_next(&case.pairs).unwrap();
    }
    std::mem::forget(loaded);
    let other = crate::bench::config(3, 128);
    let mut other = session(machine(&afu, "shuffled", Handshake::Free, 4), &other, case.workspace(3, 9));
    let what = "SCPUs";
    assert_eq!(run(&mut other, &case).unwrap_err(), HostError::Capability { what, expected: 3, found: 2 });
}
