//! A generated accelerator and its Verilog.

use std::sync::Arc;

use crate::hdl::verilog::{self, Style};
use crate::hdl::{BuildErrors, Module};
use crate::pipeline::{Settings, contact_kernel};
use crate::query::Fields;
use crate::record::Layout;

use super::scpu::scpu;
use super::shell::{self, ShellDesign};
use super::spheres::spheres_top;
use super::top::line_top;
use super::{Spec, SpecError};
use crate::config::{Config, Input, Shell};

/// Columns of a line of a header, at most.
const HEADER_COLUMNS: usize = 110;

/// The name of the top module of a configuration's accelerator.
pub fn top_name(config: &Config) -> String {
    config.prefixed(shell::of(config.shell).top_name())
}

/// A generated accelerator.
#[derive(Clone, Debug)]
pub struct Afu {
    spec: Spec,
    shell: &'static dyn ShellDesign,
    top: Arc<Module>,
    /// The module `contact_afu`, independent of the shell around it.
    core: Arc<Module>,
    kernel: Arc<Module>,
    /// The kernel of the SCPUs that only decide, with `--decide`.
    decision: Option<Arc<Module>>,
}

/// Why an accelerator could not be generated.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The specification is invalid.
    #[error(transparent)]
    Spec(#[from] SpecError),
    /// The hardware is faulty because of a mistake of the generator.
    #[error("the generated hardware is faulty:\n{0}")]
    Hardware(#[from] BuildErrors),
}

impl Afu {
    /// Generates the accelerator of a specification.
    ///
    /// # Errors
    /// Returns an error if a value in `spec` is out of range, or if the generator has a fault.
    pub fn generate(spec: Spec) -> Result<Self, BuildError> {
        spec.check()?;
        let kernel = kernel(&spec)?;
        Self::around(spec, kernel)
    }

    /// The accelerator of a specification around a kernel of the caller's. The kernel is a module with the ports of
    /// [`crate::pipeline::contact_kernel`] at the specification's interval. Its outputs follow its inputs by its
    /// `latency`, which is at least 1.
    ///
    /// # Errors
    /// Returns an error if a value in `spec` is out of range, or if the ports do not fit.
    pub fn around(spec: Spec, kernel: Arc<Module>) -> Result<Self, BuildError> {
        spec.check()?;
        let record_bits = spec.config.record.format().width();
        if spec.word_bits != record_bits {
            return Err(SpecError::Word(spec.word_bits, record_bits).into());
        }
        let mut decision_kernel = None;
        let scpu_of = || scpu(&spec, "scpu", &kernel);
        let core = match spec.config.input {
            Input::Direct => match spec.deciding() {
                None => line_top(&spec, &scpu_of()?, None)?,
                Some(deciding) => {
                    let kernel = decision_kernel.insert(decision(&spec, true)?);
                    line_top(&spec, &scpu(&deciding, "decider", kernel)?, Some(&scpu_of()?))?
                }
            },
            Input::Spheres if spec.config.contact == Fields::HIT => spheres_top(&spec, &kernel, None)?,
            Input::Spheres => spheres_top(&spec, &decision(&spec, false)?, Some(&scpu_of()?))?,
        };
        let shell = shell::of(spec.config.shell);
        let top = shell.top(&spec, &core)?;
        Ok(Self { spec, shell, top, core, kernel, decision: decision_kernel })
    }

    /// The accelerator of a specification around an SCPU of the caller's, which is then its own kernel. The SCPU is a
    /// module with the input `pair` and the outputs `record`, `contact` and `invalid_pair`, which follow it by its
    /// `latency`, at least 1. At an interval above 1 it also has the input `take`, which is set in the cycle before a
    /// pair arrives and stays for the interval. The controller is proven with such an SCPU, without a shell.
    ///
    /// # Errors
    /// Returns an error if a value in `spec` is out of range, or if the ports do not fit.
    pub fn around_scpu(spec: Spec, scpu: Arc<Module>) -> Result<Self, BuildError> {
        spec.check()?;
        let core = line_top(&spec, &scpu, None)?;
        Ok(Self { spec, shell: shell::of(Shell::Line), top: core.clone(), core, kernel: scpu, decision: None })
    }

    /// The specification that it was generated from.
    pub fn spec(&self) -> &Spec {
        &self.spec
    }

    /// The shell around the core.
    pub(super) fn shell(&self) -> &'static dyn ShellDesign {
        self.shell
    }

    /// The places of records in lines.
    pub fn layout(&self) -> Layout {
        self.spec.layout()
    }

    /// The top module.
    pub fn top(&self) -> &Arc<Module> {
        &self.top
    }

    /// The top module's name in Verilog.
    pub fn top_name(&self) -> String {
        self.spec.config.prefixed(&self.top.name)
    }

    /// True if there is a shell around the core.
    pub fn has_shell(&self) -> bool {
        !Arc::ptr_eq(&self.top, &self.core)
    }

    /// The kernel inside each SCPU.
    pub fn kernel(&self) -> &Arc<Module> {
        &self.kernel
    }

    /// The kernel inside each SCPU that only decides; `None` without `--decide`.
    pub fn decision(&self) -> Option<&Arc<Module>> {
        self.decision.as_ref()
    }

    /// The Verilog, one file per module, each after those it instantiates: file name and text.
    pub fn verilog(&self) -> Vec<(String, String)> {
        let (config, header) = (&self.spec.config, self.header());
        let style = Style { reset: self.spec.reset, prefix: config.prefixed(""), header, memories: self.spec.memories };
        let file =
            |module: Arc<Module>| (config.prefixed(&format!("{}.v", module.name)), verilog::emit(&module, &style));
        self.top.hierarchy().into_iter().map(file).collect()
    }

    /// The version of the generator and the command, for the head of a file.
    pub(super) fn origin(&self) -> String {
        format!("Generated by contact-afu {}: {}", env!("CARGO_PKG_VERSION"), self.command())
    }

    /// The command that writes the Verilog.
    pub(super) fn command(&self) -> String {
        ["afu rtl".to_owned()].into_iter().chain(self.spec.flags()).collect::<Vec<_>>().join(" ")
    }

    /// The header of every file. It has no date, host or path, so the same specification gives the same bytes.
    fn header(&self) -> Vec<String> {
        let config = &self.spec.config;
        let mut header = wrapped(&self.origin());
        header.push(format!(
            "arithmetic {} ({}), interval {}, contact {}, stages cut for {} MHz",
            config.profile,
            config.profile.format(),
            config.interval,
            config.contact,
            config.cut_mhz()
        ));
        header
    }
}

/// The kernel of a specification.
fn settings(spec: &Spec) -> Settings {
    let arithmetic = spec.config.profile.arithmetic();
    Settings {
        query: spec.config.query,
        arithmetic,
        record: arithmetic.record(spec.config.record.format()),
        fields: spec.config.contact,
        radius: spec.config.radius.map(|radius| spec.config.record.round(radius)),
        clock_mhz: spec.config.cut_mhz(),
        interval: spec.config.interval,
        valid_is_late: false,
        touching: false,
        model: spec.model(),
    }
}

/// The kernel that computes contacts, or decides if only hits are asked for.
pub(super) fn kernel(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let is_direct = spec.config.input == Input::Direct || spec.config.contact != Fields::HIT;
    let touching = spec.config.has_deciders() && spec.config.contact != Fields::HIT;
    let valid_is_late = spec.config.interval <= 1 && is_direct && !touching;
    contact_kernel(&Settings { valid_is_late, touching, ..settings(spec) })
}

/// The kernel that decides which pairs touch.
pub(super) fn decision(spec: &Spec, valid_is_late: bool) -> Result<Arc<Module>, BuildErrors> {
    let settings = Settings { fields: Fields::HIT, interval: 1, valid_is_late, ..settings(spec) };
    let mut kernel = contact_kernel(&settings)?;
    if let Some(kernel) = Arc::get_mut(&mut kernel) {
        kernel.name = "sphere_decision".to_owned();
    }
    Ok(kernel)
}

/// A line of a header, broken before an option where it would be too long.
fn wrapped(text: &str) -> Vec<String> {
    let mut parts = text.split(" --");
    let mut lines = vec![parts.next().unwrap_or_default().to_owned()];
    for part in parts {
        match lines.last_mut() {
            Some(last) if last.len() + part.len() < HEADER_COLUMNS => *last += &format!(" --{part}"),
            _ => lines.push(format!("  --{part}")),
        }
    }
    lines
}
