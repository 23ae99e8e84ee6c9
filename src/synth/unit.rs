//! Units whose area and clock can be measured.

use std::sync::Arc;

use crate::afu::{Afu, Spec};
use crate::config::{Config, Input, Profile};
use crate::count::counted;
use crate::hdl::verilog::{Style, emit};
use crate::hdl::{BuildErrors, DelayModel, Module};
use crate::operator::{Architecture, Domain, Operator, Values, pipelined};

use super::{SynthError, Target};

/// A module to be measured.
#[derive(Clone, Debug)]
pub struct Unit {
    /// The kind of unit, such as `add` or `scpu`.
    pub name: String,
    /// The arithmetic of the unit.
    pub profile: Profile,
    /// The architecture, if the operator has several.
    pub architecture: Option<Architecture>,
    /// The initiation interval of an SCPU or an AFU, in cycles.
    pub interval: Option<u32>,
    /// The clock that its stages were cut for, MHz.
    pub clock_mhz: f64,
    /// The module of the unit.
    pub module: Arc<Module>,
    /// Cycles from inputs to outputs; `None` if the unit is not a pipeline.
    pub latency: Option<u32>,
}

impl Unit {
    /// An operator of a profile, for the given values, cut for a clock.
    ///
    /// # Errors
    /// Returns an error if the operator cannot be cut for this clock.
    pub fn operator(
        operator: Operator,
        profile: &Profile,
        values: Values,
        model: &DelayModel,
        clock_mhz: f64,
    ) -> Result<Self, SynthError> {
        let domain = Domain::new(profile.format(), values);
        let module = pipelined(operator, domain, model, clock_mhz)?;
        let architecture = Architecture::Table.is_possible(operator, domain).then(|| Architecture::of(model));
        Ok(Self { architecture, ..Self::pipeline(operator.name(), profile, clock_mhz, module) })
    }

    /// A unit of an existing pipeline.
    pub fn pipeline(name: &str, profile: &Profile, clock_mhz: f64, module: Arc<Module>) -> Self {
        let latency = Some(module.latency);
        Self {
            name: name.to_owned(),
            profile: profile.clone(),
            architecture: None,
            interval: None,
            clock_mhz,
            module,
            latency,
        }
    }

    /// The SCPU of a configuration: its kernel with detection of invalid pairs.
    ///
    /// # Errors
    /// Returns an error if the configuration cannot be generated.
    pub fn scpu(config: &Config) -> Result<Self, SynthError> {
        Self::scpu_with(config, DelayModel::default())
    }

    /// As [`Unit::scpu`], but cut for a target with its own delays ([`Target::delays`]) and its own multiplier blocks.
    ///
    /// # Errors
    /// Returns an error if the configuration cannot be generated.
    pub fn scpu_for(config: &Config, target: Target) -> Result<Self, SynthError> {
        Self::scpu_with(config, target.delays())
    }

    fn scpu_with(config: &Config, delays: DelayModel) -> Result<Self, SynthError> {
        let afu = Self::generate(config, delays)?;
        let module = afu.top().hierarchy().into_iter().find(|module| module.name == "scpu");
        let module = module.unwrap_or_else(|| afu.kernel().clone());
        let latency = Some(afu.kernel().latency);
        Ok(Self { name: "scpu".to_owned(), latency, module, ..Self::of(config, &afu) })
    }

    /// The whole AFU of a configuration, with its shell.
    ///
    /// # Errors
    /// Returns an error if the configuration cannot be generated.
    pub fn afu(config: &Config, target: Target) -> Result<Self, SynthError> {
        Ok(Self::of(config, &Self::generate(config, target.delays())?))
    }

    fn generate(config: &Config, delays: DelayModel) -> Result<Afu, SynthError> {
        Ok(Afu::generate(Spec { delays, ..Spec::from(config.clone()) })?)
    }

    fn of(config: &Config, afu: &Afu) -> Self {
        Self {
            name: match config.input {
                Input::Direct if config.decide > 0 => format!(
                    "afu of {} and {}, {}",
                    counted(config.decide.into(), "decider"),
                    counted(config.scpus.min(config.interval).into(), "SCPU"),
                    config.shell
                ),
                Input::Direct => format!("afu of {}, {}", counted(config.scpus.into(), "SCPU"), config.shell),
                Input::Spheres => format!("afu of spheres, {}", config.shell),
            },
            profile: config.profile.clone(),
            architecture: None,
            interval: Some(config.interval),
            clock_mhz: config.clock_mhz,
            module: afu.top().clone(),
            latency: None,
        }
    }

    /// The clock in MHz that the delay model predicts, which the slowest part decides; `None` if no stages were cut.
    pub fn modelled_mhz(&self) -> Option<f64> {
        let timings = self.module.hierarchy();
        timings.iter().filter_map(|module| module.timing.as_ref()).map(|timing| timing.clock_mhz).reduce(f64::min)
    }

    /// The unit and its arithmetic, for messages.
    pub fn title(&self) -> String {
        let every = self.interval.filter(|interval| *interval > 1).map(|interval| format!(" every {interval}"));
        format!("{} {}{}", self.name, self.profile, every.unwrap_or_default())
    }

    /// The Verilog of `top` and everything below it, one file per module: file name and text.
    pub(super) fn files(top: &Arc<Module>, target: Target) -> Vec<(String, String)> {
        let style = Style { memories: target.memories(), ..Style::default() };
        let file = |module: Arc<Module>| (format!("{}.v", module.name), emit(&module, &style));
        top.hierarchy().into_iter().map(file).collect()
    }

    /// The Verilog of a wrapper around a unit; the unit is declared by its ports only.
    pub(super) fn wrapper_files(bench: &Arc<Module>, unit: &Module) -> Vec<(String, String)> {
        let style = Style::default();
        let mut ports = Vec::new();
        if unit.is_clocked() {
            ports.push(format!("input wire {}", unit.clock()));
        }
        if unit.has_reset_port() {
            ports.push(format!("input wire {}", style.reset_port()));
        }
        for port in &unit.ports {
            let direction = if port.output { "output" } else { "input" };
            ports.push(format!("{direction} wire [{}:0] {}", port.width - 1, port.name));
        }
        let empty = format!("(* blackbox *)\nmodule {} ({});\nendmodule\n", unit.name, ports.join(", "));
        vec![("bench.v".to_owned(), emit(bench, &style)), (format!("{}.v", unit.name), empty)]
    }

    /// The unit in its wrapper.
    pub(super) fn wrapped(&self) -> Result<Arc<Module>, BuildErrors> {
        super::wrapper::wrap(&self.module)
    }
}
