//! The options that describe an AFU, the same in every subcommand.

use std::path::PathBuf;

use clap::Args;
use contact_afu::afu::Spec;
use contact_afu::config::{self, Config, Input, Multipliers, Profile, RecordFormat, Results, Shell};
use contact_afu::number::{FormatError, Roots, Rounding, Subnormals};
use contact_afu::query::{Fields, Query};
use contact_afu::synth::Target;

use super::failure::{Classify, Failure, Kind};
use super::link;

/// Everything but how many SCPUs and how fast each takes pairs: a sweep has lists of those.
#[derive(Args, Debug)]
#[command(next_help_heading = "The AFU")]
pub struct Machine {
    /// Which two bodies a pair is of [default: sphere-sphere]
    #[arg(long, value_name = "QUERY", value_parser = super::usage::query())]
    pub query: Option<Query>,
    /// Arithmetic: paper (IEEE binary32), wide, exact, half, bfloat or eXfY (exponent and fraction bits) [default:
    /// wide]
    #[arg(long, value_name = "NAME|eXfY")]
    pub profile: Option<Profile>,
    /// Rounding: nearest (ties to even) or zero (toward it) [default: nearest]
    #[arg(long, value_name = "HOW")]
    pub rounding: Option<Rounding>,
    /// Numbers below the smallest normal one: kept or flushed to zero [default: as the profile has them]
    #[arg(long, value_name = "HOW")]
    pub subnormals: Option<Subnormals>,
    /// Square root and reciprocal: correct (rounded correctly) or faithful (within a unit, faster) [default: correct]
    #[arg(long, value_name = "HOW")]
    pub roots: Option<Roots>,
    /// What comes back for a pair: a list of hit, depth, normal, position [default: all four]
    #[arg(long, value_name = "FIELDS")]
    pub contact: Option<Fields>,
    /// How pairs are given: direct (both bodies whole) [default: direct]
    #[arg(long, value_name = "KIND")]
    pub input: Option<Input>,
    /// Which pairs come back: all, or hits (those that touch, each with its number) [default: all]
    #[arg(long, value_name = "WHICH")]
    pub results: Option<Results>,
    /// One radius for all spheres, which is then part of the hardware and of no record [default: each its own]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub radius: Option<f32>,
    /// Numbers of records in memory: f32, or f16 or bf16, to which pairs are rounded, and of which a line holds four
    /// [default: f32]
    #[arg(long, value_name = "FORMAT")]
    pub record: Option<RecordFormat>,
    /// Multiplier blocks: use, or spare (roots and reciprocals digit by digit: more logic and cycles, the same bits)
    /// [default: use]
    #[arg(long, value_name = "HOW")]
    pub multipliers: Option<Multipliers>,
    /// What stands around the AFU's line port: spl2 (Intel HARP v1), line (nothing) [default: spl2]
    #[arg(long, value_name = "SHELL")]
    pub shell: Option<Shell>,
    /// Clock to run at, MHz: pipelines are cut for it, and time is told in it [default: 200]
    #[arg(long, value_name = "MHZ")]
    pub clock: Option<f64>,
    /// Cut pipelines for this clock instead, MHz: a router may reach less than they were cut for [default: --clock]
    #[arg(long, value_name = "MHZ")]
    pub cut_for: Option<f64>,
    /// FPGA family that the Verilog is for: ecp5 or ice40, and for synth also cyclonev or xilinx; only for rtl and
    /// synth [default: any; of synth ecp5]
    #[arg(long, value_name = "NAME")]
    pub target: Option<String>,
    /// Take the configuration from a manifest.json (or a folder with one); options given beside it win
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
}

impl Machine {
    /// The family whose blocks are written by name; nothing where none is given.
    pub fn target(&self) -> Result<Option<Target>, Failure> {
        self.target.as_ref().map(|word| word.parse().map_err(|error| Failure::caused(Kind::Usage, error))).transpose()
    }

    /// The configuration file's or the default one, with the options given over it, where there is no target.
    #[cfg(feature = "cosim")]
    pub fn config(&self) -> Result<Config, Failure> {
        if let Some(target) = &self.target {
            let message =
                format!("--target {target}: only for rtl and synth; what is simulated is the same for all families");
            return Err(Failure::new(Kind::Usage, message));
        }
        self.config_for_any_target()
    }

    /// The options of arithmetic over those of the profile.
    fn with_options(&self, mut profile: Profile) -> Result<Profile, FormatError> {
        if let Some(rounding) = self.rounding {
            profile = profile.with_rounding(rounding)?;
        }
        if let Some(subnormals) = self.subnormals {
            profile = profile.with_subnormals(subnormals)?;
        }
        match self.roots {
            Some(roots) => profile.with_roots(roots),
            None => Ok(profile),
        }
    }

    /// The same for any target.
    pub fn config_for_any_target(&self) -> Result<Config, Failure> {
        let mut config = match &self.config {
            Some(file) => config::read(file).ends(Kind::Usage)?,
            None => Config::default(),
        };
        set(&mut config.query, &self.query);
        set(&mut config.profile, &self.profile);
        config.profile = self.with_options(config.profile).ends(Kind::Usage)?;
        set(&mut config.contact, &self.contact);
        set(&mut config.input, &self.input);
        set(&mut config.results, &self.results);
        config.radius = self.radius.or(config.radius);
        set(&mut config.record, &self.record);
        set(&mut config.multipliers, &self.multipliers);
        set(&mut config.shell, &self.shell);
        if let Some(clock) = self.clock {
            // A file's stages are of the file's clock.
            (config.clock_mhz, config.cut_mhz) = (clock, None);
        }
        config.cut_mhz = self.cut_for.or(config.cut_mhz);
        Ok(config)
    }
}

/// One AFU.
#[derive(Args, Debug)]
pub struct One {
    /// Sphere Collision Processing Units, 1 to 64 [default: 10]
    #[arg(long, value_name = "N", help_heading = "The AFU")]
    pub scpus: Option<u32>,
    /// Cycles from one pair to the next in one SCPU, 1 to 64: above 1 it has fewer operators. auto: the most at which
    /// the link is still what limits [default: auto; of synth and paper 1]
    #[arg(long, value_name = "II", help_heading = "The AFU")]
    pub interval: Option<String>,
    #[command(flatten)]
    pub machine: Machine,
}

impl One {
    /// The configuration, known to be one that can be generated. The interval, where neither option nor file says it,
    /// is `auto`: for that link, a name or file.
    #[cfg(feature = "cosim")]
    pub fn config_over(&self, link: &str) -> Result<Config, Failure> {
        self.with(self.machine.config()?, link, AUTO)
    }

    /// The same, whatever the target is.
    pub fn config_for_any_target(&self, link: &str) -> Result<Config, Failure> {
        self.with(self.machine.config_for_any_target()?, link, AUTO)
    }

    /// The same from the machine's configuration, with interval 1 where none is said: for what measures an SCPU by
    /// itself, or by the number of SCPUs.
    pub fn at_full_rate(&self, config: Config, link: &str) -> Result<Config, Failure> {
        self.with(config, link, "1")
    }

    fn with(&self, mut config: Config, link: &str, unsaid: &str) -> Result<Config, Failure> {
        set(&mut config.scpus, &self.scpus);
        let unsaid = if self.machine.config.is_none() { Some(unsaid) } else { None };
        match self.interval.as_deref().or(unsaid) {
            None => {}
            Some(AUTO) => {
                config.interval = 1;
                config.check()?;
                config.interval = longest_interval(&config, link)?;
            }
            Some(interval) => config.interval = interval_of(interval)?,
        }
        config.check()?;
        Ok(config)
    }
}

#[cfg(feature = "cosim")]
impl One {
    /// The number of SCPUs, when it alone may be given: the rest is decided by Verilog that is there already.
    pub fn only_scpus(&self) -> Result<Option<u32>, Failure> {
        let Self { scpus, interval, machine: m } = self;
        let given = [
            ("--interval", interval.is_some()),
            ("--query", m.query.is_some()),
            ("--profile", m.profile.is_some()),
            ("--rounding", m.rounding.is_some()),
            ("--subnormals", m.subnormals.is_some()),
            ("--roots", m.roots.is_some()),
            ("--contact", m.contact.is_some()),
            ("--input", m.input.is_some()),
            ("--results", m.results.is_some()),
            ("--radius", m.radius.is_some()),
            ("--record", m.record.is_some()),
            ("--multipliers", m.multipliers.is_some()),
            ("--shell", m.shell.is_some()),
            ("--clock", m.clock.is_some()),
            ("--cut-for", m.cut_for.is_some()),
            ("--target", m.target.is_some()),
            ("--config", m.config.is_some()),
        ];
        match given.into_iter().find(|(_, given)| *given) {
            None => Ok(*scpus),
            Some((option, _)) => {
                let message = format!("{option} does not go with --rtl: the Verilog's own manifest says it");
                Err(Failure::new(Kind::Usage, message))
            }
        }
    }
}

/// Warns about SCPUs that are not built.
pub fn warn_of_unused_scpus(config: &Config) {
    if let Some(text) = Spec::from(config.clone()).unused_scpus() {
        eprintln!("afu: warning: {text}");
    }
}

/// The word for an interval that follows from the link.
const AUTO: &str = "auto";

/// `--interval`: a number of cycles.
fn interval_of(text: &str) -> Result<u32, Failure> {
    text.parse().map_err(|_| Failure::new(Kind::Usage, format!("--interval {text}: give a number of cycles, or auto")))
}

/// The longest interval at which SCPUs still take all pairs that the link brings, and takes contacts of.
fn longest_interval(config: &Config, link: &str) -> Result<u32, Failure> {
    let (spec, link) = (Spec::from(config.clone()), link::read(link, config.clock_mhz)?);
    // Contacts alone may be none.
    let contacts = if config.results == Results::Hits { 0 } else { MANY };
    let cycles = link.limit_cycles(spec.layout().source_lines(MANY), spec.layout().destination_lines(contacts));
    Ok(spec.longest_interval(MANY as f64 / cycles))
}

/// Pairs of a job long enough for a rate.
const MANY: u64 = 1 << 20;

fn set<T: Clone>(to: &mut T, given: &Option<T>) {
    if let Some(given) = given {
        to.clone_from(given);
    }
}
