//! The virtual environments of Python in which tools from wheels may be installed.
//!
//! `tools` uses this file too (by `#[path]`), because it also searches in programs without simulation.

use std::env;
use std::path::{Path, PathBuf};

/// The environment that this program was installed in, the repository's, the current folder's and the active one.
pub(super) fn environments() -> Vec<PathBuf> {
    // `environment/bin/afu` is where pip puts the program.
    let own = env::current_exe().ok().and_then(|program| Some(program.parent()?.parent()?.to_owned()));
    // build.rs sets it, unless the program is made for other machines. (A build script itself runs in the repository.)
    let repository = option_env!("AFU_REPOSITORY").map(|folder| Path::new(folder).join(".venv"));
    let active = env::var_os("VIRTUAL_ENV").map(PathBuf::from);
    [own, repository, Some(PathBuf::from(".venv")), active].into_iter().flatten().collect()
}
