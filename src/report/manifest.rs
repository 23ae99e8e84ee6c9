//! `manifest.json`: what a folder of results is, and the mark by which afu knows its own.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// Its name in every folder that afu writes.
pub const NAME: &str = "manifest.json";
/// What its `schema` begins with.
pub const FAMILY: &str = "contact-afu/";

/// Whether `folder` holds a manifest of ours.
pub fn is_ours(folder: &Path) -> bool {
    let Ok(text) = fs::read(folder.join(NAME)) else { return false };
    let Ok(manifest) = serde_json::from_slice::<Value>(&text) else { return false };
    manifest.get("schema").and_then(Value::as_str).is_some_and(|schema| schema.starts_with(FAMILY))
}
