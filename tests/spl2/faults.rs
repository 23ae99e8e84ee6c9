//! Faults planted in the shell's Verilog are found. One model has all of them: which one is at work, the uppermost bits
//! of the job's watchdog say.

use contact_afu::cosim::spl2::{MachineError, Place, Session};
use contact_afu::cosim::{Job, Model};
use contact_afu::link::spl2::{Spl2Error, Spl2Model};

use crate::bench::{Case, build, files, machine, quick, rough};

/// What is planted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u32)]
enum Planted {
    Nothing,
    /// Reads go out while SPL's queue is almost full.
    AlmostFullIgnored,
    /// Of two acknowledgements in a cycle the second is lost.
    SecondChannelLost,
    /// No fence before the status.
    NoFence,
    /// Every job has the same epoch.
    EpochStuck,
    /// The DSM's lines are written by a virtual address.
    VirtualDsm,
    /// The control memory is taken for pairs.
    SourceOff,
}

/// File, the assignment's left side, the fault, and what is assigned then.
const FAULTS: [(&str, &str, Planted, &str); 7] = [
    ("spl2_transmit.v", " core_rd_turn <= ", Planted::AlmostFullIgnored, "discards | ~own_rd_valid"),
    ("spl2_acknowledge.v", "wire core_s_1 = ", Planted::SecondChannelLost, "valid_1 & ~valid_0 & ~|mdata_1[13:12]"),
    ("spl2_sequence.v", "wire written = ", Planted::NoFence, "wr_granted | (to_dsm & ~dsm_valid) | at_fence"),
    ("spl2_sequence.v", " writes <= ", Planted::NoFence, "((to_dsm & dsm_valid) | at_status) & ~written"),
    ("spl2_transmit.v", "wire [5:0] next_epoch = ", Planted::EpochStuck, "6'd0"),
    ("spl2_sequence.v", " wr_virtual <= ", Planted::VirtualDsm, "1'b1"),
    ("spl2_sequence.v", "wire [57:0] first_pairs = ", Planted::SourceOff, "source_line"),
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

fn job(case: &Case, planted: Planted) -> Job<'_> {
    Job { watchdog: (planted as u32) << SELECTOR_BIT, max_cycles: Some(20_000), ..case.job() }
}

#[test]
fn faults_of_the_shell_are_found() {
    let case = Case::random(301, 3);
    let model = model_of_faults();
    let run = |planted: Planted, spl: Spl2Model, link: &str| {
        let afu = model.instance(1).unwrap();
        let mut machine = machine(&afu, spl, link, 1);
        let mut session = Session::open(&mut machine, case.place(), Some(2)).unwrap();
        session.run(&job(&case, planted)).map(|outcome| case.is_right(&outcome))
    };
    let protocol = |found: Result<bool, MachineError>, wanted: fn(&Spl2Error) -> bool| match found {
        Err(MachineError::Protocol { what, .. }) => assert!(wanted(&what), "{what}"),
        other => panic!("{other:?}"),
    };
    assert_eq!(run(Planted::Nothing, rough(), "shuffled"), Ok(true));
    protocol(run(Planted::AlmostFullIgnored, rough(), "ideal"), |what| matches!(what, Spl2Error::Overshoot { .. }));
    let lost = run(Planted::SecondChannelLost, rough(), "ideal");
    assert!(matches!(lost, Err(MachineError::NoStatus { .. })), "{lost:?}");
    protocol(run(Planted::VirtualDsm, quick(), "ideal"), |what| {
        matches!(what, Spl2Error::Outside { what: "write", .. } | Spl2Error::PageFault { .. })
    });
    assert_eq!(run(Planted::SourceOff, quick(), "ideal"), Ok(false));
}

/// Without the fence the status overtakes a line of the DSM, sooner or later.
#[test]
fn a_missing_fence_is_found() {
    let case = Case::random(5, 3);
    let model = model_of_faults();
    let overtakes = |planted: Planted| {
        (1..30).any(|seed| {
            let afu = model.instance(seed).unwrap();
            let mut machine = machine(&afu, quick(), "shuffled", seed);
            let mut session = Session::open(&mut machine, case.place(), Some(2)).unwrap();
            let before = session.machine().device_writes().len();
            session.run(&job(&case, planted)).unwrap();
            session.machine().device_writes().len() - before < 3
        })
    };
    assert!(!overtakes(Planted::Nothing));
    assert!(overtakes(Planted::NoFence));
}

/// Epochs that stand still: what a reset left behind is taken for this job's.
#[test]
fn an_epoch_that_stands_still_is_found() {
    let (spoilt, next) = (Case::random(301, 4), Case::random(301, 5));
    let model = model_of_faults();
    let harm = |planted: Planted| {
        let afu = model.instance(1).unwrap();
        let mut machine = machine(&afu, quick(), "hostile", 1);
        (20..400).step_by(20).any(|moment| {
            let mut session = Session::open(&mut machine, spoilt.place(), Some(2)).unwrap();
            session.start(&job(&spoilt, planted));
            session.machine().advance(moment).unwrap();
            let place = Place { pages: 3, source: 40_000, destination: 50_000, ..next.place() };
            let ended = Session::open(&mut machine, place, Some(2)).and_then(|mut s| s.run(&job(&next, planted)));
            !ended.is_ok_and(|outcome| next.is_right(&outcome))
        })
    };
    assert!(!harm(Planted::Nothing));
    assert!(harm(Planted::EpochStuck));
}
