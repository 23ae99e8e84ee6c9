//! `afu completions`: what a shell needs to complete afu's options.

use std::io;

use clap::Args;
use clap_complete::Shell;

use super::failure::{Classify, Failure, Kind};
use super::usage;

#[derive(Args, Debug)]
pub struct Completions {
    /// The shell; for bash: afu completions bash > ~/.local/share/bash-completion/completions/afu
    shell: Shell,
}

pub fn run(options: &Completions) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut usage::command(), "afu", &mut text);
    io::Write::write_all(&mut io::stdout(), &text).ends(Kind::Other)
}
