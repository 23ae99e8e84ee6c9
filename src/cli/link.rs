//! `--link`: a name, or a file of a link.

use std::fs;

use contact_afu::link::{Description, LinkModel};

use super::failure::{Classify, Failure, Kind};

/// The link of that name, or of that `.toml` or `.json` file, at a clock.
pub fn read(text: &str, clock_mhz: f64) -> Result<LinkModel, Failure> {
    describe(text)?.at(clock_mhz).ends(Kind::Usage)
}

/// The link of that name or file, before its clock is known.
pub fn describe(text: &str) -> Result<Description, Failure> {
    let usage = |why: &dyn std::fmt::Display| Failure::new(Kind::Usage, why);
    if ![".toml", ".json"].iter().any(|ending| text.ends_with(ending)) {
        let named = text.parse::<Description>();
        return named.map_err(|error| usage(&format!("{error}, or a .toml or .json file of a link")));
    }
    let content = fs::read_to_string(text).map_err(|error| usage(&format!("{text}: {error}")))?;
    Description::parse(text, &content).map_err(|error| usage(&error))
}
