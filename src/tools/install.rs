//! What installs a tool: the repository's script, where the user stands in the repository, else the commands of Debian
//! and of Python.

use std::path::Path;

/// A virtual environment in the current folder, where wheels are looked for, and its pip.
macro_rules! wheel {
    ($name:literal) => {
        concat!("python3 -m venv .venv && .venv/bin/pip install ", $name)
    };
}
pub(super) use wheel;

/// Whether the repository's scripts are in the current folder: not where `cargo install` put the program.
fn has_scripts() -> bool {
    Path::new("scripts/setup").is_file()
}

/// The script if it is there, else the commands that do the same.
pub(super) fn by(script: &'static str, commands: &'static str) -> &'static str {
    if has_scripts() { script } else { commands }
}

/// What gives a program the Open Dynamics Engine; `arguments` are those it is to be run with.
pub fn ode(arguments: &str) -> String {
    if has_scripts() {
        format!("./scripts/setup --ode && cargo run --release --features ode -- {arguments}")
    } else {
        format!(
            "apt-get install libode-dev libclang-dev, install afu again with `--features ode`, and run afu {arguments}"
        )
    }
}
