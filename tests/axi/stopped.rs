//! Longer jobs over every link, stopped at any time: by an abort, by a host that is gone, by a reset of accelerator and
//! interconnect. A watchdog that is shorter than the link's latency stops them too, and what memory still owes then
//! comes during the next job.

use contact_afu::afu::JobError;
use contact_afu::afu::shell::axi::map;
use contact_afu::cosim::axi::Machine;
use contact_afu::cosim::{Instance, Model};
use contact_afu::host::Session;
use contact_afu::link::LinkModel;
use contact_afu::link::axi::Handshake;

use crate::bench::{Case, build, config, end, files, machine, model, run, session};

const SCPUS: u32 = 3;

/// Early cycles of a job one by one, later ones at growing distances.
fn moments() -> impl Iterator<Item = u64> {
    (0..30).step_by(3).chain((30..200).step_by(17)).chain((200..1300).step_by(83)).chain([2_500, 5_000])
}

fn two_cases() -> (Case, Case) {
    (Case::random(301, 21), Case::random(57, 22))
}

/// Every link, with a habit of its memory and a width of the bus.
fn links() -> impl Iterator<Item = (&'static str, Handshake, u32, u64)> {
    let habits = [Handshake::Free, Handshake::DataFirst, Handshake::AddressFirst].into_iter().cycle();
    let buses = [512, 128].into_iter().cycle();
    LinkModel::PRESETS
        .into_iter()
        .zip(habits)
        .zip(buses)
        .zip(1..)
        .map(|(((link, habit), bus), seed)| (link, habit, bus, seed))
}

fn models() -> [(u32, Model); 2] {
    [512, 128].map(|bus| (bus, model(&config(SCPUS, bus))))
}

fn instance(models: &[(u32, Model)], bus: u32, seed: u64) -> Instance {
    models.iter().find(|(of, _)| *of == bus).unwrap().1.instance(seed).unwrap()
}

/// Runs a job for some cycles, disturbs the machine, and then runs the next transaction, in other buffers.
fn interrupted(how: &str, interrupt: impl Fn(&mut Machine<'_>)) {
    let (spoilt, next) = two_cases();
    let models = models();
    for (link, habit, bus, seed) in links() {
        let afu = instance(&models, bus, seed);
        let mut session = session(machine(&afu, link, habit, seed), &config(SCPUS, bus), spoilt.workspace(60, 30));
        for moment in moments() {
            let what = format!("{bus} bits, {link}, {habit:?}, {how} after {moment} cycles");
            session.set_workspace(spoilt.workspace(60, 30));
            let mut running = session.transaction().send(&spoilt.pairs).unwrap().start().unwrap().confirm().unwrap();
            running.idle(moment).unwrap_or_else(|e| panic!("{what}: {e}"));
            interrupt(running.transport_mut());
            std::mem::forget(running);
            session.set_workspace(next.workspace(2000, 1000));
            next.check(&run(&mut session, &next).unwrap_or_else(|e| panic!("{what}: {e}")), &what);
        }
    }
}

/// The next transaction begins with a soft reset, while memory owes what the one before asked for.
#[test]
fn a_host_that_is_gone_at_any_time() {
    interrupted("gone", |_| {});
}

#[test]
fn a_reset_of_the_system_at_any_time() {
    interrupted("the system's reset", |machine| machine.system_reset().unwrap());
}

#[test]
fn abort_at_any_time_and_the_next_job_is_right() {
    let (spoilt, next) = two_cases();
    let models = models();
    for (link, habit, bus, seed) in links() {
        let afu = instance(&models, bus, seed);
        let mut session = session(machine(&afu, link, habit, seed), &config(SCPUS, bus), spoilt.workspace(60, 30));
        let (mut aborted, mut complete) = (0, 0);
        for moment in moments() {
            let what = format!("{bus} bits, {link}, {habit:?}, abort after {moment} cycles");
            let mut running = session.transaction().send(&spoilt.pairs).unwrap().start().unwrap().confirm().unwrap();
            running.idle(moment).unwrap();
            running.abort().unwrap();
            let done = running.wait().unwrap_or_else(|e| panic!("{what}: {e}"));
            let outcome = done.outcome();
            if outcome.error == JobError::Aborted.code() {
                spoilt.check_written(&outcome, &what);
                aborted += 1;
            } else {
                spoilt.check(&outcome, &what);
                complete += 1;
            }
            // Without another soft reset.
            let done = end(done.send_next(&next.pairs).unwrap()).unwrap_or_else(|e| panic!("{what}: {e}"));
            next.check(&done.outcome(), &what);
            std::mem::forget(done);
        }
        assert!(aborted > 0 && complete > 0, "{link}: {aborted} aborted, {complete} done");
    }
}

/// A job with this watchdog, then one without, which starts at once: no soft reset is between the two, so what memory
/// still owes comes in the middle of the second. Returns whether the first was given up, or what is wrong.
fn two_jobs(session: &mut Session<Machine<'_>>, watchdog: u32, (spoilt, next): &(Case, Case)) -> Result<bool, String> {
    let what = format!("watchdog {watchdog}");
    let told = |error: &dyn std::fmt::Display| format!("{what}: {error}");
    session.set_workspace(spoilt.workspace(60, 30));
    session.watchdog = watchdog;
    let done = end(session.transaction().send(&spoilt.pairs).map_err(|e| told(&e))?).map_err(|e| told(&e))?;
    let outcome = done.outcome();
    spoilt.check_written(&outcome, &what);
    let is_given_up = outcome.error == JobError::Watchdog.code();
    if !is_given_up {
        spoilt.check(&outcome, &what);
    }
    std::mem::forget(done);

    // By the registers alone, in other buffers.
    let place = next.workspace(2000, 1000);
    let [source, first, destination] = [place.pairs(), place.context(), place.destination()].map(|byte| byte / 64);
    let machine = session.transport_mut();
    let memory = &mut machine.memory_mut().link_mut().memory;
    (source..).zip(next.source()).for_each(|(at, line)| memory.set(at, &line));
    memory.forget(destination..destination + u64::from(next.lines()));
    // The first job's late writes are not forbidden.
    memory.guard(first..source + u64::from(next.lines()), first..destination + u64::from(next.lines()));
    let [source, destination] = [place.pairs(), place.destination()];
    for (offset, value) in [
        (map::SOURCE.offset, source),
        (map::SOURCE.offset + 4, source >> 32),
        (map::DESTINATION.offset, destination),
        (map::DESTINATION.offset + 4, destination >> 32),
        (map::COUNT.offset, next.pairs.len() as u64),
        (map::WATCHDOG.offset, 0),
        (map::CONTROL.offset, map::START.put(1).into()),
    ] {
        machine.write_register(offset, value as u32).map_err(|e| told(&e))?;
    }
    for _ in 0..10_000 {
        let status = machine.read_register(map::STATUS.offset).map_err(|e| told(&e))?;
        if map::ENDED.get(status) == 1 {
            let memory = &machine.memory().link().memory;
            let is_right = (destination / 64..).zip(next.wanted()).all(|(at, line)| memory.get(at) == Some(line));
            return match map::ERROR.get(status) {
                0 if is_right => Ok(is_given_up),
                0 => Err(told(&"wrong data")),
                error => Err(told(&format!("error {error}"))),
            };
        }
    }
    Err(told(&"the second job does not end"))
}

/// [`two_jobs`] with watchdogs of many lengths. Returns how often the first job was given up.
fn jobs_in_twos(model: &Model, link: &str, seed: u64) -> Result<usize, String> {
    let cases = two_cases();
    let (afu, config) = (model.instance(seed).unwrap(), config(SCPUS, 256));
    let mut session = session(machine(&afu, link, Handshake::Free, seed), &config, cases.0.workspace(60, 30));
    let watchdogs = (1..60).step_by(2).chain([80, 100, 200]);
    let given_up = watchdogs.map(|watchdog| two_jobs(&mut session, watchdog, &cases));
    Ok(given_up.collect::<Result<Vec<_>, _>>()?.into_iter().filter(|&is_given_up| is_given_up).count())
}

/// A watchdog shorter than the link's latency: the job ends, and what it abandoned arrives during the next one.
#[test]
fn responses_after_the_watchdog_disturb_nobody() {
    let model = model(&config(SCPUS, 256));
    for (link, seed) in LinkModel::PRESETS.into_iter().skip(1).zip(1..) {
        assert!(jobs_in_twos(&model, link, seed).unwrap_or_else(|e| panic!("{link}, {e}")) > 0, "{link}");
    }
}

/// If every job has the same epoch, what the job before asked for is taken for this one's.
#[test]
fn an_epoch_that_stands_still_is_found() {
    let mut files = files(&config(SCPUS, 256));
    let file = files.iter_mut().find(|file| file.name == "axi_control.v").unwrap();
    let right = "assign epoch = jobs[3:0];";
    assert_eq!(file.text.matches(right).count(), 1);
    file.text = file.text.replace(right, "assign epoch = 4'd1;");
    let found = jobs_in_twos(&build(files, SCPUS), "late", 1).unwrap_err();
    println!("{found}");
}
