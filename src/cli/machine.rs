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

/// The options of an AFU except the numbers of its parts and the bits of a box, of which a sweep takes lists.
#[derive(Args, Debug)]
#[command(next_help_heading = "The AFU")]
pub struct Machine {
    /// The two bodies of a pair [default: sphere-sphere]
    #[arg(long, value_name = "QUERY", value_parser = super::usage::query())]
    pub query: Option<Query>,
    /// Arithmetic: paper, wide, exact, half, bfloat, or eXfY for X exponent and Y fraction bits [default: wide]
    ///
    /// `paper` is IEEE binary32, step by step as in the paper. `wide` gives the same bits wherever binary32 neither
    /// overflows nor underflows, and never fails grossly. `exact` decides every pair correctly; the host resolves the
    /// pairs that the hardware cannot decide. `half` is IEEE binary16, `bfloat` is bfloat16.
    #[arg(long, value_name = "NAME|eXfY")]
    pub profile: Option<Profile>,
    /// Rounding mode: nearest (ties to even) or zero (toward zero) [default: nearest]
    #[arg(long, value_name = "MODE")]
    pub rounding: Option<Rounding>,
    /// Subnormal numbers: kept (gradual underflow) or flushed (to zero) [default: the profile's own]
    #[arg(long, value_name = "MODE")]
    pub subnormals: Option<Subnormals>,
    /// Square roots and reciprocals: correct (correctly rounded) or faithful [default: correct]
    ///
    /// A faithful result is less than one unit in the last place from the exact value, and has a lower latency.
    #[arg(long, value_name = "MODE")]
    pub roots: Option<Roots>,
    /// Fields of a contact: a comma-separated list of hit, depth, normal, position [default: all four]
    ///
    /// Hardware for the other fields is not generated.
    #[arg(long, value_name = "FIELDS")]
    pub contact: Option<Fields>,
    /// What the AFU gets: direct (pairs, each with both bodies) or spheres, among which it finds those that touch
    /// [default: direct]
    ///
    /// With `spheres` only those that touch come back (--results hits): their numbers, and the fields of --contact.
    /// Hits, contact hit and shell line are then the defaults.
    #[arg(long, value_name = "KIND")]
    pub input: Option<Input>,
    /// Spheres that the table of the first set holds, for --input spheres: a power of two, 512 to 65536 [default:
    /// 4096]
    #[arg(long, value_name = "N")]
    pub table: Option<u32>,
    /// SCPUs that only decide which pairs touch, in front of those that compute contacts: 1, 2 or 4 [default: none]
    ///
    /// A decider takes a pair every cycle and needs a third of an SCPU's area. The others compute the contacts of the
    /// pairs that touch, one SCPU by default. What comes back has the same bits.
    #[arg(long, value_name = "N")]
    pub decide: Option<u32>,
    /// Pairs that the AFU returns: all, or hits (pairs that touch, each with its index) [default: all; with --decide
    /// and for input spheres hits]
    #[arg(long, value_name = "WHICH")]
    pub results: Option<Results>,
    /// One radius for all spheres, finite and at least 0 [default: each sphere has its own]
    ///
    /// The radius then is a constant of the hardware, and records leave it out.
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub radius: Option<f32>,
    /// Number format of records in memory: f32, f16 or bf16 [default: f32]
    ///
    /// With f16 or bf16 the host rounds the pairs, and a 64-byte line holds four pairs instead of two.
    #[arg(long, value_name = "FORMAT")]
    pub record: Option<RecordFormat>,
    /// Multiplier blocks of the FPGA: use or spare [default: use]
    ///
    /// `spare` computes roots and reciprocals digit by digit instead of by table. The results have the same bits, but
    /// need more logic and more cycles.
    #[arg(long, value_name = "CHOICE")]
    pub multipliers: Option<Multipliers>,
    /// Logic around the AFU's line port: spl2, axi or line [default: spl2]
    ///
    /// `spl2` connects the AFU to SPL2, the interface of Intel's HARP v1 (a Xeon with an FPGA), as in the paper.
    /// `axi` has an AXI4 master for memory and an AXI4-Lite slave for registers, as boards of today have them. `line`
    /// adds nothing: the AFU's own port reads and writes memory in lines of 64 bytes.
    #[arg(long, value_name = "SHELL")]
    pub shell: Option<Shell>,
    /// Reads, and writes, that the AFU keeps in flight: 16, 32, 64, 128 or 256 [default: 64]
    ///
    /// A link carries at most so many lines per latency: 64 lines in 850 ns are 4.8 GB/s. SPL2 takes at most 64.
    #[arg(long, value_name = "N")]
    pub outstanding: Option<u32>,
    /// Bits of the AXI4 master's data, only for shell axi: 128, 256 or 512 [default: 512]
    ///
    /// A line of 64 bytes is 4, 2 or 1 beats.
    #[arg(long, value_name = "BITS")]
    pub bus: Option<u32>,
    /// Clock frequency in MHz, 1 to 2000 [default: 200]
    ///
    /// Pipelines are cut into stages for this clock, and it converts cycles into time.
    #[arg(long, value_name = "MHZ")]
    pub clock: Option<f64>,
    /// Clock in MHz for which pipelines are cut, if the AFU runs at another one [default: --clock]
    ///
    /// Place and route may reach a lower clock than the stages were cut for: then --clock is what it reached.
    #[arg(long, value_name = "MHZ")]
    pub cut_for: Option<f64>,
    /// FPGA family, only for rtl and synth: ecp5 or ice40, for synth also cyclonev or xilinx [default: any family;
    /// for synth ecp5]
    #[arg(long, value_name = "FAMILY")]
    pub target: Option<String>,
    /// Read the AFU's configuration from a manifest.json or the folder of one; other options override it
    #[arg(long, value_name = "FILE|DIR")]
    pub config: Option<PathBuf>,
}

impl Machine {
    /// The family whose blocks are instantiated by name; `None` without `--target`.
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
        if self.input == Some(Input::Spheres) && self.config.is_none() {
            (config.results, config.contact, config.shell) = (Results::Hits, Fields::HIT, Shell::Line);
            set(&mut config.contact, &self.contact);
        }
        set(&mut config.search.table, &self.table);
        set(&mut config.decide, &self.decide);
        if self.decide.is_some_and(|number| number > 0) && self.config.is_none() {
            config.results = Results::Hits;
        }
        set(&mut config.results, &self.results);
        config.radius = self.radius.or(config.radius);
        set(&mut config.record, &self.record);
        set(&mut config.multipliers, &self.multipliers);
        set(&mut config.shell, &self.shell);
        set(&mut config.outstanding, &self.outstanding);
        set(&mut config.bus, &self.bus);
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
    /// Number of SCPUs (sphere collision processing units), 1 to 64 [default: 10; with --decide and for input
    /// spheres 1]
    ///
    /// With --input spheres, N SCPUs at interval II compute N/II contacts per cycle: 2 per cycle at most with all
    /// fields, which is a full line, and 4 with depth alone. Above 1 per cycle the rate is a power of two.
    #[arg(long, value_name = "N", help_heading = "The AFU")]
    pub scpus: Option<u32>,
    /// Initiation interval: an SCPU takes one pair per II cycles, 1 to 64, or auto [default: auto; for synth and
    /// paper 1]
    ///
    /// With a longer interval operations share operators: an SCPU is smaller, but its latency increases. `auto` is
    /// the longest interval that keeps the AFU link-bound; for input spheres it is 1.
    #[arg(long, value_name = "II", help_heading = "The AFU")]
    pub interval: Option<String>,
    /// Bits of each number of a box, for --input spheres: 10 to 32 [default: 24]
    ///
    /// Fewer bits make a smaller AFU and more candidates, and the same contacts.
    #[arg(long, value_name = "N", help_heading = "The AFU")]
    pub box_bits: Option<u32>,
    /// Boxes of spheres that are compared in a cycle, for --input spheres: a power of two, 16 to 256 [default: 16]
    #[arg(long, value_name = "N", help_heading = "The AFU")]
    pub lanes: Option<u32>,
    /// Kernels that decide candidates, for --input spheres: a power of two, 1 to 16 [default: 4]
    #[arg(long, value_name = "N", help_heading = "The AFU")]
    pub deciders: Option<u32>,
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
        set(&mut config.search.box_bits, &self.box_bits);
        set(&mut config.search.lanes, &self.lanes);
        set(&mut config.search.deciders, &self.deciders);
        if config.input == Input::Spheres
            && config.contact == Fields::HIT
            && let Some(scpus) = self.scpus
        {
            return Err(no_scpus(&format!("--scpus {scpus}")));
        }
        let resolves = config.has_deciders() && config.contact != Fields::HIT && self.machine.config.is_none();
        set(&mut config.scpus, &self.scpus.or(resolves.then_some(1)));
        let unsaid = if self.machine.config.is_none() { Some(unsaid) } else { None };
        match self.interval.as_deref().or(unsaid) {
            None => {}
            Some(AUTO) => {
                config.interval = 1;
                config.check()?;
                if config.input == Input::Spheres {
                    return Ok(config);
                }
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
        let Self { scpus, interval, box_bits, lanes, deciders, machine: m } = self;
        let given = [
            ("--interval", interval.is_some()),
            ("--query", m.query.is_some()),
            ("--profile", m.profile.is_some()),
            ("--rounding", m.rounding.is_some()),
            ("--subnormals", m.subnormals.is_some()),
            ("--roots", m.roots.is_some()),
            ("--contact", m.contact.is_some()),
            ("--input", m.input.is_some()),
            ("--table", m.table.is_some()),
            ("--box-bits", box_bits.is_some()),
            ("--lanes", lanes.is_some()),
            ("--deciders", deciders.is_some()),
            ("--decide", m.decide.is_some()),
            ("--results", m.results.is_some()),
            ("--radius", m.radius.is_some()),
            ("--record", m.record.is_some()),
            ("--multipliers", m.multipliers.is_some()),
            ("--shell", m.shell.is_some()),
            ("--outstanding", m.outstanding.is_some()),
            ("--bus", m.bus.is_some()),
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

/// Why an option of SCPUs is refused where there are none.
pub fn no_scpus(option: &str) -> Failure {
    let message =
        format!("{option} with --input spheres and --contact hit: deciders decide what touches; use --deciders");
    Failure::new(Kind::Usage, message)
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
    let (spec, mut link) = (Spec::from(config.clone()), link::read(link, config.clock_mhz)?);
    if config.shell == Shell::Axi {
        link = link.on_bus(config.bus);
    }
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
