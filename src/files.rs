//! A file of results: there whole, or as it was.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// Writes a file's whole content. A file, old or new, is written aside and renamed into place, with the permissions
/// that the old one had. Through a symbolic link the file that it names is replaced, not the link. A device, a pipe or
/// a socket is written as it stands: renamed onto, `/dev/null` would be a file, and no reader of a pipe would get a
/// byte.
///
/// # Errors
/// Returns an error if the file system refuses, or `content` fails; an old file is then as it was.
pub fn replace(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    if is_device(path)? {
        let mut out = BufWriter::new(OpenOptions::new().write(true).open(path)?);
        content(&mut out)?;
        return out.flush();
    }
    let aside = Aside::new(path)?;
    let mut out = BufWriter::new(OpenOptions::new().write(true).open(aside.path())?);
    content(&mut out)?;
    out.flush()?;
    drop(out);
    aside.finish()
}

/// True if `path` exists and is not a regular file. (A folder is not one either; opening it for writing gives its
/// error.)
fn is_device(path: &Path) -> io::Result<bool> {
    match fs::metadata(path) {
        Ok(there) => Ok(!there.is_file()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// A file that is written under a name of its own, by code that wants a name and gives no whole content, and then takes
/// the place of another as [`replace`] has it. It has a folder to itself, for files that such code puts beside it.
/// Dropped before [`Aside::finish`], it leaves nothing behind.
#[derive(Debug)]
pub struct Aside {
    /// Removed with all that is in it when this is dropped.
    _room: TempDir,
    aside: PathBuf,
    to: To,
}

/// Where it goes.
#[derive(Debug)]
enum To {
    /// A file's name, with the permissions of the one that is there.
    File(PathBuf, Option<Permissions>),
    /// Something that is no file, into which it is copied.
    Device(PathBuf),
}

impl Aside {
    /// An empty file that will take the place of `path`.
    ///
    /// # Errors
    /// Returns an error if the file system refuses.
    pub fn new(path: &Path) -> io::Result<Self> {
        if is_device(path)? {
            return Self::within(&std::env::temp_dir(), To::Device(path.to_owned()));
        }
        let old = fs::metadata(path).ok().map(|old| old.permissions());
        let named = if old.is_some() { fs::canonicalize(path)? } else { path.to_owned() };
        let folder = match named.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        Self::within(&folder, To::File(named, old))
    }

    fn within(folder: &Path, to: To) -> io::Result<Self> {
        let room = tempfile::Builder::new().prefix(".afu-").tempdir_in(folder).map_err(without_path)?;
        let aside = room.path().join("aside");
        // Made by hand rather than by tempfile, which would give it to its owner alone.
        File::create_new(&aside)?;
        Ok(Self { _room: room, aside, to })
    }

    /// Its name until then.
    pub fn path(&self) -> &Path {
        &self.aside
    }

    /// Puts it in its place.
    ///
    /// # Errors
    /// Returns an error if the file system refuses; an old file is then as it was.
    pub fn finish(self) -> io::Result<()> {
        match self.to {
            To::File(named, old) => {
                old.map_or(Ok(()), |old| fs::set_permissions(&self.aside, old))?;
                fs::rename(&self.aside, named)
            }
            To::Device(path) => {
                let mut device = OpenOptions::new().write(true).open(path)?;
                io::copy(&mut File::open(&self.aside)?, &mut device).map(drop)
            }
        }
    }
}

/// The same error without the name of a temporary file, which nobody knows.
pub(crate) fn without_path(error: io::Error) -> io::Error {
    match error.to_string().split_once(" at path ") {
        Some((cause, _)) if error.raw_os_error().is_none() => io::Error::new(error.kind(), cause),
        _ => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: &Path, text: &str) -> io::Result<()> {
        replace(path, |out| out.write_all(text.as_bytes()))
    }

    #[test]
    fn a_file_is_replaced_whole_or_stays() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let file = room.path().join("f");
        write(&file, "a longer text").expect("new");
        write(&file, "text").expect("replaced");
        assert_eq!(fs::read_to_string(&file).expect("there"), "text");
        replace(&file, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("the other half"))
        })
        .expect_err("it failed");
        assert_eq!(fs::read_to_string(&file).expect("there"), "text");
        write(room.path(), "a folder is no file").expect_err("refused");
        assert_eq!(fs::read_dir(room.path()).expect("there").count(), 1, "nothing is left aside");
    }

    /// A fault once: results for `/dev/null` became a file in its place, when it was root who asked.
    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_written_as_it_stands() {
        use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
        let room = tempfile::tempdir().expect("a temporary folder");

        // A device by its own name could be lost if this test failed; a pipe is as good.
        let pipe = room.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs");
        assert!(made.success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read_to_string(pipe)
        });
        write(&pipe, "through it").expect("written");
        assert!(fs::metadata(&pipe).expect("there").file_type().is_fifo());
        assert_eq!(reader.join().expect("read").expect("text"), "through it");

        // A link goes on to name what it named.
        let (file, link) = (room.path().join("file"), room.path().join("link"));
        fs::write(&file, "old").expect("written");
        fs::set_permissions(&file, Permissions::from_mode(0o600)).expect("private");
        symlink("file", &link).expect("linked");
        write(&link, "new").expect("written");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::read_to_string(&file).expect("there"), "new");
        assert_eq!(fs::metadata(&file).expect("there").permissions().mode() & 0o777, 0o600);
    }
}
