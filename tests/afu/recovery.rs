//! Resets, aborts and faults of the link during a job: each ends as specified, nothing wrong is ever written, and the
//! next job is right, even while the link still answers requests of an earlier job.

use contact_afu::afu::{Afu, JobError, Spec};
use contact_afu::cosim::drive::{DriveError, Waiting};
use contact_afu::cosim::{Driver, File, Instance, Job, Model, Outcome, Source, Trace};
use contact_afu::hdl::Reset;
use contact_afu::link::{Fault, LinkModel};

use crate::bench::{Case, config, driver, full_rate, of};

const SCPUS: u32 = 3;

/// Early cycles one by one, later ones at growing distances: the whole life of a job of some hundred cycles.
fn moments() -> impl Iterator<Item = u64> {
    (0..12).chain((12..100).step_by(7)).chain((100..1000).step_by(53))
}

fn afu(seed: u64) -> Instance {
    full_rate(SCPUS).instance(seed).unwrap()
}

/// A job to be disturbed, and one that must be right after it.
fn two_cases() -> (Case, Case) {
    (Case::random(&of(SCPUS), 301, 21), Case::random(&of(SCPUS), 57, 22))
}

/// The job after a disturbed one writes elsewhere: requests from before a reset, or abandoned by the watchdog, may be
/// written at any time.
fn elsewhere(case: &Case) -> Job<'_> {
    Job { destination_address: 1 << 41, ..case.job() }
}

fn ends(driver: &mut Driver) -> Outcome {
    while !driver.step().unwrap() {}
    driver.finish().unwrap()
}

#[test]
fn reset_at_any_time_and_the_next_job_is_right() {
    let (spoilt, next) = two_cases();
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = afu(seed);
        let mut driver = driver(&afu, link, seed);
        let mut stale = 0;
        for moment in moments() {
            driver.start(&spoilt.job()).unwrap();
            let done = (0..moment).any(|_| driver.step().unwrap());
            driver.reset().unwrap();
            stale += driver.link().in_flight().0 + driver.link().in_flight().1;
            let what = format!("{link}, reset after {moment} cycles ({})", if done { "done" } else { "running" });
            let outcome = driver.run(&elsewhere(&next)).unwrap_or_else(|e| panic!("{what}: {e}"));
            next.check(&outcome, &what);
        }
        assert!(stale > 0 || link == "ideal", "{link}: nothing old was ever on its way");
    }
}

/// A short job is stopped in each of its cycles, one after the other, over links that differ every time. What was
/// written is right, and nothing of the following job is lost, duplicated or torn.
#[test]
fn reset_and_abort_at_every_cycle_of_a_short_job() {
    let (spoilt, next) = (Case::random(&of(SCPUS), 15, 31), Case::random(&of(SCPUS), 9, 32));
    for ((link, seed), aborts) in LinkModel::PRESETS.into_iter().zip(1..).flat_map(|l| [(l, false), (l, true)]) {
        let afu = afu(seed);
        let mut driver = driver(&afu, link, seed);
        for moment in 0.. {
            let what = format!("{link}, {} after {moment} cycles", if aborts { "abort" } else { "reset" });
            driver.start(&spoilt.job()).unwrap();
            let done = (0..moment).any(|_| driver.step().unwrap());
            if done || aborts {
                driver.abort();
                spoilt.check_written(&ends(&mut driver), &what);
            } else {
                driver.reset().unwrap();
            }
            let outcome = driver.run(&elsewhere(&next)).unwrap_or_else(|e| panic!("{what}: {e}"));
            next.check(&outcome, &what);
            if done {
                assert!(moment > 90, "{link}: a job of {moment} cycles");
                break;
            }
        }
    }
}

/// This reset differs from the default in every module.
#[test]
fn an_asynchronous_reset_that_is_low() {
    let config = config(2, "e8f3z", "depth");
    let reset = Reset { asynchronous: true, active_low: true };
    let files = Afu::generate(Spec { reset, ..Spec::from(config.clone()) }).unwrap().verilog();
    let files = files.into_iter().map(|(name, text)| File { name, text }).collect();
    let afu = Model::build(&Source::new("contact_afu", files), Trace::Off).unwrap().instance(5).unwrap();
    assert!(afu.has_port("rst_n") && !afu.has_port("rst"));
    let (spoilt, next) = (Case::random(&config, 301, 23), Case::random(&config, 57, 24));
    let mut driver = driver(&afu, "hostile", 5);
    for moment in [20, 90, 200] {
        driver.start(&spoilt.job()).unwrap();
        (0..moment).for_each(|_| assert!(!driver.step().unwrap()));
        driver.reset().unwrap();
        next.check(&driver.run(&elsewhere(&next)).unwrap(), "after an asynchronous reset");
    }
}

#[test]
fn abort_at_any_time_and_the_next_job_is_right() {
    let (spoilt, next) = two_cases();
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = afu(seed);
        let mut driver = driver(&afu, link, seed);
        let (mut aborted, mut complete, mut partly) = (0, 0, 0);
        for moment in moments() {
            let what = format!("{link}, abort after {moment} cycles");
            driver.start(&spoilt.job()).unwrap();
            (0..moment).any(|_| driver.step().unwrap());
            driver.abort();
            let outcome = ends(&mut driver);
            match outcome.job_error() {
                Some(JobError::Aborted) => {
                    let written = spoilt.check_written(&outcome, &what);
                    partly += u32::from(written > 0 && written < spoilt.lines.len());
                    aborted += 1;
                }
                _ => {
                    spoilt.check(&outcome, &what);
                    complete += 1;
                }
            }
            let outcome = driver.run(&elsewhere(&next)).unwrap_or_else(|e| panic!("{what}: {e}"));
            next.check(&outcome, &what);
        }
        assert!(
            aborted > 10 && complete > 0 && partly > 0,
            "{link}: {aborted} aborted, {partly} half-way, {complete} done"
        );
    }
}

/// Runs a job with faults of the link, then the next one without.
fn spoil(link: &str, faults: &[Fault], watchdog: u32, expected: JobError) {
    let (spoilt, next) = two_cases();
    let afu = afu(7);
    let mut driver = driver(&afu, link, 7);
    for &fault in faults {
        let what = format!("{link}, {fault:?}");
        driver.link_mut().plan(&[fault]);
        let job = Job { watchdog, ..spoilt.job() };
        let outcome = driver.run(&job).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert_eq!(outcome.job_error(), Some(expected), "{what}");
        spoilt.check_written(&outcome, &what);
        driver.link_mut().plan(&[]);
        let outcome = driver.run(&Job { watchdog, ..elsewhere(&next) }).unwrap_or_else(|e| panic!("{what}: {e}"));
        next.check(&outcome, &what);
    }
}

/// The first, some middle ones and the last of 151 lines in each direction.
const PLACES: [u64; 6] = [0, 1, 63, 64, 100, 150];

#[test]
fn error_responses_end_the_job_with_their_code() {
    for link in LinkModel::PRESETS {
        spoil(link, &PLACES.map(Fault::ReadError), 0, JobError::Read);
        spoil(link, &PLACES.map(Fault::WriteError), 0, JobError::Write);
    }
}

/// The second response finds its tag free. (That of the last write arrives after the job has ended.)
#[test]
fn a_response_that_comes_twice_ends_the_job_with_its_code() {
    for link in ["ideal", "late"] {
        spoil(link, &PLACES.map(Fault::ReadTwice), 0, JobError::Response);
        spoil(link, &PLACES[..5].iter().copied().map(Fault::WriteTwice).collect::<Vec<_>>(), 0, JobError::Response);
    }
}

#[test]
fn the_watchdog_ends_jobs_whose_responses_are_lost() {
    // Longer than the latency of any response that is not lost.
    let watchdog = 900;
    for link in LinkModel::PRESETS {
        spoil(link, &PLACES.map(Fault::ReadLost), watchdog, JobError::Watchdog);
        spoil(link, &PLACES.map(Fault::WriteLost), watchdog, JobError::Watchdog);
    }
}

/// Takes precedence over earlier errors, because the host must know that responses may still arrive.
#[test]
fn the_watchdog_has_the_last_word() {
    spoil("late", &[Fault::ReadError(70)], 900, JobError::Read);
    let (spoilt, next) = two_cases();
    for second in [Fault::ReadError(100), Fault::WriteError(50)] {
        let afu = afu(1);
        let mut driver = driver(&afu, "late", 1);
        driver.link_mut().plan(&[Fault::ReadLost(90), second]);
        driver.start(&Job { watchdog: 300, ..spoilt.job() }).unwrap();
        (0..180).for_each(|_| assert!(!driver.step().unwrap()));
        if second == Fault::WriteError(50) {
            driver.abort();
        }
        let outcome = ends(&mut driver);
        assert_eq!(outcome.job_error(), Some(JobError::Watchdog), "{second:?}");
        spoilt.check_written(&outcome, "given up");
        driver.link_mut().plan(&[]);
        next.check(&driver.run(&elsewhere(&next)).unwrap(), "after a job that was given up");
    }
}

/// A watchdog shorter than the link's latency: the job ends, and every response that it abandoned arrives during the
/// next one.
#[test]
fn responses_after_the_watchdog_disturb_nobody() {
    let (spoilt, next) = two_cases();
    for (link, seed) in LinkModel::PRESETS.into_iter().skip(1).zip(1..) {
        let afu = afu(seed);
        let mut driver = driver(&afu, link, seed);
        let mut given_up = 0;
        for watchdog in (1..60).chain([80, 100, 200]) {
            let what = format!("{link}, watchdog {watchdog}");
            let outcome = driver.run(&Job { watchdog, ..spoilt.job() }).unwrap_or_else(|e| panic!("{what}: {e}"));
            let error = outcome.job_error();
            match error {
                Some(JobError::Watchdog) => given_up += 1,
                error => assert_eq!(error, None, "{what}"),
            }
            spoilt.check_written(&outcome, &what);
            let mut outcome = driver.run(&elsewhere(&next)).unwrap_or_else(|e| panic!("{what}: {e}"));
            // The link accepts requests that were abandoned on the port in the next job: at most one in each direction.
            let (read, written) = next.traffic();
            let more = (outcome.bytes_read - read, outcome.bytes_written - written);
            assert!(more.0 <= 64 && more.1 <= 64 && (more == (0, 0) || error.is_some()), "{what}: {more:?} bytes more");
            (outcome.bytes_read, outcome.bytes_written) = (read, written);
            next.check(&outcome, &what);
        }
        assert!(given_up > 0, "{link}");
    }
}

/// Without a watchdog the driver ends the wait, and reports what it was waiting for.
#[test]
fn a_lost_response_without_a_watchdog_is_a_time_out() {
    let (spoilt, next) = two_cases();
    for (fault, lost_read) in [(Fault::ReadLost(40), true), (Fault::WriteLost(40), false)] {
        let afu = afu(1);
        let mut driver = driver(&afu, "late", 1);
        driver.link_mut().plan(&[fault]);
        let error = driver.run(&Job { max_cycles: Some(3_000), ..spoilt.job() }).unwrap_err();
        let DriveError::TimedOut { waiting: Waiting::Response { is_read, .. }, .. } = error else { panic!("{error}") };
        assert_eq!(is_read, lost_read);
        driver.link_mut().plan(&[]);
        driver.reset().unwrap();
        next.check(&driver.run(&elsewhere(&next)).unwrap(), "after a time-out and a reset");
    }
}

#[test]
fn a_mode_that_there_is_not_is_refused() {
    let (_, next) = two_cases();
    let afu = afu(1);
    let mut driver = driver(&afu, "shuffled", 1);
    for mode in 1..16 {
        let outcome = driver.run(&Job { mode, ..elsewhere(&next) }).unwrap();
        assert_eq!((outcome.job_error(), outcome.bytes_read), (Some(JobError::Mode), 0), "mode {mode}");
        next.check(&driver.run(&elsewhere(&next)).unwrap(), "after a wrong mode");
    }
}
