//! `afu rtl`: an AFU's Verilog, and what tools and people need around it.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use contact_afu::afu::{Afu, BuildError, Spec};
use contact_afu::hdl::Reset;
use contact_afu::report::folder::{self, Folder};
use contact_afu::synth::Target;

use super::failure::{Failure, Kind};
use super::machine::{One, warn_of_unused_scpus};
use super::output;

#[derive(Args, Debug)]
pub struct Rtl {
    /// Folder to write: .v files, file list, FuseSoC core, constraints, instantiation template, PORTS.md, test bench,
    /// manifest.json
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Replace the folder even if afu did not write it
    #[arg(long)]
    force: bool,
    /// Reset level, and whether it acts without a clock edge
    #[arg(long, value_enum, value_name = "STYLE", default_value_t = Style::High, help_heading = "The AFU")]
    reset: Style,
    /// Name that all modules and their files begin with, and a _: so that several AFUs fit in one design
    #[arg(long, value_name = "NAME", help_heading = "The AFU")]
    prefix: Option<String>,
    /// Link that --interval auto is for: ideal, late, shuffled, hostile, harp1, harp2, pcie3x8, or a file of a link
    #[arg(long, value_name = "NAME|FILE", default_value = "ideal", help_heading = "The AFU")]
    link: String,
    #[command(flatten)]
    one: One,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum Style {
    High,
    Low,
    AsyncHigh,
    AsyncLow,
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
    let spec = Spec { reset: options.reset.into(), ..Spec::from(config) };
    let spec = match target {
        Some(target) => target.specialise(spec).ok_or_else(|| no_blocks(target))?,
        None => spec,
    };
    folder::check(&options.out, options.force)?;
    let afu = Afu::generate(spec)?;
    let folder = Folder::begin(&options.out, options.force)?;
    let files = afu.files();
    for (name, text) in &files {
        folder.write(name, text.as_bytes())?;
    }
    folder.commit()?;
    let config = &afu.spec().config;
    warn_of_unused_scpus(config);
    let text = format!(
        "{}: {} files; {} SCPUs, {}, a contact {} cycles after its pair at {} MHz",
        options.out.display(),
        files.len(),
        config.scpus,
        config.profile,
        afu.kernel().latency,
        config.clock_mhz
    );
    output::show(&text, false)
}

/// A family for which there is nothing but the Verilog for all of them.
fn no_blocks(target: Target) -> Failure {
    let message = format!(
        "--target {target}: there is no Verilog for this family alone; without --target it is for any, with --target \
         ecp5 or ice40 for one, and `afu synth --target {target}` estimates the area"
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
