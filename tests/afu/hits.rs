//! Only contacts come back: the same lines for every number of SCPUs over every link, at the speed of the input.

use contact_afu::afu::JobError;
use contact_afu::config::{Config, Results};
use contact_afu::cosim::drive::DriveError;
use contact_afu::cosim::{Instance, Job};
use contact_afu::link::{Fault, LinkModel};
use contact_afu::query::PairRecord;

use crate::bench::{Case, config, driver, generated};
use crate::faults::{Found, Planted, SELECTOR_BIT, judge, model_of_faults};

fn hits(scpus: u32, profile: &str, contact: &str) -> Config {
    Config { results: Results::Hits, ..config(scpus, profile, contact) }
}

fn pair(touching: bool, number: u16) -> PairRecord {
    let far = if touching { 1.5 } else { 2.5 };
    PairRecord::from_spheres([f32::from(number), 0.0, 0.0, 1.0], [f32::from(number), far, 0.0, 1.0])
}

/// Jobs in which no pair, one pair in twenty or every pair touches, with and without invalid pairs. Also random jobs of
/// 0, 1, 2, 3 and 177 pairs.
fn cases(config: &Config) -> Vec<Case> {
    let kinds: [fn(u16) -> bool; 3] = [|_| false, |number| number % 20 == 7, |_| true];
    let mut cases: Vec<Case> = [0, 1, 2, 3, 177].into_iter().map(|n| Case::random(config, n, n + 5)).collect();
    for touching in kinds {
        let mut pairs: Vec<_> = (0..203).map(|number| pair(touching(number), number)).collect();
        cases.push(Case::new(config, pairs.clone()));
        for number in [0, 3, 4, 9, 202] {
            pairs[number].0[7] = f32::NAN.to_bits();
        }
        cases.push(Case::new(config, pairs));
    }
    cases
}

/// The whole record, one per line.
const WHOLE: &str = "depth,normal,position";

#[test]
fn the_same_hits_for_every_number_of_scpus_over_every_link() {
    // One, four and sixteen records per line. (`tests/afu_controller` runs all combinations in the evaluator.)
    for (numbers, contact) in [(&[1, 2, 3, 10][..], WHOLE), (&[7], "depth"), (&[16], "hit")] {
        let cases = cases(&hits(1, "e8f3z", contact));
        for &scpus in numbers {
            let model = generated(&hits(scpus, "e8f3z", contact));
            for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
                let afu = model.instance(seed).unwrap();
                let mut driver = driver(&afu, link, seed);
                assert_eq!(driver.capability().results, Results::Hits);
                for case in &cases {
                    let what = format!("{scpus} SCPUs, {contact}, {link}, {} pairs", case.pairs.len());
                    let outcome = driver.run(&case.job()).unwrap_or_else(|e| panic!("{what}: {e}"));
                    case.check(&outcome, &what);
                }
            }
        }
    }
}

#[test]
fn deciders_give_the_same_hits_over_every_link() {
    for (decide, scpus, interval, contact) in
        [(1, 1, 7, WHOLE), (2, 1, 1, "depth"), (2, 3, 5, WHOLE), (1, 2, 2, "depth")]
    {
        let config = Config { decide, interval, ..hits(scpus, "e8f3z", contact) };
        let model = generated(&config);
        for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
            let afu = model.instance(seed).unwrap();
            let mut driver = driver(&afu, link, seed);
            for case in &cases(&config) {
                let what = format!("{decide} deciders, {scpus} SCPUs at {interval}, {contact}, {link}");
                let outcome = driver.run(&case.job()).unwrap_or_else(|e| panic!("{what}: {e}"));
                case.check(&outcome, &what);
            }
        }
    }
}

/// One pair in eight touches. These pairs take no more time with one decider and an SCPU that takes a pair every seven
/// or eight cycles than with an SCPU that takes one every cycle. Two deciders and an SCPU that takes one every four
/// cycles are as fast as two such SCPUs. Where all touch, the SCPU sets the pace, and none is lost.
#[test]
fn a_decider_takes_a_pair_every_cycle() {
    let alone = hits(1, "e8f3z", WHOLE);
    let with_decider = Config { decide: 1, interval: 7, ..alone.clone() };
    let pairs = |touching: fn(u16) -> bool| (0..8_000).map(|number| pair(touching(number), number)).collect::<Vec<_>>();
    let cycles = |config: &Config, touching: fn(u16) -> bool| {
        let case = Case::new(config, pairs(touching));
        let outcome = driver(&generated(config).instance(1).unwrap(), "ideal", 1).run(&case.job()).unwrap();
        case.check(&outcome, "on its own");
        outcome.cycles
    };
    // One in eight, in bursts of thirty.
    let bursts: fn(u16) -> bool = |number| number % 240 < 30;
    let (one, decided) = (cycles(&alone, bursts), cycles(&with_decider, bursts));
    assert!(decided < one + 250, "{decided} cycles, {one} without a decider");
    let every_eight = cycles(&Config { interval: 8, ..with_decider.clone() }, bursts);
    assert!(every_eight < one + 300, "{every_eight} cycles, {one} without a decider");
    let two = cycles(&hits(2, "e8f3z", WHOLE), bursts);
    let two_decided = cycles(&Config { decide: 2, interval: 4, ..alone }, bursts);
    assert!(two_decided < two + 300, "{two_decided} cycles, {two} without deciders");
    assert!(two < 4_300, "{two} cycles");
    // All touch: an SCPU at interval 7.
    let all = cycles(&with_decider, |_| true);
    assert!((56_000..56_400).contains(&all), "{all} cycles");
}

fn afu(scpus: u32) -> Instance {
    generated(&hits(scpus, "e8f3z", WHOLE)).instance(1).unwrap()
}

/// One pair in twenty touches: one line of pairs enters per cycle, and each contact takes 64 bytes of output.
#[test]
fn few_hits_cost_no_time_and_few_bytes() {
    let config = hits(2, "e8f3z", WHOLE);
    let pairs: Vec<_> = (0..8_000).map(|number| pair(number % 20 == 7, number)).collect();
    let case = Case::new(&config, pairs);
    for scpus in [2, 10] {
        let outcome = driver(&afu(scpus), "ideal", 1).run(&case.job()).unwrap();
        case.check(&outcome, "one in twenty");
        assert_eq!((outcome.bytes_read, outcome.bytes_written), (8_000 * 32, 400 * 64));
        let share = 0.5 * 8_000.0 / outcome.cycles as f64;
        assert!((0.97..=1.0).contains(&share), "{scpus} SCPUs: {} cycles", outcome.cycles);
    }
}

/// Contacts without room are not written, but all contacts are counted, so the host knows how much room to provide.
#[test]
fn more_hits_than_room_end_in_an_error_of_their_own() {
    let case = Case::new(&hits(3, "e8f3z", WHOLE), (0..100).map(|number| pair(number % 3 > 0, number)).collect());
    let afu = afu(3);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let mut driver = driver(&afu, link, seed);
        for room in [0, 1, 65, 66, 0, 100] {
            let outcome = driver.run(&case.job_with_room(room)).unwrap_or_else(|e| panic!("{link}, {room} lines: {e}"));
            assert_eq!(outcome.job_error(), (room < 66).then_some(JobError::Overflow), "{link}, {room} lines");
            assert_eq!(case.check_written(&outcome, "as far as there is room") as u64, room.min(66));
            assert!(case.status_is_right(&outcome), "{link}, {room} lines: {outcome:?}");
        }
    }
}

#[test]
fn aborts_resets_and_faults_of_the_link_leave_nothing_to_the_next_job() {
    let config = hits(3, "e8f3z", WHOLE);
    aborted_and_reset(&config, &afu(3));
    let decided = Config { decide: 2, interval: 3, ..hits(2, "e8f3z", WHOLE) };
    aborted_and_reset(&decided, &generated(&decided).instance(1).unwrap());
}

fn aborted_and_reset(config: &Config, afu: &Instance) {
    let spoilt = Case::new(config, (0..301).map(|number| pair(number % 4 > 0, number)).collect());
    let next = Case::random(config, 57, 22);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let mut driver = driver(afu, link, seed);
        for moment in (0..40).chain((40..700).step_by(53)) {
            let what = format!("{link}, after {moment} cycles");
            driver.start(&spoilt.job()).unwrap();
            let done = (0..moment).any(|_| driver.step().unwrap());
            if moment % 2 == 0 {
                driver.reset().unwrap();
            } else {
                driver.abort();
                while !driver.step().unwrap() {}
                let outcome = driver.finish().unwrap();
                match outcome.job_error() {
                    // The abort came with the last acknowledgement or after it.
                    None => spoilt.check(&outcome, &what),
                    error => assert_eq!(error, (!done).then_some(JobError::Aborted), "{what}"),
                }
                spoilt.check_written(&outcome, &what);
            }
            let elsewhere = Job { destination_address: 1 << 41, ..next.job() };
            let outcome = driver.run(&elsewhere).unwrap_or_else(|e| panic!("{what}: {e}"));
            next.check(&outcome, &what);
        }
        for (fault, error) in [(Fault::ReadError(30), JobError::Read), (Fault::WriteError(30), JobError::Write)] {
            driver.link_mut().plan(&[fault]);
            let outcome = driver.run(&spoilt.job()).unwrap();
            assert_eq!(outcome.job_error(), Some(error), "{link}");
            driver.link_mut().plan(&[]);
            let elsewhere = Job { destination_address: 1 << 41, ..next.job() };
            next.check(&driver.run(&elsewhere).unwrap(), link);
        }
    }
}

/// A job that does not match the AFU is refused.
#[test]
fn a_job_that_expects_all_results_is_refused() {
    let case = Case::random(&config(3, "e8f3z", WHOLE), 10, 1);
    let error = driver(&afu(3), "ideal", 1).run(&case.job()).unwrap_err();
    assert_eq!(error, DriveError::OtherResults { expected: Results::All, found: Results::Hits });
}

/// File, left-hand side of the assignment, and the expression assigned instead. The faults: a wrong number, two
/// neighbours swapped, a wrong count, a wrong last line.
const FAULTS: [Planted; 4] = [
    ("contact_afu_sieve.v", "] number_1 = ", 1, "emerged"),
    ("contact_afu_sieve.v", "comes_to_0_in_0 = ", 2, "1'b0"),
    ("contact_afu_sieve.v", "hits_to_0 = ", 3, "2'd0"),
    ("contact_afu_packer.v", "wire flushes = ", 4, "1'b0"),
];

/// With deciders: a place that is free before its contact is computed, another bank, a place that is never free, a hit
/// that comes while its SCPU still has another.
const FAULTS_OF_DECIDERS: [Planted; 4] = [
    ("contact_afu_resolver.v", "wire [10:0] next_needed = ", 1, "decided[10:0]"),
    ("contact_afu_resolver.v", "bank_1_soon <= ", 2, "1'b0"),
    ("contact_afu_resolver.v", "freed <= start", 3, "11'd0"),
    ("contact_afu_resolver.v", "assign may_come = ", 4, "1'b1"),
];

#[test]
fn planted_faults_of_deciders_are_found() {
    let config = Config { decide: 2, interval: 4, ..hits(1, "e8f3z", WHOLE) };
    let pairs = (0..5_000).map(|number| pair(number % 3 > 0, number)).collect();
    let case = Case::new(&config, pairs);
    let model = model_of_faults(&config, &FAULTS_OF_DECIDERS);
    for fault in 0..=4 {
        let afu = model.instance(1).unwrap();
        let job = Job { watchdog: fault << SELECTOR_BIT, max_cycles: Some(60_000), ..case.job() };
        let found = judge(&case, driver(&afu, "shuffled", 1).run(&job));
        assert_eq!(found == Found::Nothing, fault == 0, "fault {fault}: {found:?}");
    }
}

/// The comparison can fail.
#[test]
fn planted_faults_are_found() {
    let config = hits(2, "e8f3z", "depth");
    let case = Case::random(&config, 1_001, 3);
    let model = model_of_faults(&config, &FAULTS);
    for fault in 0..=4 {
        let afu = model.instance(1).unwrap();
        let job = Job { watchdog: fault << SELECTOR_BIT, max_cycles: Some(20_000), ..case.job() };
        let found = judge(&case, driver(&afu, "shuffled", 1).run(&job));
        assert_eq!(found == Found::Nothing, fault == 0, "fault {fault}: {found:?}");
    }
    // The link flips a bit of a radius' exponent, which shows in the contacts.
    let afu = model.instance(1).unwrap();
    let mut driver = driver(&afu, "shuffled", 1);
    driver.link_mut().plan(&[Fault::ReadFlipped { read: 100, bit: 126 }]);
    assert_ne!(judge(&case, driver.run(&case.job())), Found::Nothing);
}
