//! Results kept by key. One process at a time makes a result in a temporary folder, which is then renamed.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use super::Error;

/// The folder `cache/key`, made by `make` if it does not exist. `make` gets an empty folder of its own. If it succeeds,
/// this becomes `cache/key`; if it fails, it is removed. So a key never holds half a result.
pub(super) fn once(cache: &Path, key: &str, make: impl FnOnce(&Path) -> Result<(), Error>) -> Result<PathBuf, Error> {
    let result = cache.join(key);
    if result.is_dir() {
        return Ok(result);
    }
    fs::create_dir_all(cache).map_err(|e| Error::io("create", cache, e))?;
    // A second process waits here and then finds the result. The lock ends with its process, however that ends.
    let lock_path = cache.join(format!("{key}.lock"));
    let lock = File::create(&lock_path).map_err(|e| Error::io("create", &lock_path, e))?;
    lock.lock().map_err(|e| Error::io("lock", &lock_path, e))?;
    let made = if result.is_dir() { Ok(()) } else { make_aside(cache, key, &result, make) };
    // A later process makes a new lock. It finds the result or, after a failure, tries for itself.
    let _ = fs::remove_file(&lock_path);
    made.map(|()| result)
}

fn make_aside(
    cache: &Path,
    key: &str,
    result: &Path,
    make: impl FnOnce(&Path) -> Result<(), Error>,
) -> Result<(), Error> {
    let aside = Aside::new(cache, key)?;
    make(&aside.0)?;
    match fs::rename(&aside.0, result) {
        // Locks only save work. If locking failed and another process was faster, its result is the same.
        Err(_) if result.is_dir() => Ok(()),
        renamed => renamed.map_err(|e| Error::io("create", result, e)),
    }
}

/// A folder that is removed unless it was renamed.
struct Aside(PathBuf);

impl Aside {
    /// Called with the key's lock held, so a folder of this key was left by a process that was killed.
    fn new(cache: &Path, key: &str) -> Result<Self, Error> {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let mine = format!("building-{key}-");
        let entries = fs::read_dir(cache).map_err(|e| Error::io("read", cache, e))?;
        for left in entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with(&mine)) {
            let _ = fs::remove_dir_all(left.path());
        }
        let path = cache.join(format!("{mine}{}-{}", process::id(), NEXT.fetch_add(1, Ordering::Relaxed)));
        fs::create_dir(&path).map_err(|e| Error::io("create", &path, e))?;
        // Verilator and the compiler run in other folders.
        Ok(Self(path.canonicalize().map_err(|e| Error::io("read", &path, e))?))
    }
}

impl Drop for Aside {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Removes everything in `folder` except `name`.
pub(super) fn keep_only(folder: &Path, name: &str) -> Result<(), Error> {
    for entry in fs::read_dir(folder).map_err(|e| Error::io("read", folder, e))?.flatten() {
        let path = entry.path();
        if entry.file_name() != name {
            let removed = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
            removed.map_err(|e| Error::io("remove", &path, e))?;
        }
    }
    Ok(())
}

/// The files in `folder` with this extension, sorted.
pub(super) fn files_in(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, Error> {
    let entries = fs::read_dir(folder).map_err(|e| Error::io("read", folder, e))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|found| found == extension));
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_killed_build_left_goes_with_the_next_of_its_key() {
        let cache = tempfile::tempdir().expect("a temporary folder");
        let left = cache.path().join("building-abc-1-0");
        let of_another = cache.path().join("building-abd-1-0");
        fs::create_dir(&left).expect("a folder");
        fs::create_dir(&of_another).expect("a folder");
        let write = |folder: &Path| fs::write(folder.join("made"), "").map_err(|e| Error::io("write", folder, e));
        let result = once(cache.path(), "abc", write).expect("made");
        assert!(result.join("made").is_file() && !left.exists() && of_another.exists());
    }
}
