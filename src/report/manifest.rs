//! `manifest.json`: what a folder of results is, and the mark by which afu knows its own.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// Its name in every folder that afu writes.
pub const NAME: &str = "manifest.json";
/// What its `schema` begins with.
pub(crate) const FAMILY: &str = "contact-afu/";

/// The schema of the manifest in `folder`; `None` if there is none of ours.
pub fn schema(folder: &Path) -> Option<String> {
    let manifest: Value = serde_json::from_slice(&fs::read(folder.join(NAME)).ok()?).ok()?;
    let schema = manifest.get("schema")?.as_str()?;
    schema.starts_with(FAMILY).then(|| schema.to_owned())
}
