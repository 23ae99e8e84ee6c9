//! The command line: one file per subcommand, which reads options, calls the library and writes the results.

#[cfg(feature = "cosim")]
mod accuracy;
#[cfg(feature = "cosim")]
mod choose;
mod completions;
#[cfg(feature = "cosim")]
mod cosim;
#[cfg(feature = "cosim")]
mod cosim_spheres;
mod doctor;
#[cfg(all(test, feature = "cosim", feature = "ode"))]
mod documentation;
mod failure;
mod hard;
mod link;
mod list;
mod machine;
mod merge;
mod origin;
mod output;
mod pairs;
#[cfg(feature = "cosim")]
mod paper;
mod progress;
mod rtl;
mod scene;
mod spheres;
mod study;
#[cfg(feature = "cosim")]
mod sweep;
mod synth;
mod usage;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::Failure;

/// Generates, simulates and checks the Verilog of a collision-detection accelerator for FPGAs
///
/// An AFU (accelerator functional unit) reads pairs of bodies from memory and writes a contact for each pair: whether
/// they touch, depth, normal and position. Its SCPUs (sphere collision processing units) work in parallel.
/// `afu help COMMAND` explains all options of a command.
///
/// Exit status: 0 success; 1 a mismatch, a failed check, a job that did not finish, or a point of a study that failed
/// or is missing; 2 wrong usage or input; 3 a missing tool; 4 any other error; 5 a study that waits for other shards.
/// Results go to standard output or files. Progress and messages go to standard error.
#[derive(Parser, Debug)]
#[command(name = "afu", version = usage::version())]
pub struct Program {
    #[command(subcommand)]
    command: Command,
}

/// The subcommands. [`usage::GROUPS`] says how the help groups them.
#[derive(Subcommand, Debug)]
enum Command {
    Rtl(rtl::Rtl),
    #[cfg(feature = "cosim")]
    Cosim(cosim::Cosim),
    Pairs(pairs::Pairs),
    Spheres(spheres::Spheres),
    #[cfg(feature = "cosim")]
    Sweep(sweep::Sweep),
    #[cfg(feature = "cosim")]
    Paper(paper::Paper),
    Scene(scene::Scene),
    Synth(synth::Synth),
    #[cfg(feature = "cosim")]
    Accuracy(accuracy::Accuracy),
    #[cfg(feature = "cosim")]
    Choose(choose::Choose),
    Merge(merge::Merge),
    Hard(hard::Hard),
    Doctor(doctor::Doctor),
    Completions(completions::Completions),
}

/// Runs the program.
pub fn main() -> ExitCode {
    let program = match usage::parse(std::env::args_os()) {
        Ok(program) => program,
        Err(error) => return usage::report(&error),
    };
    match run(&program) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

fn run(program: &Program) -> Result<(), Failure> {
    match &program.command {
        Command::Rtl(options) => rtl::run(options),
        #[cfg(feature = "cosim")]
        Command::Cosim(options) => cosim::run(options),
        Command::Pairs(options) => pairs::run(options),
        Command::Spheres(options) => spheres::run(options),
        #[cfg(feature = "cosim")]
        Command::Sweep(options) => sweep::run(options),
        #[cfg(feature = "cosim")]
        Command::Paper(options) => paper::run(options),
        Command::Scene(options) => scene::run(options),
        Command::Synth(options) => synth::run(options),
        #[cfg(feature = "cosim")]
        Command::Accuracy(options) => accuracy::run(options),
        #[cfg(feature = "cosim")]
        Command::Choose(options) => choose::run(options),
        Command::Merge(options) => merge::run(options),
        Command::Hard(options) => hard::run(options),
        Command::Doctor(options) => doctor::run(options),
        Command::Completions(options) => completions::run(options),
    }
}
