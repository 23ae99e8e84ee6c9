//! Time of a cold build of a model, N = 16 against N = 1: `cargo bench --bench build`. Each build has a new cache, so
//! Verilator's runtime and the SCPU are compiled too. With `--check` the program fails unless N = 16 takes at most
//! three times as long as N = 1. Only CPU seconds of Verilator and the compiler count, not those of other programs.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use contact_afu::cosim::{Model, Source, Trace};

/// Maximum ratio of the time for N = 16 to that for N = 1.
const MOST: f64 = 3.0;

type Failure = Box<dyn std::error::Error>;

/// CPU seconds of the child processes that this process has waited for; `None` if not on Linux.
fn children_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // proc(5): cutime and cstime are fields 16 and 17, in ticks of 10 ms; the name, field 2, may hold spaces.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(13);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / 100.0)
}

/// CPU seconds (if known) and wall-clock seconds of a cold build.
fn build(scpus: u32, trace: Trace) -> Result<(f64, f64), Failure> {
    let rtl = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("rtl");
    let source = Source::from_folder(&rtl, "contact_afu")?.parameter("SCPUS", scpus.into());
    let cache = tempfile::tempdir()?;
    let (before, begun) = (children_seconds(), Instant::now());
    Model::build_in(&source, trace, cache.path())?;
    let wall = begun.elapsed().as_secs_f64();
    let cpu = before.zip(children_seconds()).map_or(wall, |(before, after)| after - before);
    Ok((cpu, wall))
}

fn run() -> Result<bool, Failure> {
    let mut within = true;
    println!("waveform  SCPUs     CPU s    wall s");
    for trace in [Trace::Off, Trace::Vcd] {
        let name = if trace == Trace::Off { "none" } else { "VCD" };
        let mut figures = Vec::new();
        for scpus in [1, 10, 16] {
            let (cpu, wall) = build(scpus, trace)?;
            println!("{name:<8}  {scpus:>5}  {cpu:>8.1}  {wall:>8.1}");
            figures.push(cpu);
        }
        println!("{name:<8}  16 against 1: {:.2}", figures[2] / figures[0]);
        within &= trace != Trace::Off || figures[2] <= MOST * figures[0];
    }
    Ok(within)
}

fn main() -> ExitCode {
    let check = std::env::args().any(|argument| argument == "--check");
    match run() {
        Ok(within) if within || !check => ExitCode::SUCCESS,
        Ok(_) => {
            eprintln!("N = 16 takes more than {MOST} times as long as N = 1");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(4)
        }
    }
}
