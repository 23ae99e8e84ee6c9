//! Points that failed.

use std::fs;
use std::io;

use serde::{Deserialize, Serialize};

use crate::files;
use crate::store::{Key, Store, StoreError};

/// A point that could not be measured.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Failed {
    /// The last error.
    pub error: String,
    /// How often the point was tried.
    pub attempts: u32,
}

const EXTENSION: &str = "failed";

impl Failed {
    /// What is recorded of a point; `None` if it did not fail, or was measured since.
    pub(super) fn of(store: &Store, key: &Key) -> Result<Option<Self>, StoreError> {
        let path = store.file(key, EXTENSION);
        match fs::read(&path) {
            Ok(text) => Ok(serde_json::from_slice(&text).ok()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(StoreError::io("read", &path, error)),
        }
    }

    /// Records one more failure of a point.
    pub(super) fn record(store: &Store, key: &Key, error: &str) -> Result<Self, StoreError> {
        let before = Self::of(store, key)?.map_or(0, |failed| failed.attempts);
        let failed = Self { error: error.to_owned(), attempts: before + 1 };
        let path = store.file(key, EXTENSION);
        let text = serde_json::to_vec(&failed).map_err(|error| StoreError::Json(error.to_string()))?;
        files::replace(&path, |out| out.write_all(&text)).map_err(|error| StoreError::io("write", &path, error))?;
        Ok(failed)
    }

    /// Forgets the failures of a point that was measured.
    pub(super) fn forget(store: &Store, key: &Key) -> Result<(), StoreError> {
        let path = store.file(key, EXTENSION);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(StoreError::io("remove", &path, error)),
            _ => Ok(()),
        }
    }
}
