//! The command line: a file a subcommand, which reads options, calls the library and writes what it gives.

#[cfg(feature = "cosim")]
mod accuracy;
#[cfg(feature = "cosim")]
mod choose;
mod completions;
#[cfg(feature = "cosim")]
mod cosim;
mod doctor;
mod failure;
mod hard;
mod link;
mod list;
mod machine;
#[cfg(feature = "cosim")]
mod origin;
mod output;
mod pairs;
#[cfg(feature = "cosim")]
mod paper;
mod progress;
mod rtl;
mod scene;
#[cfg(feature = "cosim")]
mod sweep;
mod synth;
mod usage;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::Failure;

/// Generates, simulates and proves the Verilog of a collision-detection accelerator.
///
/// Exit status: 0 pass; 1 a mismatch, a failed check or a job that does not finish; 2 bad usage or input; 3 a missing
/// tool; 4 anything else. Results go to standard output or files, progress and messages to standard error.
#[derive(Parser, Debug)]
#[command(name = "afu", version = usage::version())]
pub struct Program {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Write the Verilog of an AFU with file list, FuseSoC core, constraints, template and manifest
    Rtl(rtl::Rtl),
    #[cfg(feature = "cosim")]
    Cosim(cosim::Cosim),
    /// Write a named set of pairs to a file
    Pairs(pairs::Pairs),
    #[cfg(feature = "cosim")]
    Sweep(sweep::Sweep),
    #[cfg(feature = "cosim")]
    Paper(paper::Paper),
    Scene(scene::Scene),
    /// Measure an operator, an SCPU or the AFU on an FPGA: cells by Yosys, the clock by nextpnr
    Synth(synth::Synth),
    #[cfg(feature = "cosim")]
    Accuracy(accuracy::Accuracy),
    #[cfg(feature = "cosim")]
    Choose(choose::Choose),
    Hard(hard::Hard),
    /// Say which tools are there, what needs them, and what installs the missing ones
    Doctor(doctor::Doctor),
    /// Print a shell's completion script
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
        Command::Hard(options) => hard::run(options),
        Command::Doctor(options) => doctor::run(options),
        Command::Completions(options) => completions::run(options),
    }
}
