//! `afu completions`: what a shell needs to complete afu's options.

use std::io;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::Program;
use super::failure::{Classify, Failure, Kind};

#[derive(Args, Debug)]
pub struct Completions {
    /// The shell; for bash: afu completions bash > ~/.local/share/bash-completion/completions/afu
    shell: Shell,
}

pub fn run(options: &Completions) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut Program::command(), "afu", &mut text);
    io::Write::write_all(&mut io::stdout(), &text).ends(Kind::Other)
}
