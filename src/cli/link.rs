//! `--link`: a preset's name, or a file of a link model.

use std::fs;
use std::path::Path;

use contact_afu::link::LinkModel;

use super::failure::{Failure, Kind};

/// The model of that name, or of that `.json` file.
pub fn read(text: &str) -> Result<LinkModel, Failure> {
    let usage = |why: &dyn std::fmt::Display| Failure::new(Kind::Usage, why);
    if !text.ends_with(".json") {
        let model = text.parse::<LinkModel>();
        return model.map_err(|error| usage(&format!("{error}, or a .json file of a link model")));
    }
    let bytes = fs::read(Path::new(text)).map_err(|error| usage(&format!("{text}: {error}")))?;
    let model: LinkModel = serde_json::from_slice(&bytes).map_err(|error| usage(&format!("{text}: {error}")))?;
    model.check().map_err(|error| usage(&format!("{text}: {error}")))?;
    Ok(model)
}
