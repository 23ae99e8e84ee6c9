//! Compiled models: the built-in one, and those built and loaded at run time.

use std::error::Error;
use std::path::{Path, PathBuf};

use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};

use super::abi::{Api, raw};
use super::error::CosimError;
use super::instance::Instance;
use super::source::Source;
use super::verilate::{self, Design, Harness, Trace};
use crate::store::user_folder;

const HARNESS: Harness<'static> = Harness {
    header: include_str!("../../tb/harness.h"),
    source: include_str!("../../tb/harness.cpp"),
    fst: include_str!("../../tb/fst.cpp"),
};

/// The code of one module, of which any number of [`Instance`]s can be made. It stays loaded until the process ends:
/// Verilator's code has thread-local and static state which unloading would pull from under it.
#[derive(Clone, Debug)]
pub struct Model {
    api: Api,
    shared_object: Option<PathBuf>,
}

impl Model {
    /// The model of the committed `rtl/` with its default parameters, linked into this program; nothing when its build
    /// had no Verilator (a warning said so then).
    pub fn built_in() -> Option<Self> {
        #[cfg(afu_built_in)]
        // SAFETY: the model is part of this program.
        let api = unsafe { Api::read(raw::afu_model()) };
        #[cfg(not(afu_built_in))]
        let api = None;
        api.map(|api| Self { api, shared_object: None })
    }

    /// Builds (or finds in the cache) and loads a model of `source`.
    ///
    /// # Errors
    /// [`CosimError::MissingTool`] without Verilator or a C++ compiler; [`CosimError::Build`] when one of them refuses.
    pub fn build(source: &Source, trace: Trace) -> Result<Self, CosimError> {
        Self::build_in(source, trace, &user_folder().ok_or(CosimError::NoCache)?)
    }

    /// [`Model::build`] with a folder for built models instead of the user's.
    ///
    /// # Errors
    /// As `build`.
    pub fn build_in(source: &Source, trace: Trace, cache: &Path) -> Result<Self, CosimError> {
        source.check()?;
        let design = Design {
            files: source.files(),
            top: source.top(),
            parameters: source.parameters(),
            trace,
            harness: HARNESS,
        };
        Self::load(verilate::shared(&design, cache, env!("AFU_TARGET"))?)
    }

    fn load(path: PathBuf) -> Result<Self, CosimError> {
        let fail = |why: String| CosimError::Load { path: path.clone(), why };
        // SAFETY: the library is one that `verilate` made; its only initialisers are those of Verilator's statics.
        let library = unsafe { Library::open(Some(&path), RTLD_NOW | RTLD_LOCAL) }.map_err(|e| fail(cause(&e)))?;
        // SAFETY: the symbol is declared so in harness.h, which the library was compiled with.
        let symbol = unsafe { library.get::<unsafe extern "C" fn() -> *const raw::afu_table>(b"afu_model\0") };
        let function = *symbol.map_err(|e| fail(cause(&e)))?;
        std::mem::forget(library);
        // SAFETY: as above, and the library is never unloaded now.
        let api = unsafe { Api::read(function()) };
        let api = api.ok_or_else(|| fail("it is of another version of the ABI".to_owned()))?;
        Ok(Self { api, shared_object: Some(path) })
    }

    /// Makes an instance. With seed 0 every bit that no reset reaches begins as zero, otherwise at random: a design
    /// that is right only after a lucky start shows itself.
    ///
    /// # Errors
    /// Returns an error if the module ends itself at once.
    pub fn instance(&self, seed: u64) -> Result<Instance, CosimError> {
        Ok(Instance::new(self.api, seed)?)
    }

    /// SHA-256 of the Verilog it was made from, as [`Source::sha256`] gives it.
    pub fn rtl_sha256(&self) -> &str {
        self.api.rtl_sha256
    }

    /// The waveform its instances can write.
    pub fn trace(&self) -> Trace {
        match self.api.trace {
            raw::AFU_TRACE_VCD => Trace::Vcd,
            raw::AFU_TRACE_FST => Trace::Fst,
            _ => Trace::Off,
        }
    }

    /// The library that it was loaded from; `None` for the built-in model.
    pub fn shared_object(&self) -> Option<&Path> {
        self.shared_object.as_deref()
    }
}

/// The loader's message; the error itself names only the call.
fn cause(error: &libloading::Error) -> String {
    error.source().map_or_else(|| error.to_string(), |source| format!("{error}: {source}"))
}
