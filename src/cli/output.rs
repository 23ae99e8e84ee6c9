//! Where a subcommand's results go: `-` is standard output, anything else a file that is replaced whole.

use std::io::{self, Write};
use std::path::Path;

use contact_afu::report::folder;
use serde::Serialize;

use super::failure::{Classify, Failure, Kind};

/// Whether results for machines take standard output, so that tables for people must not.
pub fn is_stdout(path: &Path) -> bool {
    path == Path::new("-")
}

/// Writes bytes to a file, or to standard output for `-`.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if is_stdout(path) {
        return io::stdout().write_all(bytes).ends(Kind::Other);
    }
    Ok(folder::replace_file(path, bytes)?)
}

/// Writes to standard output. A reader that has read enough, such as `head`, is no failure.
pub fn stdout(content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = io::BufWriter::new(io::stdout());
    match content(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error).ends(Kind::Other),
        _ => Ok(()),
    }
}

/// Writes a value as JSON, with a line end behind it.
pub fn json(path: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let mut text = serde_json::to_vec_pretty(value).ends(Kind::Other)?;
    text.push(b'\n');
    write(path, &text)
}

/// Shows text for people: on standard output, or on standard error when machines have taken that.
pub fn show(text: &str, stdout_taken: bool) -> Result<(), Failure> {
    let shown = if stdout_taken { writeln!(io::stderr(), "{text}") } else { writeln!(io::stdout(), "{text}") };
    shown.ends(Kind::Other)
}
