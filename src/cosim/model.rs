//! Compiled models: the built-in one, and others that are built and loaded at run time.

use std::error::Error;
use std::path::{Path, PathBuf};

use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};

use super::abi::{Api, raw};
use super::error::CosimError;
use super::instance::Instance;
use super::source::Source;
use super::verilate::{self, Cache, Design, Harness, Trace};
use crate::store::user_folder;

const HARNESS: Harness<'static> = Harness {
    header: include_str!("../../tb/harness.h"),
    source: include_str!("../../tb/harness.cpp"),
    fst: include_str!("../../tb/fst.cpp"),
};

/// The code of one module, from which any number of [`Instance`]s can be made. It stays loaded until the process ends,
/// because Verilator's code has thread-local and static state that must not be unloaded.
#[derive(Clone, Debug)]
pub struct Model {
    api: Api,
    shared_object: Option<PathBuf>,
}

impl Model {
    /// The model of the committed `rtl/` with its default parameters, linked into this program. `None` if the build had
    /// no Verilator (a warning said so).
    pub fn built_in() -> Option<Self> {
        #[cfg(afu_built_in)]
        // SAFETY: the model is part of this program.
        let api = unsafe { Api::read(raw::afu_model()) };
        #[cfg(not(afu_built_in))]
        let api = None;
        api.map(|api| Self { api, shared_object: None })
    }

    /// Builds a model of `source`, or finds it in the cache, and loads it.
    ///
    /// # Errors
    /// Returns [`CosimError::MissingTool`] without Verilator or a C++ compiler, and [`CosimError::Build`] if one of
    /// them fails.
    pub fn build(source: &Source, trace: Trace) -> Result<Self, CosimError> {
        Self::build_in(source, trace, &user_folder().ok_or(CosimError::NoCache)?)
    }

    /// As [`Model::build`], but keeps built models in the folder `cache` instead of the user's.
    ///
    /// # Errors
    /// Returns the errors of `build`.
    pub fn build_in(source: &Source, trace: Trace, cache: &Path) -> Result<Self, CosimError> {
        Self::kept_in(source, trace, cache.into())
    }

    /// As [`Model::build_in`], but Verilator's runtime is kept in the user's folder, so that it is not compiled again
    /// for each `cache`.
    pub(crate) fn build_alone_in(source: &Source, trace: Trace, cache: &Path) -> Result<Self, CosimError> {
        let user = user_folder();
        Self::kept_in(source, trace, Cache { models: cache, runtime: user.as_deref().unwrap_or(cache) })
    }

    fn kept_in(source: &Source, trace: Trace, cache: Cache) -> Result<Self, CosimError> {
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
        // SAFETY: `verilate` made the library, whose only initialisers are those of Verilator's statics.
        let library = unsafe { Library::open(Some(&path), RTLD_NOW | RTLD_LOCAL) }.map_err(|e| fail(cause(&e)))?;
        // SAFETY: harness.h, with which the library was compiled, declares the symbol with this type.
        let symbol = unsafe { library.get::<unsafe extern "C" fn() -> *const raw::afu_table>(b"afu_model\0") };
        let function = *symbol.map_err(|e| fail(cause(&e)))?;
        std::mem::forget(library);
        // SAFETY: as above. From now on the library is never unloaded.
        let api = unsafe { Api::read(function()) };
        let api = api.ok_or_else(|| fail("it is of another version of the ABI".to_owned()))?;
        Ok(Self { api, shared_object: Some(path) })
    }

    /// Makes an instance. With seed 0, every bit that no reset reaches begins as zero, otherwise at random. A design
    /// that only works from a lucky start is found this way.
    ///
    /// # Errors
    /// Returns an error if the module stops the simulation at once.
    pub fn instance(&self, seed: u64) -> Result<Instance, CosimError> {
        Ok(Instance::new(self.api, seed)?)
    }

    /// SHA-256 of the Verilog that the model was made from, as [`Source::sha256`] gives it.
    pub fn rtl_sha256(&self) -> &str {
        self.api.rtl_sha256
    }

    /// The kind of waveform that its instances can write.
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
