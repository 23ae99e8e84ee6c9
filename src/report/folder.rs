//! A folder of results, written to a temporary folder and renamed: it appears whole or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use tempfile::TempDir;

use super::manifest;
use crate::files;

/// Why a folder of results could not be written.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The target exists and this program did not write it.
    #[error("{}: not written by afu (it holds no manifest.json of afu); choose another folder, or replace it with --force", .0.display())]
    Foreign(PathBuf),
    /// The path names something other than a folder.
    #[error("{}: is not a folder", .0.display())]
    NotAFolder(PathBuf),
    /// The folder holds results of something else.
    #[error(
        "{}: it holds {}; choose another folder, or replace it with --force",
        folder.display(), differences.join(", and ")
    )]
    Other {
        /// The folder.
        folder: PathBuf,
        /// How they differ from what was to be written.
        differences: Vec<String>,
    },
    /// A value could not be turned into text.
    #[error("cannot write {}: {message}", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// A file inside would leave the folder.
    #[error("{0}: expected a plain relative path for a file in a result folder")]
    Path(String),
    /// The file system refused.
    #[error("{}: {error}", path.display())]
    Io {
        /// The file being written.
        path: PathBuf,
        /// The error of the file system.
        error: io::Error,
    },
}

/// A temporary folder, renamed when complete.
///
/// If it is dropped before [`Folder::commit`], it leaves nothing behind.
pub struct Folder {
    aside: TempDir,
    target: PathBuf,
}

impl Folder {
    /// Begins a folder whose final place is `target`.
    ///
    /// # Errors
    /// Returns an error if `target` exists, is not empty and has no manifest of ours, unless `force` is set.
    pub fn begin(target: &Path, force: bool) -> Result<Self, Error> {
        check(target, force)?;
        let parent = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(parent).map_err(at(parent))?;
        let aside = tempfile::Builder::new().prefix(".afu-").tempdir_in(parent);
        let aside = aside.map_err(files::without_path).map_err(at(target))?;
        Ok(Self { aside, target: target.to_owned() })
    }

    /// Adds a file; `path` is relative and may name folders.
    ///
    /// # Errors
    /// Returns an error if the path is not plain, or if the file cannot be written.
    pub fn write(&self, path: &str, bytes: &[u8]) -> Result<(), Error> {
        let plain = |c: std::path::Component<'_>| matches!(c, std::path::Component::Normal(_));
        if path.is_empty() || !Path::new(path).components().all(plain) {
            return Err(Error::Path(path.to_owned()));
        }
        let (file, shown) = (self.aside.path().join(path), self.target.join(path));
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).map_err(at(&shown))?;
        }
        fs::write(&file, bytes).map_err(at(&shown))
    }

    /// Moves the folder to its place, and replaces what was there.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be moved. What was in its place is then still there.
    pub fn commit(self) -> Result<(), Error> {
        let Self { aside, target } = self;
        share(aside.path()).map_err(at(&target))?;
        // The old folder is moved aside too, so that a failing rename can be undone.
        let old = if target.exists() {
            let parent = aside.path().parent().unwrap_or(Path::new("."));
            let old = tempfile::Builder::new().prefix(".afu-old-").tempdir_in(parent);
            let old = old.map_err(files::without_path).map_err(at(&target))?;
            fs::rename(&target, old.path().join("old")).map_err(at(&target))?;
            Some(old)
        } else {
            None
        };
        let aside = aside.keep();
        if let Err(error) = fs::rename(&aside, &target) {
            if let Some(old) = &old {
                let _ = fs::rename(old.path().join("old"), &target);
            }
            let _ = fs::remove_dir_all(&aside);
            return Err(Error::Io { path: target, error });
        }
        Ok(())
    }
}

/// Succeeds if results may be written to `target`: it does not exist, is an empty folder, or is one of ours.
///
/// # Errors
/// Returns [`Error::Foreign`] or [`Error::NotAFolder`] if they may not.
pub fn check(target: &Path, force: bool) -> Result<(), Error> {
    match fs::read_dir(target) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => Err(Error::NotAFolder(target.to_owned())),
        Err(error) => Err(Error::Io { path: target.to_owned(), error }),
        Ok(mut entries) => {
            if force || entries.next().is_none() || manifest::schema(target).is_some() {
                Ok(())
            } else {
                Err(Error::Foreign(target.to_owned()))
            }
        }
    }
}

/// As [`check`], but also requires that `target` holds no results of another study than this schema's.
///
/// # Errors
/// Returns the errors of [`check`], or [`Error::Other`].
pub fn check_study(target: &Path, schema: &str, force: bool) -> Result<(), Error> {
    check(target, force)?;
    // Schemas of the same study differ only in the number.
    let study = |schema: &str| schema.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
    match manifest::schema(target) {
        Some(there) if !force && study(&there) != study(schema) => {
            let differences = vec![format!("results of {there}, not {schema}")];
            Err(Error::Other { folder: target.to_owned(), differences })
        }
        _ => Ok(()),
    }
}

/// Replaces one file whole with a value as indented JSON and a line end.
///
/// # Errors
/// Returns an error if the value cannot be written as JSON, or if the file cannot be written. The old file is then
/// unchanged.
pub(crate) fn replace_json(path: &Path, value: &impl Serialize) -> Result<(), Error> {
    let mut text = serde_json::to_vec_pretty(value).map_err(as_text(path))?;
    text.push(b'\n');
    replace_file(path, &text)
}

/// Replaces one file as a whole with the CSV that `write` writes.
///
/// # Errors
/// Returns the errors of [`replace_json`].
pub(crate) fn replace_csv(
    path: &Path,
    write: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> Result<(), csv::Error>,
) -> Result<(), Error> {
    let mut out = csv::Writer::from_writer(Vec::new());
    write(&mut out).map_err(as_text(path))?;
    replace_file(path, &out.into_inner().map_err(as_text(path))?)
}

fn as_text<E: std::fmt::Display>(path: &Path) -> impl FnOnce(E) -> Error + use<E> {
    let path = path.to_owned();
    move |error| Error::Text { path, message: error.to_string() }
}

/// Creates a folder and its parents if they do not exist.
///
/// # Errors
/// Returns an error if a folder cannot be created.
pub fn create(target: &Path) -> Result<(), Error> {
    fs::create_dir_all(target).map_err(at(target))
}

/// Replaces one file as a whole ([`files::replace`]).
///
/// # Errors
/// Returns an error if the file cannot be written. The old file is then unchanged.
pub fn replace_file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    files::replace(path, |out| out.write_all(bytes)).map_err(at(path))
}

fn at(path: &Path) -> impl FnOnce(io::Error) -> Error + use<> {
    let path = path.to_owned();
    move |error| Error::Io { path, error }
}

/// Temporary folders are private to their owner, but results are for everybody.
fn share(folder: &Path) -> io::Result<()> {
    readable(folder, 0o755)
}

#[cfg(unix)]
fn readable(path: &Path, mode: u32) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(path, fs::Permissions::from_mode(mode))
}

#[cfg(not(unix))]
fn readable(_path: &Path, _mode: u32) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_appears_whole_and_replaces_only_ours() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let target = room.path().join("deep/out");
        let begun = Folder::begin(&target, false).expect("nothing there");
        begun.write("a/b.txt", b"one").expect("written");
        begun.write("manifest.json", br#"{"schema": "contact-afu/manifest/1"}"#).expect("written");
        assert!(!target.exists());
        begun.commit().expect("renamed");
        assert_eq!(fs::read(target.join("a/b.txt")).expect("there"), b"one");

        let again = Folder::begin(&target, false).expect("ours may be replaced");
        again.write("manifest.json", br#"{"schema": "contact-afu/manifest/1"}"#).expect("written");
        again.commit().expect("renamed");
        assert!(!target.join("a").exists(), "what stood there is gone");

        fs::remove_file(target.join("manifest.json")).expect("removed");
        fs::write(target.join("thesis.txt"), "years").expect("written");
        assert!(matches!(Folder::begin(&target, false), Err(Error::Foreign(_))));
        drop(Folder::begin(&target, true).expect("forced"));
        assert!(target.join("thesis.txt").exists(), "an abandoned folder changes nothing");
        let left: Vec<_> = fs::read_dir(room.path().join("deep")).expect("there").collect();
        assert_eq!(left.len(), 1, "nothing is left aside: {left:?}");
    }

    #[test]
    fn a_file_stays_inside_its_folder() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let begun = Folder::begin(&room.path().join("out"), false).expect("nothing there");
        for path in ["../x", "/x", "a/../../x", ""] {
            assert!(matches!(begun.write(path, b""), Err(Error::Path(_))), "{path}");
        }
    }

    #[test]
    fn a_file_is_no_folder() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let file = room.path().join("f");
        replace_file(&file, b"old").expect("written");
        replace_file(&file, b"new").expect("written");
        assert_eq!(fs::read(&file).expect("there"), b"new");
        assert!(matches!(check(&file, true), Err(Error::NotAFolder(_))));
    }

    #[test]
    fn a_study_does_not_replace_another_unasked() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let manifest = |schema: &str| {
            replace_json(&room.path().join(manifest::NAME), &serde_json::json!({ "schema": schema })).expect("written");
        };
        check_study(room.path(), "contact-afu/hard/2", false).expect("an empty folder");
        for (there, may) in
            [("hard/2", true), ("hard/1", true), ("hard/17", true), ("sweep/2", false), ("harder/2", false)]
        {
            manifest(&format!("contact-afu/{there}"));
            assert_eq!(check_study(room.path(), "contact-afu/hard/2", false).is_ok(), may, "{there}");
            check_study(room.path(), "contact-afu/hard/2", true).expect("forced");
        }
        manifest("their/hard/2");
        assert!(matches!(check_study(room.path(), "contact-afu/hard/2", false), Err(Error::Foreign(_))));
    }
}
