//! `afu rtl`: an AFU's Verilog, and what tools and people need around it.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use contact_afu::afu::{Afu, BuildError, Package, PackageError, Spec};
use contact_afu::config::Input;
use contact_afu::hdl::Reset;
use contact_afu::query::Fields;
use contact_afu::report::folder::{self, Folder};
use contact_afu::report::table::counted;
use contact_afu::synth::Target;

use super::failure::{Failure, Kind};
use super::machine::{One, warn_of_unused_scpus};
use super::output;

/// Write an AFU's Verilog with file list, constraints, port documentation and test bench
///
/// An AFU (accelerator functional unit) reads pairs of bodies from memory and writes a contact for each pair. The
/// folder also holds a FuseSoC core, an instantiation template and manifest.json, which --config reads. The same
/// options always give the same bytes.
#[derive(Args, Debug)]
pub struct Rtl {
    /// Folder to write
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Replace the folder even if afu did not write it
    #[arg(long)]
    force: bool,
    /// Active level of the reset, and whether it is asynchronous
    #[arg(long, value_enum, value_name = "STYLE", default_value_t = Style::High, help_heading = "The AFU")]
    reset: Style,
    /// Begin the names of all modules and files with NAME_, so that one design can hold several AFUs
    ///
    /// NAME is 1 to 32 letters, digits and underscores, and does not begin with a digit.
    #[arg(long, value_name = "NAME", help_heading = "The AFU")]
    prefix: Option<String>,
    /// Also write what other tools want: a comma-separated list of ipxact, litex, fusesoc
    ///
    /// `ipxact` is a component.xml of IEEE 1685-2022, and a script that packages a Vitis kernel in Vivado (neither was
    /// tried in Vivado). `litex` is a Python module for a SoC of LiteX. Both are for --shell axi. `fusesoc` is the core
    /// file that every folder has.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIST", hide_possible_values = true)]
    package: Vec<Tool>,
    /// Link for which --interval auto chooses the interval: a name or file as in `afu cosim`
    #[arg(long, value_name = "NAME|FILE", default_value = "ideal", help_heading = "The AFU")]
    link: String,
    #[command(flatten)]
    one: One,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum Style {
    /// Synchronous, active high
    High,
    /// Synchronous, active low
    Low,
    /// Asynchronous, active high
    AsyncHigh,
    /// Asynchronous, active low
    AsyncLow,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum Tool {
    Fusesoc,
    Ipxact,
    Litex,
}

impl From<Tool> for Package {
    fn from(tool: Tool) -> Self {
        match tool {
            Tool::Fusesoc => Self::Fusesoc,
            Tool::Ipxact => Self::Ipxact,
            Tool::Litex => Self::Litex,
        }
    }
}

impl From<PackageError> for Failure {
    fn from(error: PackageError) -> Self {
        Self::caused(Kind::Usage, error)
    }
}

impl From<Style> for Reset {
    fn from(style: Style) -> Self {
        Self {
            asynchronous: matches!(style, Style::AsyncHigh | Style::AsyncLow),
            active_low: matches!(style, Style::Low | Style::AsyncLow),
        }
    }
}

pub fn run(options: &Rtl) -> Result<(), Failure> {
    let target = options.one.machine.target()?;
    let mut config = options.one.config_for_any_target(&options.link)?;
    config.prefix = options.prefix.clone().or(config.prefix);
    config.check()?;
    let packages: Vec<Package> = options.package.iter().map(|&tool| tool.into()).collect();
    packages.iter().try_for_each(|package| package.check(config.shell))?;
    let spec = Spec { reset: options.reset.into(), ..Spec::from(config) };
    let spec = match target {
        Some(target) => target.specialise(spec).ok_or_else(|| no_blocks(target))?,
        None => spec,
    };
    folder::check(&options.out, options.force)?;
    let afu = Afu::generate(spec)?;
    let folder = Folder::begin(&options.out, options.force)?;
    let files = afu.files_with(&packages);
    for (name, text) in &files {
        folder.write(name, text.as_bytes())?;
    }
    folder.commit()?;
    let config = &afu.spec().config;
    warn_of_unused_scpus(config);
    let (unit, number) = match config.input {
        Input::Direct if config.decide == 0 => ("SCPU", config.scpus),
        Input::Spheres if config.contact == Fields::HIT => ("decider", config.search.deciders),
        _ => ("SCPU", afu.spec().scpus_in_turn(config.interval)),
    };
    let article = if unit == "SCPU" { "an" } else { "a" };
    let text = format!(
        "{}: {}; {}, {}, latency of {article} {unit} {} cycles at {} MHz",
        options.out.display(),
        counted(files.len() as u64, "file"),
        counted(number.into(), unit),
        config.profile,
        afu.kernel().latency,
        config.clock_mhz
    );
    output::show(&text, false)
}

/// The error for a family that has no Verilog of its own.
fn no_blocks(target: Target) -> Failure {
    let message = format!(
        "--target {target}: afu writes Verilog for ecp5, for ice40, or without --target for any family; \
         `afu synth --target {target}` estimates the area"
    );
    Failure::new(Kind::Usage, message)
}

impl From<BuildError> for Failure {
    fn from(error: BuildError) -> Self {
        let kind = match error {
            BuildError::Spec(_) => Kind::Usage,
            BuildError::Hardware(_) => Kind::Other,
        };
        Self::caused(kind, error)
    }
}
