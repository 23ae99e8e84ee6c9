//! `afu completions`: a script with which a shell completes afu's commands and options.

use std::io;

use clap::Args;
use clap_complete::Shell;

use super::failure::{Classify, Failure, Kind};
use super::usage;

/// Print a script that completes afu's commands and options in your shell
///
/// In bash, `afu completions bash > ~/.local/share/bash-completion/completions/afu` installs it.
#[derive(Args, Debug)]
pub struct Completions {
    /// Your shell
    shell: Shell,
}

pub fn run(options: &Completions) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut usage::command(), "afu", &mut text);
    io::Write::write_all(&mut io::stdout(), &text).ends(Kind::Other)
}
