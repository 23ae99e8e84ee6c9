//! The external programs: which were found, what needs them, and how to install them.

// cosim/verilate has this file too, which a build script shares and a build without simulation leaves out.
#[allow(clippy::duplicate_mod)]
#[path = "../cosim/verilate/environments.rs"]
mod environments;
mod features;
mod install;
mod probe;
mod synthesis;

pub use features::summary;
pub(crate) use features::{FEATURES, Feature};
pub use install::ode as ode_install;
pub use synthesis::{MissingTool, Program};

use serde::Serialize;

/// A program or library this crate uses but does not contain.
#[derive(Clone, Debug, Serialize)]
pub struct Tool {
    /// The name.
    pub name: &'static str,
    /// The version that it reports, or its path if it reports none; `None` if it was not found.
    pub found: Option<String>,
    /// The commands that need it.
    pub needed_for: &'static str,
    /// True if simulation (`afu cosim`, `afu sweep`) needs it.
    pub required: bool,
    /// The command that installs it, on Debian and its kin.
    pub install: &'static str,
}

/// Looks for every tool.
pub fn all() -> Vec<Tool> {
    let simulates = cfg!(feature = "cosim");
    let tool = |name, found, required, needed_for, install| Tool { name, found, needed_for, required, install };
    vec![
        tool(
            "C++ compiler",
            probe::compiler(),
            simulates,
            "afu cosim, afu sweep: compiling a model",
            "apt-get install g++",
        ),
        tool(
            "Verilator",
            probe::verilator(),
            simulates,
            "afu cosim, afu sweep: the model itself",
            install::by("./scripts/setup, or apt-get install verilator", "apt-get install verilator"),
        ),
        tool(
            "libclang",
            probe::libclang(),
            false,
            "building this program with its built-in model",
            "apt-get install libclang-dev",
        ),
        tool(
            "zlib",
            probe::header("zlib.h"),
            false,
            "afu cosim --trace FILE.fst: FST waveforms (VCD needs nothing)",
            "apt-get install zlib1g-dev liblz4-dev",
        ),
        tool(
            "Icarus Verilog",
            probe::version("iverilog", &["-V"]),
            false,
            "tests: the same RTL in a second, four-state simulator",
            "apt-get install iverilog",
        ),
        tool(
            "ODE",
            probe::header("ode/odeinit.h"),
            false,
            "building this program with its feature ode: the Open Dynamics Engine",
            "apt-get install libode-dev",
        ),
        tool(
            "Yosys",
            says(Program::yosys()),
            false,
            "afu synth: counting cells; tests: no latch, no multiple driver",
            synthesis::YOSYS.install(),
        ),
        tool(
            "nextpnr-ecp5",
            says(Program::nextpnr("ecp5")),
            false,
            "afu synth: place and route",
            synthesis::NEXTPNR.install(),
        ),
        tool(
            "nextpnr-ice40",
            says(Program::nextpnr("ice40")),
            false,
            "afu synth --target ice40: place and route",
            synthesis::NEXTPNR_ICE40,
        ),
        tool(
            "Yices",
            synthesis::version("yices-smt2"),
            false,
            "scripts/prove, tests: proving the controller",
            synthesis::YICES.install(),
        ),
        tool(
            "Z3",
            synthesis::version("z3"),
            false,
            "scripts/prove where there is no Yices, or with PROVER=z3: the same, slower",
            synthesis::Z3.install(),
        ),
    ]
}

fn says(found: Result<Program, MissingTool>) -> Option<String> {
    found.ok().map(|program| program.version().to_owned())
}

/// The tools that make models, with what they say of themselves.
pub fn simulators() -> std::collections::BTreeMap<String, String> {
    let found = [("C++ compiler", probe::compiler()), ("Verilator", probe::verilator())];
    found.into_iter().filter_map(|(name, found)| Some((name.to_owned(), found?))).collect()
}
