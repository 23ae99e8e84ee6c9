//! Results kept by the hash of everything that went into them: made aside, renamed into place.

use std::env;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};
use tempfile::{NamedTempFile, TempDir};

use super::SynthError;

/// Where results are kept.
pub(super) struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// The folder `synth` of `AFU_CACHE`, else of the XDG cache folder's `contact-afu`.
    pub fn open() -> Result<Self, SynthError> {
        let set = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let xdg = || set("XDG_CACHE_HOME").filter(|path| path.is_absolute());
        let user = || xdg().or_else(|| Some(set("HOME")?.join(".cache"))).map(|path| path.join("contact-afu"));
        let folder = set("AFU_CACHE").or_else(user).ok_or(SynthError::NoCache)?.join("synth");
        fs::create_dir_all(&folder).map_err(|e| SynthError::io("create", &folder, e))?;
        Ok(Self { folder })
    }

    /// Where everything is kept: what an error names, since nobody knows the folder of [`Cache::scratch`].
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A folder to work in, gone when dropped.
    pub fn scratch(&self) -> Result<TempDir, SynthError> {
        tempfile::Builder::new()
            .prefix("work-")
            .tempdir_in(&self.folder)
            .map_err(|e| SynthError::io("create", &self.folder, e))
    }

    /// The value kept under a key. What cannot be read as one is made again.
    pub fn get<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        serde_json::from_slice(&fs::read(self.path(key)).ok()?).ok()
    }

    /// Keeps a value under a key.
    pub fn put<T: Serialize>(&self, key: &str, value: &T) -> Result<(), SynthError> {
        let fail = |error: io::Error| SynthError::io("write", &self.path(key), error);
        let text = serde_json::to_vec(value).map_err(|error| fail(error.into()))?;
        let mut file = NamedTempFile::new_in(&self.folder).map_err(fail)?;
        file.write_all(&text).map_err(fail)?;
        file.persist(self.path(key)).map_err(|error| fail(error.error))?;
        Ok(())
    }

    /// Where a file of a key lies.
    pub fn file(&self, key: &str, extension: &str) -> PathBuf {
        self.folder.join(format!("{key}.{extension}"))
    }

    fn path(&self, key: &str) -> PathBuf {
        self.file(key, "json")
    }
}

/// The key of what `parts` decide.
pub(super) fn key(parts: &[&str]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part.as_bytes());
    }
    hex(&hash.finalize())
}

/// Bytes in hexadecimal.
pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Moves a file into the cache whole.
pub(super) fn keep(from: &Path, to: &Path) -> Result<(), SynthError> {
    fs::rename(from, to).map_err(|e| SynthError::io("create", to, e))
}
