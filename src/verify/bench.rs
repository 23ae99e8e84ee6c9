//! An AFU ready for jobs.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::check::{Verdict, check};
use super::error::VerifyError;
use super::replay::Setup;
use crate::afu::{Afu, Spec, file_list, top_name};
use crate::config::{self, Config, Results};
use crate::cosim::{CosimError, File, Model, Source, Trace};
use crate::host::Expected;
use crate::host::simulated::Run;
use crate::kernel::Reference;
use crate::link::{Link, LinkModel, Traffic};
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
    /// Part of this program, made of the very Verilog that was asked for.
    BuiltIn,
    /// Built, or found in the cache: the library.
    Library(PathBuf),
}

/// A simulated AFU with the reference it is compared with. Any number of jobs can be run on it, each from reset.
#[derive(Clone, Debug)]
pub struct Bench {
    config: Config,
    folder: Option<PathBuf>,
    source: Source,
    model: Model,
    expected: Expected,
    reference: Reference,
}

impl Bench {
    /// Generates the Verilog of a configuration and makes a model of it: the built-in one if that is made of the same
    /// Verilog, else one from the cache or from Verilator.
    ///
    /// # Errors
    /// Returns an error if the configuration cannot be generated, a tool is missing, or one refuses.
    pub fn new(config: &Config) -> Result<Self, VerifyError> {
        Self::traced(config, Trace::Off)
    }

    /// [`Bench::new`] with a model that can write waveforms.
    ///
    /// # Errors
    /// As `new`.
    pub fn traced(config: &Config, trace: Trace) -> Result<Self, VerifyError> {
        Self::of(config, generated(config)?, |source| Model::build(source, trace), trace == Trace::Off)
    }

    /// [`Bench::new`] with a model from `cache`, a folder for models, even where the built-in one would serve: what a
    /// build takes can then be measured.
    ///
    /// # Errors
    /// As `new`.
    pub(crate) fn cached_in(config: &Config, cache: &Path) -> Result<Self, VerifyError> {
        Self::of(config, generated(config)?, |source| Model::build_in(source, Trace::Off, cache), false)
    }

    /// The Verilog that lies in `folder`, which `afu rtl` wrote, edited or not; `scpus` overrides its manifest's
    /// number.
    ///
    /// # Errors
    /// As `new`, and when the folder's manifest or file list cannot be read.
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

    /// The model, for a driver of the caller's.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// SHA-256 of the Verilog, in hex.
    pub fn rtl_sha256(&self) -> String {
        self.source.sha256()
    }

    /// Sends pairs through the AFU over a link and compares what comes back. `seed` decides the link's randomness and
    /// what the registers hold that no reset reaches.
    ///
    /// # Errors
    /// Returns an error if the job does not end, or the AFU breaks the line port's protocol. Mismatches are no error.
    pub fn run(&self, pairs: &[PairRecord], link: &LinkModel, seed: u64) -> Result<Verdict, VerifyError> {
        self.run_with(pairs, link, seed, None, |_| {})
    }

    /// [`Bench::run`] that writes a waveform and tells, now and then, how far it has come.
    ///
    /// # Errors
    /// As `run`, and when the waveform cannot be written.
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
        let link = Link::new(link.clone(), seed)?;
        let mut tell = |traffic: Traffic| {
            let pairs = match self.config.results {
                Results::All => traffic.write_responses * u64::from(layout.contacts_per_line()),
                Results::Hits => traffic.read_responses * u64::from(layout.pairs_per_line()),
            };
            progress(Progress::Simulated(pairs.min(count.into())));
        };
        let run = Run { config: &self.config, expected: self.expected, pairs, seed, progress: &mut tell };
        let outcome: Result<_, VerifyError> = run.on(&instance, link);
        // The waveform of a failed job is the most useful one.
        let closed = if waveform.is_some() { instance.trace_close() } else { Ok(()) };
        let outcome = outcome?;
        closed.map_err(CosimError::from)?;
        let seconds = begun.elapsed().as_secs_f64();
        progress(Progress::Comparing);
        Ok(check(&layout, setup, pairs, &self.reference.run_all(pairs), outcome, seconds))
    }
}

/// SHA-256 of the Verilog that would be generated for a configuration: [`Bench::rtl_sha256`] without a model.
///
/// # Errors
/// Returns an error if the configuration cannot be generated.
pub fn rtl_sha256(config: &Config) -> Result<String, VerifyError> {
    Ok(generated(config)?.sha256())
}

/// The Verilog of a configuration. The number of SCPUs is left to the parameter, so that models share what they can.
fn generated(config: &Config) -> Result<Source, VerifyError> {
    let scpus = Config::default().scpus;
    Spec::from(config.clone()).check().map_err(crate::afu::BuildError::from)?;
    // Names change nothing, and models are shared by those that have none before them.
    let plain = Config { scpus, prefix: None, ..config.clone() };
    let afu = Afu::generate(Spec::from(plain))?;
    let files = afu.verilog().into_iter().map(|(name, text)| File { name, text }).collect();
    Ok(with_scpus(Source::new(&afu.top_name(), files), config, scpus))
}

fn with_scpus(source: Source, config: &Config, default: u32) -> Source {
    if config.scpus == default { source } else { source.parameter(SCPUS, config.scpus.into()) }
}
