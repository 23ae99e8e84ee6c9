//! What a step costs, from the spheres to all of their contacts: `cargo bench --features ode,parry --bench spheres`.
//!
//! The search of this crate (rows of boxes) beside a SIMD cell list, ODE's spaces with `dCollide`, and parry3d's trees
//! of boxes with its contacts. One thread; the median of several passes; ns per sphere. Each pass begins with the
//! spheres in memory, in the order of a Hilbert curve, and finds every contact. Sorting along the curve is a column of
//! its own. Prints the first table of docs/spheres.md, "Times".
//!
//! With `-- --out DIR` the Verilog of the AFU is simulated too, and tables, CSV, pictures and page go to a folder:
//! `./scripts/spheres` does so. With `--quick` there are fewer sets.

mod cells;
mod measure;
mod peers;
mod simulate;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use contact_afu::report::spheres_times::{Row, Times};
use contact_afu::spheres;
use simulate::Afus;

const SETS: [&str; 14] = [
    "diamond:10",
    "diamond:15",
    "diamond:20",
    "diamond:30",
    "diamond:30+1000",
    "gas:4096:0.1",
    "gas:4096:0.1+1000",
    "gas:1024:0.3",
    "gas:4096:0.3",
    "gas:16384:0.3",
    "gas:32768:0.3",
    "gas:32768:0.3+1000",
    "probes:4096:10000",
    "probes:4096:10000+1000",
];
const QUICK: [&str; 5] = ["diamond:5", "diamond:10", "gas:1024:0.3", "gas:4096:0.3", "probes:512:1000"];
/// The seed of the sets and of the link.
const SEED: u64 = 1;

struct Options {
    out: Option<PathBuf>,
    quick: bool,
}

/// The options after `--`; `None` if the program is not run as a benchmark.
fn options(arguments: impl Iterator<Item = String>) -> Result<Option<Options>, String> {
    let (mut options, mut is_bench) = (Options { out: None, quick: false }, false);
    let mut arguments = arguments;
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            // `cargo bench` passes it; `cargo test` runs this without time to spare.
            "--bench" => is_bench = true,
            "--quick" => options.quick = true,
            "--out" if options.out.is_none() => {
                options.out = Some(arguments.next().ok_or("--out: expected a folder")?.into())
            }
            other => return Err(format!("unknown option `{other}`: expected --out DIR, once, or --quick")),
        }
    }
    Ok(is_bench.then_some(options))
}

fn main() -> ExitCode {
    let options = match options(std::env::args().skip(1)) {
        Ok(Some(options)) => options,
        Ok(None) => return ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::from(2);
        }
    };
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let sets: &[&str] = if options.quick { &QUICK } else { &SETS };
    let sets = sets
        .iter()
        .map(|&set| Ok((set, measure::in_order(spheres::load(set, SEED)?.0))))
        .collect::<Result<Vec<_>, spheres::LoadError>>()?;
    let seconds = if options.quick { 0.1 } else { 1.0 };
    let mut rows = Vec::new();
    // All measured before the first model is built: the compilers that build it take the processor's time.
    for (set, spheres) in &sets {
        eprintln!("measuring {set}");
        let (contacts, measured) = measure::measure(set, spheres, seconds)?;
        let count = spheres.count() as u64;
        rows.push(Row { set: (*set).to_owned(), spheres: count, contacts, measured, simulated: None });
    }
    let Some(folder) = &options.out else {
        print!("{}", Times { settings: simulate::settings(None, options.quick), rows }.markdown());
        return Ok(());
    };
    eprintln!("building the models");
    let afus = Afus::new()?;
    for (row, (set, spheres)) in rows.iter_mut().zip(&sets) {
        eprintln!("simulating {set}");
        row.simulated = Some(afus.run(set, spheres, &measure::touching(spheres))?);
    }
    let times = Times { settings: simulate::settings(Some(&afus), options.quick), rows };
    times.write(folder)?;
    print!("{}", times.markdown());
    println!("\n{}", folder.join("report.html").display());
    Ok(())
}
