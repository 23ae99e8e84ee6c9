//! Finds a tool and reads its version. Nothing here fails: a tool that cannot be asked counts as missing.

use std::env;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The first line that a program prints, or `None` if it cannot be run.
pub(super) fn version(program: impl AsRef<OsStr>, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).stdin(Stdio::null()).output().ok()?;
    let said = if output.stdout.is_empty() { output.stderr } else { output.stdout };
    let line = String::from_utf8_lossy(&said).lines().next().unwrap_or_default().trim().to_owned();
    output.status.success().then_some(line)
}

/// The C++ compiler that compiles models.
#[cfg(feature = "cosim")]
pub(super) fn compiler() -> Option<String> {
    let target = env!("AFU_TARGET");
    crate::cosim::verilate::Compiler::find(target, target).ok().map(|compiler| compiler.version().to_owned())
}

/// The C++ compiler that would compile models if this program had that feature.
#[cfg(not(feature = "cosim"))]
pub(super) fn compiler() -> Option<String> {
    version(cxx(), &["--version"])
}

/// The Verilator that makes models. Its version text may not have a number, so its path is shown too.
#[cfg(feature = "cosim")]
pub(super) fn verilator() -> Option<String> {
    let tool = crate::cosim::verilate::Tool::find().ok()?;
    Some(format!("{} ({})", tool.version(), tool.program().display()))
}

/// The Verilator that would make models if this program had that feature.
#[cfg(not(feature = "cosim"))]
pub(super) fn verilator() -> Option<String> {
    version(env::var_os("AFU_VERILATOR").unwrap_or_else(|| "verilator".into()), &["--version"])
}

fn cxx() -> std::ffi::OsString {
    env::var_os("CXX").unwrap_or_else(|| "c++".into())
}

/// The last line that a program prints, or `None` if it cannot be run. A wheel's first run prints more before it.
pub(super) fn last_line(program: impl AsRef<OsStr>, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).stdin(Stdio::null()).output().ok()?;
    let said = if output.stdout.is_empty() { output.stderr } else { output.stdout };
    let line = String::from_utf8_lossy(&said).lines().rfind(|line| !line.trim().is_empty())?.trim().to_owned();
    output.status.success().then_some(line)
}

/// A header that the C++ compiler finds.
pub(super) fn header(name: &str) -> Option<String> {
    let status = Command::new(cxx())
        .args(["-x", "c++", "-fsyntax-only", "-include", name, "/dev/null"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .ok()?;
    status.success().then(|| name.to_owned())
}

/// libclang in the places where its users look for it.
pub(super) fn libclang() -> Option<String> {
    let mut folders: Vec<PathBuf> = env::var_os("LIBCLANG_PATH").map(PathBuf::from).into_iter().collect();
    for root in ["/usr/lib", "/usr/lib64", "/usr/local/lib"] {
        folders.push(root.into());
        let inner = children(Path::new(root));
        folders.extend(inner.iter().map(|folder| folder.join("lib")));
        folders.extend(inner);
    }
    folders.iter().flat_map(|folder| children(folder)).find_map(|file| {
        let name = file.file_name()?.to_str()?;
        (name.starts_with("libclang.") || name.starts_with("libclang-")).then_some(())?;
        (name.contains(".so") || name.ends_with(".dylib")).then(|| file.display().to_string())
    })
}

fn children(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = folder.read_dir() else { return Vec::new() };
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    paths
}
