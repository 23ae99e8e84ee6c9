//! `afu doctor`: which external tools are installed, and how to install the missing ones.

use std::path::PathBuf;

use clap::Args;
use contact_afu::report::doctor;
use contact_afu::tools;

use super::failure::{Failure, Kind};
use super::output;

/// List the external tools: which are installed, what needs them, how to install them
///
/// The command ends with status 3 if a tool that simulation needs is missing.
#[derive(Args, Debug)]
pub struct Doctor {
    /// Also write the findings as JSON (schema contact-afu/doctor/1) to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn run(options: &Doctor) -> Result<(), Failure> {
    let found = tools::all();
    let stdout_taken = options.json.as_deref().is_some_and(output::is_stdout);
    output::show(&doctor::text(&found), stdout_taken)?;
    if let Some(path) = &options.json {
        output::json(path, &doctor::Report::new(&found))?;
    }
    match found.iter().find(|tool| tool.required && tool.found.is_none()) {
        None => Ok(()),
        Some(tool) => {
            let message = format!("{} is missing; install it with: {}", tool.name, tool.install);
            Err(Failure::new(Kind::Tool, message))
        }
    }
}
