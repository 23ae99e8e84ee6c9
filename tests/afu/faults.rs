//! Each comparison can fail: faults planted in the Verilog or on the link are found, and the unchanged Verilog passes.

use std::fs;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::Config;
use contact_afu::cosim::drive::{DriveError, ProtocolError};
use contact_afu::cosim::{Driver, File, Job, Model, Outcome, Source, Trace};
use contact_afu::link::{Direction, Fault, Link, LinkModel, Order};
use contact_afu::pairs::Set;
use contact_afu::verify::{Bench, Verdict};

use crate::bench::{Case, committed, config, driver, of, source, with_scpus};

/// Changes the right-hand side of the only assignment in `text` whose line contains `left`.
fn change(text: &str, left: &str, right: impl Fn(&str) -> String) -> String {
    assert_eq!(text.lines().filter(|line| line.contains(left)).count(), 1, "one line with `{left}` in\n{text}");
    let edit = |line: &str| match line.split_once("= ").filter(|_| line.contains(left)) {
        Some((target, value)) => format!("{target}= {};\n", right(value.trim_end_matches(';'))),
        None => format!("{line}\n"),
    };
    text.lines().map(edit).collect()
}

/// Does what `afu cosim --rtl` does with a folder that `afu rtl` wrote, after changing one line.
fn verdict(config: &Config, file: &str, left: &str, right: impl Fn(&str) -> String) -> Verdict {
    let folder = tempfile::tempdir().unwrap();
    let files = Afu::generate(Spec::from(config.clone())).unwrap().files();
    assert!(files.iter().any(|(name, _)| name == file), "there is no {file}");
    for (name, text) in files {
        let text = if name == file { change(&text, left, &right) } else { text };
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let bench = Bench::of_folder(folder.path(), None, Trace::Off).unwrap();
    bench.run(&Set::Random(2_000).pairs(1), &LinkModel::shuffled(), 1).unwrap()
}

#[test]
fn a_wrong_gate_a_wrong_rounding_and_a_flipped_bit_are_mismatches() {
    let config = config(2, "bfloat", "depth");
    let right = verdict(&config, "fp_square_e8f7.v", "wire round_up = ", str::to_owned);
    assert!(right.is_good(), "without a fault: {:?} {:?}", right.mismatches.first(), right.failed_checks);
    // Faults: a square that truncates; a different kind of gate; a subtrahend whose lowest bit is flipped.
    let truncated = verdict(&config, "fp_square_e8f7.v", "wire round_up = ", |_| "1'b0".to_owned());
    let gate = verdict(&config, "fp_sub_e8f7.v", "wire effective_subtraction = ", |value| value.replace('^', "|"));
    let flipped = verdict(&config, "fp_sub_e8f7.v", " addend = ", |value| format!("({value}) ^ 1"));
    for (what, verdict) in [("truncated", truncated), ("gate", gate), ("flipped", flipped)] {
        assert!(!verdict.mismatches.is_empty() && !verdict.is_good(), "{what}");
        // Only some pairs are affected: most do not trigger the fault, and their results are right.
        assert!(verdict.mismatches.len() < 1_500, "{what}: {}", verdict.mismatches.len());
    }
}

/// How a fault was detected.
#[derive(Debug, PartialEq)]
pub enum Found {
    Nothing,
    /// This many destination lines differ from the reference's.
    WrongLines(usize),
    /// All lines are right, but other figures are not.
    WrongStatus,
    /// The job violates the protocol or does not end.
    Error(DriveError),
}

pub fn judge(case: &Case, outcome: Result<Outcome, DriveError>) -> Found {
    match outcome {
        Err(error) => Found::Error(error),
        Ok(outcome) => match case.wrong_lines(&outcome).len() {
            0 if case.status_is_right(&outcome) => Found::Nothing,
            0 => Found::WrongStatus,
            wrong => Found::WrongLines(wrong),
        },
    }
}

/// Faults of the controller. One model contains all of them, because a separate model for each would take seconds. A
/// job selects one by the top bits of its watchdog, which is then so long that it never ends a job.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u32)]
enum Controller {
    Nothing,
    /// The last line is not taken and not waited for, and one pair of the line before it is lost, as if that line were
    /// the last.
    LastPairDropped,
    /// Each of two neighbours gets the other's result.
    LanesSwapped,
    /// The job ends without waiting for acknowledgements.
    DoneEarly,
    /// Responses to jobs from before a reset are taken for this job's.
    EpochIgnored,
    /// Pairs enter even if there is no room for their results.
    CreditsIgnored,
    /// Invalid pairs are counted in one lane only.
    HalfCounted,
    /// All pairs are said to have come out when the last ones have entered.
    EndsEarly,
}

/// File, left-hand side of the assignment, number of the fault from 1, and the expression assigned then.
pub type Planted = (&'static str, &'static str, u32, &'static str);

const FAULTS: [Planted; 8] = [
    ("contact_afu_control.v", "assign lines = ", Controller::LastPairDropped as u32, "job_lines - 32'd1"),
    ("contact_afu_packer.v", "entering_0 <= ", Controller::LanesSwapped as u32, "record_1"),
    ("contact_afu_packer.v", "entering_1 <= ", Controller::LanesSwapped as u32, "record_0"),
    ("contact_afu_dispatcher.v", "idle <= ~|outstanding", Controller::DoneEarly as u32, "~wr_req_valid"),
    ("contact_afu_collector.v", "is_current <= rd_rsp_valid", Controller::EpochIgnored as u32, "rd_rsp_valid"),
    ("contact_afu_credits.v", "may_enter <= run", Controller::CreditsIgnored as u32, "run"),
    ("contact_afu_packer.v", "wire invalid_here_1 = ", Controller::HalfCounted as u32, "1'b0"),
    ("contact_afu_credits.v", "all_emerged <= ~start", Controller::EndsEarly as u32, "~start & all_given"),
];

pub const SELECTOR_BIT: u32 = 28;

/// A model with all these faults. None is active in a job whose watchdog has zeros at the top.
pub fn model_of_faults(config: &Config, faults: &[Planted]) -> Model {
    let mut files: Vec<File> = source(config).files().to_vec();
    for &(name, left, planted, wrong) in faults {
        let file = files.iter_mut().find(|file| file.name == name).unwrap();
        let chosen = format!("contact_afu.control.job_watchdog[31:{SELECTOR_BIT}] == 4'd{planted}");
        file.text = change(&file.text, left, |right| format!("({chosen}) ? ({wrong}) : ({right})"));
    }
    let source = with_scpus(Source::new("contact_afu", files), config);
    Model::build(&source, Trace::Off).unwrap()
}

fn job<'a>(case: &'a Case, planted: Controller) -> Job<'a> {
    Job { watchdog: (planted as u32) << SELECTOR_BIT, max_cycles: Some(20_000), ..case.job() }
}

#[test]
fn faults_of_the_controller_are_found() {
    let config = config(2, "e8f3z", "depth");
    let model = model_of_faults(&config, &FAULTS);
    let case = Case::random(&config, 4_003, 3);
    // Writes are so slow that results waiting for them fill all the room there is.
    let (read, name) = (Direction::steady(3, 0), "slow writes".to_owned());
    let write = Direction { lines_per_cycle: 0.05, ..Direction::steady(30, 0) };
    let link = LinkModel { name, read, write, order: Order::InOrder, ..LinkModel::ideal() };
    let run = |planted: Controller| {
        let afu = model.instance(1).unwrap();
        let mut driver = Driver::new(&afu, Link::new(link.clone(), 1).unwrap()).unwrap();
        judge(&case, driver.run(&job(&case, planted)))
    };
    assert_eq!(run(Controller::Nothing), Found::Nothing);
    assert_eq!(run(Controller::LastPairDropped), Found::WrongLines(1));
    assert_eq!(run(Controller::LanesSwapped), Found::WrongLines(case.lines.len()));
    let early = run(Controller::DoneEarly);
    assert!(
        matches!(early, Found::Error(DriveError::Protocol { what: ProtocolError::DoneEarly { .. }, .. })),
        "{early:?}"
    );
    let crowded = run(Controller::CreditsIgnored);
    assert!(!matches!(crowded, Found::Nothing | Found::WrongStatus), "{crowded:?}");
    assert_eq!(run(Controller::HalfCounted), Found::WrongStatus);

    // This fault shows where nothing else keeps a job from ending: in one whose pairs are all inside at once.
    let short = Case::random(&config, 3, 5);
    let run_short = |planted: Controller| {
        let afu = model.instance(1).unwrap();
        judge(&short, driver(&afu, "ideal", 1).run(&job(&short, planted)))
    };
    assert_eq!(run_short(Controller::Nothing), Found::Nothing);
    let cut_off = run_short(Controller::EndsEarly);
    assert!(matches!(cut_off, Found::WrongLines(_) | Found::Error(_)), "{cut_off:?}");

    // This fault shows only after a reset.
    let spoilt = Case::random(&config, 301, 4);
    let harm_after_resets = |planted: Controller| {
        let afu = model.instance(1).unwrap();
        let mut driver = driver(&afu, "hostile", 1);
        (20..400).step_by(20).any(|moment| {
            driver.start(&job(&spoilt, planted)).unwrap();
            (0..moment).any(|_| driver.step().unwrap());
            driver.reset().unwrap();
            let next = Job { destination_address: 1 << 41, ..job(&case, planted) };
            judge(&case, driver.run(&next)) != Found::Nothing
        })
    };
    assert!(!harm_after_resets(Controller::Nothing));
    assert!(harm_after_resets(Controller::EpochIgnored));
}

/// The same on the host's side: faults of the link's data show in the contacts.
#[test]
fn faults_of_the_link_are_found() {
    let case = Case::random(&of(3), 301, 5);
    let afu = committed(3).instance(1).unwrap();
    let mut driver = driver(&afu, "shuffled", 1);
    // Each line holds two pairs or two contacts, so a line's number is its read's number.
    assert_eq!(judge(&case, driver.run(&case.job())), Found::Nothing);
    for (fault, wrong) in
        [(Fault::ReadSwapped(40), vec![40, 41]), (Fault::ReadFlipped { read: 100, bit: 22 }, vec![100])]
    {
        driver.link_mut().plan(&[fault]);
        let outcome = driver.run(&case.job()).unwrap();
        assert_eq!(case.wrong_lines(&outcome), wrong, "{fault:?}");
    }
}
