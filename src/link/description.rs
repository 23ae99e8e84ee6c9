//! Links by name or file.

use std::str::FromStr;

use super::model::{LinkError, LinkModel};
use super::physical::Physical;

/// The links that have a name: first [`LinkModel::PRESETS`], then real ones.
pub const NAMES: [&str; 9] = ["ideal", "late", "shuffled", "hostile", "harp1", "harp2", "pcie3x8", "zynqmp", "ddr4"];

/// A link, independent of the AFU's clock.
#[derive(Clone, Debug, PartialEq)]
pub enum Description {
    /// A link in cycles and lines, which is the same at every clock.
    Cycles(Box<LinkModel>),
    /// A link in nanoseconds and bytes.
    Physical(Box<Physical>),
}

impl Description {
    /// The link of a file: JSON is a [`LinkModel`] in cycles, anything else a [`Physical`] in TOML.
    ///
    /// # Errors
    /// Returns an error, with `file` and the line, if `text` is not what the name of the file says.
    pub fn parse(file: &str, text: &str) -> Result<Self, LinkError> {
        if !file.ends_with(".json") {
            return Ok(Self::Physical(Box::new(Physical::parse(file, text)?)));
        }
        let wrong = |message: String| LinkError::File { file: file.to_owned(), message };
        let model: LinkModel = serde_json::from_str(text).map_err(|error| wrong(error.to_string()))?;
        model.check().map_err(|error| wrong(error.to_string()))?;
        Ok(Self::Cycles(Box::new(model)))
    }

    /// The link at a clock of `mhz`.
    ///
    /// # Errors
    /// Returns the errors of [`Physical::at`].
    pub fn at(&self, mhz: f64) -> Result<LinkModel, LinkError> {
        match self {
            Self::Cycles(model) => Ok(LinkModel::clone(model)),
            Self::Physical(physical) => physical.at(mhz),
        }
    }
}

impl FromStr for Description {
    type Err = LinkError;

    fn from_str(name: &str) -> Result<Self, LinkError> {
        let text = match name {
            "harp1" => include_str!("presets/harp1.toml"),
            "harp2" => include_str!("presets/harp2.toml"),
            "pcie3x8" => include_str!("presets/pcie3x8.toml"),
            "zynqmp" => include_str!("presets/zynqmp.toml"),
            "ddr4" => include_str!("presets/ddr4.toml"),
            _ => return name.parse().map(|model| Self::Cycles(Box::new(model))),
        };
        Self::parse(name, text)
    }
}
