//! How to install a tool: by the repository's script if the current folder is the repository, otherwise by commands of
//! Debian and Python.

use std::path::Path;

/// A virtual environment in the current folder, where tools look for wheels, and its pip.
macro_rules! wheel {
    ($name:literal) => {
        concat!("python3 -m venv .venv && .venv/bin/pip install ", $name)
    };
}
pub(super) use wheel;

/// True if the repository's scripts are in the current folder. They are not if `cargo install` installed the program.
fn has_scripts() -> bool {
    Path::new("scripts/setup").is_file()
}

/// The script if it is there, otherwise the commands that do the same.
pub(super) fn by(script: &'static str, commands: &'static str) -> &'static str {
    if has_scripts() { script } else { commands }
}

/// How to get a program with the Open Dynamics Engine. `arguments` are those for the new program.
pub fn ode(arguments: &str) -> String {
    if has_scripts() {
        format!("./scripts/setup --ode && cargo run --release --features ode -- {arguments}")
    } else {
        format!(
            "apt-get install libode-dev libclang-dev, install afu again with `--features ode`, and run afu {arguments}"
        )
    }
}
