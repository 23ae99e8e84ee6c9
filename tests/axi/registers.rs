//! The registers, as a host sees them over AXI4-Lite.

use contact_afu::afu::JobError;
use contact_afu::afu::shell::axi::map::{self, Access};
use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Input, Results};
use contact_afu::cosim::axi::Machine;
use contact_afu::link::axi::Handshake;

use crate::bench::{config, machine, model};

/// Runs an empty job, and waits until it has ended.
fn empty_job(machine: &mut Machine<'_>) {
    machine.write_register(map::COUNT.offset, 0).unwrap();
    machine.write_register(map::CONTROL.offset, map::START.put(1)).unwrap();
    for _ in 0..200 {
        if map::ENDED.get(machine.read_register(map::STATUS.offset).unwrap()) == 1 {
            return;
        }
    }
    panic!("an empty job does not end");
}

#[test]
fn registers_keep_what_is_written_to_their_bytes() {
    let model = model(&config(1, 512));
    let afu = model.instance(3).unwrap();
    let mut machine = machine(&afu, "ideal", Handshake::Free, 3);
    let special = [map::CONTROL, map::INTERRUPT_STATUS, map::SOFT_RESET];
    for register in map::registers(Input::Direct).filter(|register| !special.contains(register)) {
        for word in 0..register.words {
            let at = register.offset + 4 * word;
            let before = machine.read_register(at).unwrap();
            machine.write_register(at, 0x1234_5678).unwrap();
            machine.write_bytes(at, 0xAABB_CCDD, 0b0101).unwrap();
            let wanted = match register.access {
                Access::Read => before,
                _ => {
                    0x12BB_56DD
                        & register.fields.iter().map(|field| field.put(u32::MAX)).fold(0, |all, bits| all | bits)
                        | if register.fields.is_empty() { 0x12BB_56DD } else { 0 }
                }
            };
            assert_eq!(machine.read_register(at).unwrap(), wanted, "{}", register.name);
        }
    }
    // Nothing is between the registers and behind them.
    for offset in [0x30, 0x3C, 0xA8, 0xFFC] {
        machine.write_register(offset, u32::MAX).unwrap();
        assert_eq!(machine.read_register(offset).unwrap(), 0, "{offset:#x}");
    }
    let words: Vec<u128> =
        (0..4).map(|word| machine.read_register(map::IDENTITY.offset + 4 * word).unwrap().into()).collect();
    assert_eq!(words.iter().rev().fold(0, |id, word| id << 32 | word), map::AFU_ID);
}

/// The cycles of PORTS.md's diagram: a response comes two cycles after what it answers.
#[test]
fn an_access_takes_three_cycles() {
    let model = model(&config(1, 512));
    let afu = model.instance(6).unwrap();
    let mut machine = machine(&afu, "ideal", Handshake::Free, 6);
    machine.hesitates = false;
    // The first one after the reset waits for the slave.
    machine.write_register(map::SCRATCH.offset, 0).unwrap();
    for _ in 0..3 {
        let before = machine.cycle();
        machine.write_register(map::SCRATCH.offset, 1).unwrap();
        let between = machine.cycle();
        machine.read_register(map::SCRATCH.offset).unwrap();
        assert_eq!((between - before, machine.cycle() - between), (3, 3));
    }
}

#[test]
fn control_is_that_of_ap_ctrl_hs() {
    let model = model(&config(1, 512));
    let afu = model.instance(4).unwrap();
    let mut machine = machine(&afu, "ideal", Handshake::Free, 4);
    let control = |machine: &mut Machine<'_>| machine.read_register(map::CONTROL.offset).unwrap();
    let idle = map::IDLE.put(1);
    assert_eq!(control(&mut machine), idle);
    empty_job(&mut machine);
    // A read of the control register clears what it shows; a read of the status does not.
    assert_eq!(control(&mut machine), idle | map::DONE.put(1) | map::READY.put(1));
    assert_eq!(control(&mut machine), idle);
    let status = machine.read_register(map::STATUS.offset).unwrap();
    assert_eq!((map::ENDED.get(status), map::ERROR.get(status), map::BUSY.get(status)), (1, 0, 0));
    // A mode that is unknown, in its upper bits too.
    for mode in [1, 1 << 31] {
        machine.write_register(map::MODE.offset, mode).unwrap();
        empty_job(&mut machine);
        let status = machine.read_register(map::STATUS.offset).unwrap();
        assert_eq!(map::ERROR.get(status), u32::from(JobError::Mode.code()));
    }
    assert_eq!(machine.read_register(map::JOBS.offset).unwrap(), 3);
}

#[test]
fn the_interrupt_follows_its_three_registers() {
    let model = model(&config(1, 512));
    let afu = model.instance(5).unwrap();
    let mut machine = machine(&afu, "ideal", Handshake::Free, 5);
    let (done, ready) = (map::DONE_EVENT.put(1), map::READY_EVENT.put(1));
    let events = |machine: &mut Machine<'_>| machine.read_register(map::INTERRUPT_STATUS.offset).unwrap();
    empty_job(&mut machine);
    assert_eq!((events(&mut machine), machine.interrupt()), (0, false), "no event is enabled");
    machine.write_register(map::INTERRUPT_ENABLE.offset, done).unwrap();
    empty_job(&mut machine);
    assert_eq!((events(&mut machine), machine.interrupt()), (done, false), "interrupts are not enabled");
    machine.write_register(map::GLOBAL_INTERRUPT_ENABLE.offset, 1).unwrap();
    machine.advance(4).unwrap();
    assert!(machine.interrupt());
    machine.write_register(map::INTERRUPT_STATUS.offset, done).unwrap();
    machine.advance(4).unwrap();
    assert_eq!((events(&mut machine), machine.interrupt()), (0, false));
    machine.write_register(map::INTERRUPT_ENABLE.offset, done | ready).unwrap();
    empty_job(&mut machine);
    assert_eq!((events(&mut machine), machine.interrupt()), (done | ready, true));
    // A written 1 toggles.
    machine.write_register(map::INTERRUPT_STATUS.offset, ready).unwrap();
    assert_eq!(events(&mut machine), done);
    machine.write_register(map::INTERRUPT_STATUS.offset, done | ready).unwrap();
    assert_eq!(events(&mut machine), ready);
}

/// REGISTERS.md names the registers that a job of each kind needs: where the number of results is not known before, how
/// many lines there is room for.
#[test]
fn the_steps_of_a_job_name_what_it_needs() {
    for (results, needs_room) in [(Results::All, false), (Results::Hits, true)] {
        let files = Afu::generate(Spec::from(Config { results, ..config(1, 512) })).unwrap().files();
        let (_, text) = files.iter().find(|(name, _)| name == "REGISTERS.md").unwrap();
        let step = text.lines().find(|line| line.starts_with("3. Write")).unwrap();
        assert_eq!(step.contains("`destination_lines` (0x24)"), needs_room, "{step}");
        let others =
            ["`source` (0x10)", "`destination` (0x18)", "`count` (0x20)", "`mode` (0x28)", "`watchdog` (0x2C)"];
        assert!(others.iter().all(|register| step.contains(register)), "{step}");
    }
}
