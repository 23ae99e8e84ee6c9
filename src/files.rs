//! A file of results: there whole, or as it was.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes a file's whole content. A file, old or new, is written aside and renamed into place, with the permissions
/// that the old one had. Through a symbolic link the file that it names is replaced, not the link. A device, a pipe or
/// a socket is written as it stands: renamed onto, `/dev/null` would be a file, and no reader of a pipe would get a
/// byte.
///
/// # Errors
/// When the file system refuses, or `content` fails; an old file is then as it was.
pub fn replace(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let old = match fs::metadata(path) {
        Ok(old) if !old.is_file() => {
            let mut out = BufWriter::new(OpenOptions::new().write(true).open(path)?);
            content(&mut out)?;
            return out.flush();
        }
        Ok(old) => Some(old.permissions()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    let named = if old.is_some() { fs::canonicalize(path)? } else { path.to_owned() };
    let folder = match named.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    // A file made by hand rather than by tempfile, which would give it to its owner alone.
    let aside = tempfile::Builder::new().prefix(".afu-").make_in(folder, |path| File::create_new(path));
    let aside = aside.map_err(without_path)?;
    let mut out = BufWriter::new(aside.as_file());
    content(&mut out)?;
    out.flush()?;
    drop(out);
    old.map_or(Ok(()), |old: Permissions| fs::set_permissions(aside.path(), old))?;
    aside.persist(&named).map_err(|failed| failed.error)?;
    Ok(())
}

/// The same error without the name of a temporary file, which nobody knows.
pub fn without_path(error: io::Error) -> io::Error {
    if error.raw_os_error().is_none() && error.kind() != io::ErrorKind::Other { error.kind().into() } else { error }
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
