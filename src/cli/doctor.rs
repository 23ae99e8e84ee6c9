//! `afu doctor`: the tools outside, whether they are there, and what installs them.

use std::path::PathBuf;

use clap::Args;
use contact_afu::report::doctor;
use contact_afu::tools;

use super::failure::{Failure, Kind};
use super::output;

#[derive(Args, Debug)]
pub struct Doctor {
    /// Write the findings as JSON too; - is standard output
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
