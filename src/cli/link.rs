//! `--link`: a name, or a file of a link.

use std::fs;

use contact_afu::link::{Description, LinkModel};

use super::failure::{Classify, Failure, Kind};

/// The link of that name, or of that `.toml` or `.json` file, at a clock.
pub fn read(text: &str, clock_mhz: f64) -> Result<LinkModel, Failure> {
    describe(text)?.at(clock_mhz).ends(Kind::Usage)
}

/// The link of that name or file, before its clock is known.
pub fn describe(name: &str) -> Result<Description, Failure> {
    let usage = |why: &dyn std::fmt::Display| Failure::new(Kind::Usage, why);
    match text(name)? {
        Some(text) => Description::parse(name, &text).map_err(|error| usage(&error)),
        None => {
            name.parse::<Description>().map_err(|error| usage(&format!("{error}, or a .toml or .json file of a link")))
        }
    }
}

/// The text of a link's file; `None` if the link has a name.
pub fn text(name: &str) -> Result<Option<String>, Failure> {
    if ![".toml", ".json"].iter().any(|ending| name.ends_with(ending)) {
        return Ok(None);
    }
    let usage = |error| Failure::new(Kind::Usage, format!("{name}: {error}"));
    fs::read_to_string(name).map(Some).map_err(usage)
}
