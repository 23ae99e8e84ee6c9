//! `manifest.json`, which says what a folder of results holds and marks it as written by afu.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// The file name in every folder that afu writes.
pub const NAME: &str = "manifest.json";
/// The beginning of its `schema`.
pub(crate) const FAMILY: &str = "contact-afu/";

/// The schema of the manifest in `folder`; `None` if there is no manifest of ours.
pub fn schema(folder: &Path) -> Option<String> {
    let manifest: Value = serde_json::from_slice(&fs::read(folder.join(NAME)).ok()?).ok()?;
    let schema = manifest.get("schema")?.as_str()?;
    schema.starts_with(FAMILY).then(|| schema.to_owned())
}
