//! Reads a configuration from a manifest.

use std::path::{Path, PathBuf};
use std::{fs, io};

use serde::Deserialize;

use super::Config;

/// The schema of the manifest in a folder of generated Verilog.
pub const MANIFEST_SCHEMA: &str = "contact-afu/rtl/1";

/// Why no configuration could be read from a file.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file could not be read.
    #[error("{}: {error}", path.display())]
    Io {
        /// The file, for the message.
        path: PathBuf,
        /// The error of the file system.
        error: io::Error,
    },
    /// The file is not JSON, or a key is wrong; the message names line and key.
    #[error("{}: {error}", path.display())]
    Json {
        /// The file, for the message.
        path: PathBuf,
        /// The error with line and key.
        error: serde_json::Error,
    },
    /// The JSON has another schema.
    #[error("{}: expected schema `{MANIFEST_SCHEMA}`, found `{found}`", path.display())]
    Schema {
        /// The file, for the message.
        path: PathBuf,
        /// The schema in the file.
        found: String,
    },
}

#[derive(Deserialize)]
struct Manifest {
    schema: String,
    config: Config,
}

/// Reads the configuration from a manifest; `path` is the file or its folder.
///
/// # Errors
/// Returns an error if the file cannot be read, is not JSON, or is not a manifest of this schema.
pub fn read(path: &Path) -> Result<Config, ReadError> {
    let path = if path.is_dir() { path.join("manifest.json") } else { path.to_owned() };
    let text = fs::read(&path).map_err(|error| ReadError::Io { path: path.clone(), error })?;
    let manifest: Manifest =
        serde_json::from_slice(&text).map_err(|error| ReadError::Json { path: path.clone(), error })?;
    if manifest.schema != MANIFEST_SCHEMA {
        return Err(ReadError::Schema { path, found: manifest.schema });
    }
    Ok(manifest.config)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_manifest_gives_its_configuration_or_says_where_it_is_wrong() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let file = room.path().join("manifest.json");
        fs::write(&file, r#"{"schema": "contact-afu/rtl/1", "config": {"scpus": 3}, "files": {}}"#).expect("w");
        assert_eq!(read(&file).expect("good").scpus, 3);
        assert_eq!(read(room.path()).expect("its folder").scpus, 3);

        for (text, says) in [
            ("{\n\"schema\": \"contact-afu/rtl/1\",\n\"config\": {\"scpus\": \"x\"}}", "line 3"),
            ("{\"schema\": \"other/1\", \"config\": {}}", "other/1"),
            ("{\"schema\": \"contact-afu/rtl/1\"}", "missing field `config`"),
            ("scpus = 3", "line 1"),
        ] {
            fs::write(&file, text).expect("written");
            let message = read(&file).expect_err(says).to_string();
            assert!(message.contains(says) && message.contains("manifest.json"), "{message}");
        }
    }
}
