//! `afu cosim --input spheres`: spheres through the simulated AFU, every contact compared with the software.

use contact_afu::pairs::check_name;
use contact_afu::report::cosim::{Run, SpheresJob};
use contact_afu::spheres::{self, Hit, Spheres as Sets};
use contact_afu::tools;
use contact_afu::verify::{Bench, Command};

use super::cosim::Cosim;
use super::failure::{Classify, Failure, Kind};
use super::spheres::sets;
use super::{link, output, progress};

/// The spheres without `--spheres`.
const DEFAULT: &str = "diamond:10";

pub fn run(options: &Cosim) -> Result<(), Failure> {
    let link = link::describe(&options.link)?;
    let trace = options.trace()?;
    let others = [
        ("--pairs", !options.pairs.is_empty()),
        ("--replay", options.replay.is_some()),
        ("--junit", options.junit.is_some()),
    ];
    if let Some((option, _)) = others.into_iter().find(|(_, given)| *given) {
        let message = format!("{option} does not go with --input spheres; give the spheres with --spheres");
        return Err(Failure::new(Kind::Usage, message));
    }
    let sources = if options.spheres.is_empty() { vec![DEFAULT.to_owned()] } else { options.spheres.clone() };
    let one = [("--contacts", &options.contacts), ("--trace", &options.trace), ("--against", &options.against)];
    if let Some((option, _)) = one.iter().find(|(_, given)| given.is_some() && sources.len() > 1) {
        let message = format!("{option} works with one job only: give one --spheres");
        return Err(Failure::new(Kind::Usage, message));
    }
    if options.tile.is_some() && options.trace.is_some() {
        return Err(Failure::new(Kind::Usage, "--trace works with one job only: leave out --tile"));
    }
    if let Some(path) = &options.contacts {
        check_name(path)?;
    }
    let against = options.against.as_deref();
    let jobs = sources
        .iter()
        .map(|source| Ok((source, sets(source, against, options.sort, options.seed)?)))
        .collect::<Result<Vec<_>, Failure>>()?;
    let bench = options.bench(trace)?;
    let config = bench.config().clone();
    let link = link.at(config.clock_mhz).ends(Kind::Usage)?;
    let mut done = Vec::new();
    for (name, sets) in jobs {
        let job = job(options, &bench, name, &sets, &link)?;
        job.failures().iter().for_each(|failure| eprintln!("{name}: {failure}"));
        if let (Some(path), Ok(verdict)) = (&options.contacts, &job.verdict) {
            let both = verdict.hits.iter().zip(&verdict.contacts);
            let hits: Vec<_> = both.map(|(&spheres, &contact)| Hit { spheres, contact }).collect();
            spheres::write_hits(path, &hits)?;
        }
        done.push(job);
    }
    let run = Run {
        seed: options.seed,
        replay: command(options, &bench, &sources),
        tools: tools::simulators(),
        rtl_sha256: bench.rtl_sha256(),
        link: link.name.clone(),
        jobs: done,
        config,
    };
    let stdout_taken = options.json.as_deref().is_some_and(output::is_stdout);
    output::show(&format!("{}\n{}", run.table(), run.verdict()), stdout_taken)?;
    if let Some(path) = &options.json {
        output::json(path, &run.json())?;
    }
    let bad = run.bad().len();
    if bad == 0 {
        return Ok(());
    }
    eprintln!("replay: {}", run.replay);
    Err(Failure::new(Kind::Failed, format!("{bad} of {} jobs failed", run.jobs.len())))
}

/// Runs one job. A job that does not finish or breaks the protocol has failed, without a verdict.
fn job(
    options: &Cosim,
    bench: &Bench,
    name: &str,
    sets: &Sets,
    link: &contact_afu::link::LinkModel,
) -> Result<SpheresJob, Failure> {
    let spinner = progress::spinner("simulating, and comparing every contact with the software");
    let done = match options.tile {
        Some(size) => bench.run_spheres_in_tiles(sets, size, link, options.seed),
        None => bench.run_spheres(sets, link, options.seed, options.trace.as_deref()),
    };
    spinner.finish_and_clear();
    let verdict = match done {
        Ok(verdict) => Ok(verdict),
        Err(error) if error.is_job_failure() => Err(error.to_string()),
        Err(error) => return Err(error.into()),
    };
    Ok(SpheresJob { name: name.to_owned(), verdict })
}

fn command(options: &Cosim, bench: &Bench, sources: &[String]) -> String {
    let config = bench.config();
    let mut command = match &options.rtl {
        None => Command::new("cosim").config(config),
        Some(folder) => Command::new("cosim").folder(folder, config.scpus),
    };
    for source in sources {
        command = command.option("--spheres", source);
    }
    if let Some(against) = &options.against {
        command = command.option("--against", &against.display().to_string());
    }
    if let Some(size) = options.tile {
        command = command.option("--tile", &size.to_string());
    }
    let line = command.option("--link", &options.link).option("--seed", &options.seed.to_string()).line();
    if options.sort { format!("{line} --sort") } else { line }
}
