//! Faults planted in the shell's Verilog are found. One model contains all of them; the top bits of the job's watchdog
//! select one.

use contact_afu::cosim::Model;
use contact_afu::cosim::spl2::Machine;
use contact_afu::host::{HostError, Session, Transport, TransportError, Workspace};
use contact_afu::link::spl2::{Spl2Error, Spl2Model};

use crate::bench::{Case, build, end, files, machine, quick, rough, run, workspace};

/// The planted faults.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u32)]
enum Planted {
    Nothing,
    /// Reads are sent even if SPL's queue is almost full.
    AlmostFullIgnored,
    /// If two acknowledgements arrive in a cycle, the second is lost.
    SecondChannelLost,
    /// There is no fence before the status.
    NoFence,
    /// Every job has the same epoch.
    EpochStuck,
    /// The lines of the DSM are written to a virtual address.
    VirtualDsm,
    /// The line of the control memory is treated as pairs.
    SourceOff,
}

/// File, left-hand side of the assignment, the fault, and the expression assigned then.
const FAULTS: [(&str, &str, Planted, &str); 7] = [
    ("spl2_transmit.v", " core_rd_turn <= ", Planted::AlmostFullIgnored, "discards | ~own_rd_valid"),
    ("spl2_acknowledge.v", "wire core_s_1 = ", Planted::SecondChannelLost, "valid_1 & ~valid_0 & ~|mdata_1[13:12]"),
    ("spl2_sequence.v", "wire written = ", Planted::NoFence, "wr_granted | (to_dsm & ~dsm_valid) | at_fence"),
    (
        "spl2_sequence.v",
        " writes <= ",
        Planted::NoFence,
        "((to_dsm & dsm_valid) | at_status) & ~written & ~leaves_state",
    ),
    ("spl2_transmit.v", " next_epoch <= ", Planted::EpochStuck, "6'd1"),
    ("spl2_sequence.v", " wr_virtual <= ", Planted::VirtualDsm, "1'b1"),
    ("spl2_sequence.v", " first_pairs <= ", Planted::SourceOff, "source_line"),
];

const SELECTOR_BIT: u32 = 28;

fn model_of_faults() -> Model {
    let mut files = files();
    for (name, left, planted, wrong) in FAULTS {
        let file = files.iter_mut().find(|file| file.name == name).unwrap();
        let chosen = format!("afu_top.sequencer.job_watchdog[31:{SELECTOR_BIT}] == 4'd{}", planted as u32);
        let (before, rest) = file.text.split_once(left).unwrap_or_else(|| panic!("{name} has no `{left}`"));
        let (right, after) = rest.split_once(';').unwrap();
        file.text = format!("{before}{left}({chosen}) ? ({wrong}) : ({right});{after}");
    }
    build(files, 2)
}

/// A session in which all jobs have the planted fault.
fn session(machine: Machine<'_>, workspace: Workspace, planted: Planted) -> Session<Machine<'_>> {
    let mut session = crate::bench::session(machine, 2, workspace);
    session.watchdog = (planted as u32) << SELECTOR_BIT;
    session.max_cycles = Some(20_000);
    session
}

#[test]
fn faults_of_the_shell_are_found() {
    let case = Case::random(301, 3);
    let model = model_of_faults();
    let with = |planted: Planted, spl: Spl2Model, link: &str| {
        let afu = model.instance(1).unwrap();
        let mut session = session(machine(&afu, spl, link, 1), case.workspace(1), planted);
        run(&mut session, &case).map(|outcome| case.is_right(&outcome))
    };
    let protocol = |found: Result<bool, HostError>, wanted: fn(&TransportError) -> bool| match found {
        Err(HostError::Transport(error)) => assert!(wanted(&error), "{error}"),
        other => panic!("{other:?}"),
    };
    assert_eq!(with(Planted::Nothing, rough(), "shuffled"), Ok(true));
    protocol(with(Planted::AlmostFullIgnored, rough(), "ideal"), |error| {
        matches!(error, TransportError::Protocol { what: Spl2Error::Overshoot { .. }, .. })
    });
    let lost = with(Planted::SecondChannelLost, rough(), "ideal");
    assert!(matches!(lost, Err(HostError::NoStatus { .. })), "{lost:?}");
    protocol(with(Planted::VirtualDsm, quick(), "ideal"), |error| {
        let outside = matches!(error, TransportError::Protocol { what: Spl2Error::Outside { what: "write", .. }, .. });
        outside || matches!(error, TransportError::PageFault { .. })
    });
    assert_eq!(with(Planted::SourceOff, quick(), "ideal"), Ok(false));
}

/// Without the fence, the status eventually overtakes a line of the DSM.
#[test]
fn a_missing_fence_is_found() {
    let case = Case::random(5, 3);
    let model = model_of_faults();
    let overtakes = |planted: Planted| {
        (1..30).any(|seed| {
            let afu = model.instance(seed).unwrap();
            let mut session = session(machine(&afu, quick(), "shuffled", seed), case.workspace(1), planted);
            let loaded = session.transaction().send(&case.pairs).unwrap();
            let before = loaded.transport().device_writes().len();
            end(loaded).unwrap().transport().device_writes().len() - before < 3
        })
    };
    assert!(!overtakes(Planted::Nothing));
    assert!(overtakes(Planted::NoFence));
}

/// If the epoch does not change, responses from before a reset are taken for this job's.
#[test]
fn an_epoch_that_stands_still_is_found() {
    let (spoilt, next) = (Case::random(301, 4), Case::random(301, 5));
    let model = model_of_faults();
    let harm = |planted: Planted| {
        let afu = model.instance(1).unwrap();
        let mut session = session(machine(&afu, quick(), "hostile", 1), spoilt.workspace(3), planted);
        (20..400).step_by(20).any(|moment| {
            session.set_workspace(spoilt.workspace(3));
            let running = session.transaction().send(&spoilt.pairs).unwrap().start().unwrap().confirm();
            let mut running = running.unwrap();
            running.idle(moment).unwrap();
            // The host is gone without stopping anything.
            std::mem::forget(running);
            session.set_workspace(workspace(3, 40_000, 50_000, next.room()).unwrap());
            !run(&mut session, &next).is_ok_and(|outcome| next.is_right(&outcome))
        })
    };
    assert!(!harm(Planted::Nothing));
    assert!(harm(Planted::EpochStuck));
}
