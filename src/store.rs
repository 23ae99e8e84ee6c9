//! Measurements, kept by everything that decides them: one file each, in a folder that several processes may fill at
//! once.
//!
//! A [`Key`] names what is measured and what decides it, and its hash is the file's name. So nothing in a store is ever
//! stale or in the way: another version, seed or link is another file.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

use crate::files;

/// The folder that a study keeps its measurements in, within the folder of its results.
pub const FOLDER: &str = "measurements";

/// What is measured, and everything that decides it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Key {
    kind: String,
    of: Value,
}

impl Key {
    /// The key of a measurement of this kind. A kind ends with a number, which moves when the same `of` would give
    /// another value.
    ///
    /// # Errors
    /// Returns an error if `of` has no JSON.
    pub fn new(kind: &str, of: &impl Serialize) -> Result<Self, StoreError> {
        let of = serde_json::to_value(of).map_err(|error| StoreError::Json(error.to_string()))?;
        Ok(Self { kind: kind.to_owned(), of })
    }

    /// The kind.
    pub fn kind(&self) -> &str {
        &self.kind
    }

    /// SHA-256 of the key, whose JSON has its keys in alphabetic order.
    pub fn hash(&self) -> String {
        sha256(format!("{} {}", self.kind, self.of).as_bytes())
    }
}

/// A folder of measurements.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    /// Removed with all that is in it when this is dropped.
    _room: Option<TempDir>,
}

/// Why a measurement could not be read or kept.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file system refused.
    #[error("cannot {action} {}: {error}", path.display())]
    Io {
        /// The verb: read, write, create.
        action: &'static str,
        /// On what.
        path: PathBuf,
        /// What the file system said.
        error: io::Error,
    },
    /// A key or a value cannot be written as JSON.
    #[error("a measurement cannot be written as JSON: {0}")]
    Json(String),
    /// The environment names no folder of this user's.
    #[error("no folder for results: set AFU_CACHE, XDG_CACHE_HOME or HOME")]
    NoFolder,
}

/// What a file holds.
#[derive(Serialize, Deserialize)]
struct Measurement<K, T> {
    key: K,
    value: T,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    spent: Option<Spent>,
}

/// What a measurement took on the machine that made it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spent {
    /// Seconds.
    pub seconds: f64,
    /// The most memory that the process and one of its children had held by then, MiB.
    pub peak_memory_mib: u64,
}

impl Store {
    /// The store in a folder, which is made when something is kept.
    pub fn open(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), _room: None }
    }

    /// A store of this user's, by its name in the [`user_folder`].
    ///
    /// # Errors
    /// Returns an error if the environment names no such folder.
    pub(crate) fn of_user(name: &str) -> Result<Self, StoreError> {
        Ok(Self::open(&user_folder().ok_or(StoreError::NoFolder)?.join(name)))
    }

    /// A store that is gone when it is dropped.
    ///
    /// # Errors
    /// Returns an error if there can be no temporary folder.
    pub fn temporary() -> Result<Self, StoreError> {
        let room = tempfile::Builder::new().prefix("afu-").tempdir();
        let room = room.map_err(|error| StoreError::io("create a folder in", &env::temp_dir(), error))?;
        Ok(Self { folder: room.path().to_owned(), _room: Some(room) })
    }

    /// The folder itself.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The measurement that is kept under a key; `None` if there is none, or if its file cannot be understood: it is
    /// then measured again, and the file replaced.
    ///
    /// # Errors
    /// Returns an error if the file is there and cannot be read.
    pub fn get<T: DeserializeOwned>(&self, key: &Key) -> Result<Option<T>, StoreError> {
        Ok(self.measurement(key)?.map(|kept| kept.value))
    }

    /// True if a measurement is kept under a key.
    pub fn has(&self, key: &Key) -> bool {
        self.measurement::<IgnoredAny>(key).is_ok_and(|kept| kept.is_some())
    }

    /// What the measurement under a key took; `None` if there is none, or if nobody took the time.
    ///
    /// # Errors
    /// Returns the errors of [`Store::get`].
    pub(crate) fn spent(&self, key: &Key) -> Result<Option<Spent>, StoreError> {
        Ok(self.measurement::<IgnoredAny>(key)?.and_then(|kept| kept.spent))
    }

    fn measurement<T: DeserializeOwned>(&self, key: &Key) -> Result<Option<Measurement<Key, T>>, StoreError> {
        let path = self.file(key, "json");
        match fs::read(&path) {
            Ok(text) => {
                let kept = serde_json::from_slice::<Measurement<Key, T>>(&text).ok();
                Ok(kept.filter(|kept| kept.key == *key))
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(StoreError::io("read", &path, error)),
        }
    }

    /// Keeps a measurement. Whoever reads the file meanwhile finds the old one or the new one, whole.
    ///
    /// # Errors
    /// Returns an error if the value has no JSON, or the file system refuses.
    pub fn put(&self, key: &Key, value: &impl Serialize) -> Result<(), StoreError> {
        self.write(&Measurement { key, value, spent: None })
    }

    /// Keeps a measurement, and what it took.
    ///
    /// # Errors
    /// Returns the errors of [`Store::put`].
    pub(crate) fn put_spent(&self, key: &Key, value: &impl Serialize, spent: Spent) -> Result<(), StoreError> {
        self.write(&Measurement { key, value, spent: Some(spent) })
    }

    fn write<T: Serialize>(&self, measurement: &Measurement<&Key, &T>) -> Result<(), StoreError> {
        let text = serde_json::to_vec(measurement).map_err(|e| StoreError::Json(e.to_string()))?;
        self.create()?;
        let path = self.file(measurement.key, "json");
        files::replace(&path, |out| out.write_all(&text)).map_err(|error| StoreError::io("write", &path, error))
    }

    /// The measurement that is kept under a key, or else the one that `make` makes, which is then kept.
    ///
    /// # Errors
    /// Returns the errors of [`Store::get`] and [`Store::put`], or an error if `make` fails.
    pub(crate) fn get_or_make<T, E>(&self, key: &Key, make: impl FnOnce() -> Result<T, E>) -> Result<T, E>
    where
        T: Serialize + DeserializeOwned,
        E: From<StoreError>,
    {
        if let Some(kept) = self.get(key)? {
            return Ok(kept);
        }
        let made = make()?;
        self.put(key, &made)?;
        Ok(made)
    }

    /// The keys of everything that is kept, in the order of their hashes.
    ///
    /// # Errors
    /// Returns an error if the folder is there and cannot be read.
    pub fn list(&self) -> Result<Vec<Key>, StoreError> {
        let paths = self.files("json")?;
        let key = |path: &PathBuf| {
            let kept: Measurement<Key, Value> = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
            Some(kept.key).filter(|key| self.file(key, "json") == *path)
        };
        Ok(paths.iter().filter_map(key).collect())
    }

    /// The files with this extension, in the order of their names.
    ///
    /// # Errors
    /// Returns an error if the folder is there and cannot be read.
    pub(crate) fn files(&self, extension: &str) -> Result<Vec<PathBuf>, StoreError> {
        let fail = |error| StoreError::io("read", &self.folder, error);
        let entries = match fs::read_dir(&self.folder) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => entries.map_err(fail)?,
        };
        let paths = entries.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>();
        let mut paths = paths.map_err(fail)?;
        paths.retain(|path| path.extension().is_some_and(|of| of == extension));
        paths.sort();
        Ok(paths)
    }

    /// Where a file beside a measurement lies.
    pub fn file(&self, key: &Key, extension: &str) -> PathBuf {
        self.folder.join(format!("{}.{extension}", key.hash()))
    }

    /// A folder to work in, on the store's file system; it is gone when dropped.
    ///
    /// # Errors
    /// Returns an error if the file system refuses.
    pub fn scratch(&self) -> Result<TempDir, StoreError> {
        self.create()?;
        let made = tempfile::Builder::new().prefix("work-").tempdir_in(&self.folder);
        made.map_err(|error| StoreError::io("create a folder in", &self.folder, error))
    }

    /// Makes the folder, if it is not there.
    pub(crate) fn create(&self) -> Result<(), StoreError> {
        fs::create_dir_all(&self.folder).map_err(|error| StoreError::io("create", &self.folder, error))
    }
}

impl StoreError {
    pub(crate) fn io(action: &'static str, path: &Path, error: io::Error) -> Self {
        Self::Io { action, path: path.to_owned(), error: files::without_path(error) }
    }
}

/// The folder of everything that this program keeps for a user: `AFU_CACHE`, else the XDG cache folder's `contact-afu`.
pub(crate) fn user_folder() -> Option<PathBuf> {
    let set = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let xdg = || set("XDG_CACHE_HOME").filter(|path| path.is_absolute());
    let user = || xdg().or_else(|| Some(set("HOME")?.join(".cache"))).map(|path| path.join("contact-afu"));
    set("AFU_CACHE").or_else(user)
}

/// SHA-256 in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(kind: &str, of: u32) -> Key {
        Key::new(kind, &of).expect("a number has JSON")
    }

    #[test]
    fn a_measurement_is_found_by_all_that_decides_it() {
        let store = Store::temporary().expect("a temporary folder");
        assert_eq!(store.get::<u32>(&key("cycles/1", 3)).expect("no folder is no error"), None);
        store.put(&key("cycles/1", 3), &70).expect("kept");
        for other in [key("cycles/2", 3), key("area/1", 3), key("cycles/1", 4)] {
            assert_eq!(store.get::<u32>(&other).expect("read"), None, "{other:?}");
        }
        assert_eq!(store.get(&key("cycles/1", 3)).expect("read"), Some(70));
        let failed = store.get_or_make(&key("cycles/1", 4), || Err::<u32, _>(StoreError::NoFolder));
        assert!(matches!(failed, Err(StoreError::NoFolder)), "and nothing is kept of what failed");
        assert_eq!(store.list().expect("read"), [key("cycles/1", 3)]);
        assert_eq!(store.get_or_make(&key("cycles/1", 3), || Err::<u32, _>(StoreError::NoFolder)).expect("kept"), 70);
    }

    #[test]
    fn a_key_does_not_depend_on_the_order_of_fields() {
        #[derive(Serialize)]
        struct One {
            link: &'static str,
            seed: u32,
        }
        #[derive(Serialize)]
        struct Other {
            seed: u32,
            link: &'static str,
        }
        let one = Key::new("cycles/1", &One { link: "late", seed: 1 }).expect("JSON");
        assert_eq!(one.hash(), Key::new("cycles/1", &Other { seed: 1, link: "late" }).expect("JSON").hash());
    }

    #[test]
    fn what_cannot_be_understood_is_made_again_and_what_cannot_be_read_is_named() {
        let store = Store::temporary().expect("a temporary folder");
        let (key, other) = (key("cycles/1", 3), key("cycles/1", 4));
        store.put(&other, &1).expect("kept");
        for text in ["", "{}", "{\"key\":", &fs::read_to_string(store.file(&other, "json")).expect("kept")] {
            fs::write(store.file(&key, "json"), text).expect("written");
            assert_eq!(store.get::<u32>(&key).expect("read"), None, "{text}");
            assert_eq!(store.list().expect("read"), std::slice::from_ref(&other), "{text}");
        }
        assert_eq!(store.get_or_make(&key, || Ok::<_, StoreError>(5)).expect("made"), 5);
        assert_eq!(store.get(&key).expect("read"), Some(5));

        fs::remove_file(store.file(&key, "json")).expect("removed");
        fs::create_dir(store.file(&key, "json")).expect("made");
        let error = store.get::<u32>(&key).expect_err("a folder is no file").to_string();
        assert!(error.starts_with("cannot read ") && error.contains(&key.hash()), "{error}");
    }

    /// Every thread keeps every measurement, and finds whole what it kept. Values are long: half of one would be seen.
    #[test]
    fn several_may_fill_a_store_at_once() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let folder = room.path().join("deep/store");
        let value = |of: u32| vec![of; 20_000];
        std::thread::scope(|scope| {
            for begin in 0..4 {
                let store = Store::open(&folder);
                scope.spawn(move || {
                    let mine: Vec<u32> = (0..12).map(|i| (begin * 3 + i) % 12).collect();
                    for number in 0..mine.len() {
                        store.put(&key("long/1", mine[number]), &value(mine[number])).expect("kept");
                        for &of in &mine[..=number] {
                            let kept = store.get(&key("long/1", of)).expect("read");
                            assert!(kept == Some(value(of)), "{of}: not whole while another writes it");
                        }
                    }
                });
            }
        });
        let store = Store::open(&folder);
        assert_eq!(store.list().expect("read").len(), 12);
        assert_eq!(fs::read_dir(&folder).expect("there").count(), 12, "nothing is left aside");
    }
}
