//! An AFU that is ready to run jobs.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::check::{Verdict, check};
use super::error::VerifyError;
use super::replay::Setup;
use crate::afu::{Afu, Spec, file_list, top_name};
use crate::config::{self, Config, Results};
use crate::cosim::{CosimError, File, Model, Source, Trace};
use crate::host::Expected;
use crate::host::simulated::{Given, Run};
use crate::kernel::Reference;
use crate::link::{LinkModel, Traffic};
use crate::query::PairRecord;

/// The Verilog parameter for the number of SCPUs.
const SCPUS: &str = "SCPUS";
/// Progress of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Number of pairs simulated so far.
    Simulated(u64),
    /// The simulation has ended; the host compares with the reference.
    Comparing,
}

/// The origin of a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Part of this program, and made from exactly the requested Verilog.
    BuiltIn,
    /// Built, or found in the cache; this is the library.
    Library(PathBuf),
}

/// A simulated AFU with the reference it is compared with. Any number of jobs can be run on it, each from reset.
#[derive(Clone, Debug)]
pub struct Bench {
    config: Config,
    folder: Option<PathBuf>,
    source: Source,
    model: Model,
    pub(super) expected: Expected,
    reference: Reference,
}

impl Bench {
    /// Generates the Verilog of a configuration and gets a model of it: the built-in one if it was made from the same
    /// Verilog, otherwise one from the cache or from Verilator.
    ///
    /// # Errors
    /// Returns an error if the configuration cannot be generated, or if a tool is missing or fails.
    pub fn new(config: &Config) -> Result<Self, VerifyError> {
        Self::traced(config, Trace::Off)
    }

    /// As [`Bench::new`], with a model that can write waveforms.
    ///
    /// # Errors
    /// Returns the errors of `new`.
    pub fn traced(config: &Config, trace: Trace) -> Result<Self, VerifyError> {
        Self::of(config, generated(config)?, |source| Model::build(source, trace), trace == Trace::Off)
    }

    /// As [`Bench::new`], with a model from the folder `cache` even if the built-in one would serve, so that the time
    /// of a build can be measured. Verilator's runtime comes from the user's folder.
    ///
    /// # Errors
    /// Returns the errors of `new`.
    pub(crate) fn cached_in(config: &Config, cache: &Path) -> Result<Self, VerifyError> {
        Self::of(config, generated(config)?, |source| Model::build_alone_in(source, Trace::Off, cache), false)
    }

    /// The Verilog in `folder`, which `afu rtl` wrote and which may have been edited. `scpus` overrides the manifest's
    /// number.
    ///
    /// # Errors
    /// Returns the errors of `new`, and an error if the folder's manifest or file list cannot be read.
    pub fn of_folder(folder: &Path, scpus: Option<u32>, trace: Trace) -> Result<Self, VerifyError> {
        let in_folder = config::read(folder)?;
        let config = Config { scpus: scpus.unwrap_or(in_folder.scpus), ..in_folder.clone() };
        Spec::from(config.clone()).check().map_err(crate::afu::BuildError::from)?;
        let source = Source::from_list(&folder.join(file_list(&config)), &top_name(&config))?;
        let source = with_scpus(source, &config, in_folder.scpus);
        let bench = Self::of(&config, source, |source| Model::build(source, trace), trace == Trace::Off)?;
        Ok(Self { folder: Some(folder.to_owned()), ..bench })
    }

    fn of(
        config: &Config,
        source: Source,
        build: impl FnOnce(&Source) -> Result<Model, CosimError>,
        built_in_serves: bool,
    ) -> Result<Self, VerifyError> {
        let is_same = |model: &Model| source.parameters().is_empty() && model.rtl_sha256() == source.sha256();
        let model = match Model::built_in().filter(|model| built_in_serves && is_same(model)) {
            Some(model) => model,
            None => build(&source)?,
        };
        Ok(Self {
            config: config.clone(),
            folder: None,
            source,
            model,
            expected: Expected::edited(config),
            reference: config.reference(),
        })
    }

    /// The AFU's configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The origin of the model.
    pub fn origin(&self) -> Origin {
        self.model.shared_object().map_or(Origin::BuiltIn, |path| Origin::Library(path.to_owned()))
    }

    /// The model, for callers with their own driver.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// SHA-256 of the Verilog, in hex.
    pub fn rtl_sha256(&self) -> String {
        self.source.sha256()
    }

    /// Sends pairs through the AFU over a link and compares the results. `seed` decides the link's randomness and the
    /// initial values of registers without a reset.
    ///
    /// # Errors
    /// Returns an error if the job does not finish, or if the AFU breaks the line port's protocol. Mismatches are not
    /// errors.
    pub fn run(&self, pairs: &[PairRecord], link: &LinkModel, seed: u64) -> Result<Verdict, VerifyError> {
        self.run_with(pairs, link, seed, None, |_| {})
    }

    /// As [`Bench::run`], but writes a waveform and reports progress now and then.
    ///
    /// # Errors
    /// Returns the errors of `run`, and an error if the waveform cannot be written.
    pub fn run_with(
        &self,
        pairs: &[PairRecord],
        link: &LinkModel,
        seed: u64,
        waveform: Option<&Path>,
        mut progress: impl FnMut(Progress),
    ) -> Result<Verdict, VerifyError> {
        let layout = self.expected.layout;
        let count = u32::try_from(pairs.len()).map_err(|_| VerifyError::Pairs(pairs.len()))?;
        layout.check(pairs)?;
        let begun = Instant::now();
        let instance = self.model.instance(seed)?;
        if let Some(path) = waveform {
            let half_period_ps = (500.0 * self.config.cycle_ns()).round() as u64;
            instance.trace_open(path, half_period_ps).map_err(CosimError::from)?;
        }
        let setup = Setup { config: self.config.clone(), folder: self.folder.clone(), link: link.clone(), seed };
        let mut tell = |traffic: Traffic| {
            let pairs = match self.config.results {
                Results::All => traffic.write_responses * u64::from(layout.contacts_per_line()),
                Results::Hits => traffic.read_responses * u64::from(layout.pairs_per_line()),
            };
            progress(Progress::Simulated(pairs.min(count.into())));
        };
        let given = Given::Pairs(pairs);
        let run = Run { config: &self.config, expected: self.expected, given, seed, progress: &mut tell };
        let outcome: Result<_, VerifyError> = run.on(&instance, link.clone());
        // The waveform of a failed job is the most useful one.
        let closed = if waveform.is_some() { instance.trace_close() } else { Ok(()) };
        let outcome = outcome?;
        closed.map_err(CosimError::from)?;
        let seconds = begun.elapsed().as_secs_f64();
        progress(Progress::Comparing);
        Ok(check(&layout, setup, pairs, &self.reference.run_all(pairs), outcome, seconds))
    }
}

/// SHA-256 of the Verilog that would be generated for a configuration: the same as [`Bench::rtl_sha256`], without a
/// model.
///
/// # Errors
/// Returns an error if the configuration cannot be generated.
pub fn rtl_sha256(config: &Config) -> Result<String, VerifyError> {
    Ok(generated(config)?.sha256())
}

/// The Verilog of a configuration. The number of SCPUs remains a parameter, so that models share their code, unless
/// there are deciders.
fn generated(config: &Config) -> Result<Source, VerifyError> {
    let scpus = Config::default().scpus;
    Spec::from(config.clone()).check().map_err(crate::afu::BuildError::from)?;
    // A prefix does not change the behaviour, so a model without a prefix serves every prefix.
    let built = if config.has_deciders() { config.scpus } else { scpus };
    let plain = Config { scpus: built, prefix: None, ..config.clone() };
    let afu = Afu::generate(Spec::from(plain))?;
    let files = afu.verilog().into_iter().map(|(name, text)| File { name, text }).collect();
    Ok(with_scpus(Source::new(&afu.top_name(), files), config, scpus))
}

fn with_scpus(source: Source, config: &Config, default: u32) -> Source {
    if config.scpus == default || config.has_deciders() { source } else { source.parameter(SCPUS, config.scpus.into()) }
}
