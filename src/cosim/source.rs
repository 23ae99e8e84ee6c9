//! The Verilog from which a model is built.

use std::path::Path;

use super::error::CosimError;
use super::verilate::{self, File};

/// Verilog files with the top module and its parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    files: Vec<File>,
    top: String,
    parameters: Vec<(String, String)>,
}

impl Source {
    /// The module `top` in `files`, each of which comes before those that use it.
    pub fn new(top: &str, files: Vec<File>) -> Self {
        Self { files, top: top.to_owned(), parameters: Vec::new() }
    }

    /// The module `top` in the files that `folder/top.f` lists.
    ///
    /// # Errors
    /// Returns an error if the list or one of its files cannot be read, or names a file outside the folder.
    pub fn from_folder(folder: &Path, top: &str) -> Result<Self, CosimError> {
        Self::from_list(&folder.join(format!("{top}.f")), top)
    }

    /// The module `top` in the files that the file `list` lists, relative to its folder.
    ///
    /// # Errors
    /// Returns the errors of `from_folder`.
    pub fn from_list(list: &Path, top: &str) -> Result<Self, CosimError> {
        Ok(Self::new(top, verilate::read_file_list(list)?))
    }

    /// Sets a parameter of the top module to a number.
    #[must_use]
    pub fn parameter(mut self, name: &str, value: u64) -> Self {
        self.parameters.retain(|(known, _)| known != name);
        self.parameters.push((name.to_owned(), value.to_string()));
        self
    }

    /// The files.
    pub fn files(&self) -> &[File] {
        &self.files
    }

    /// The top module.
    pub fn top(&self) -> &str {
        &self.top
    }

    /// The parameters that were set, with their values.
    pub fn parameters(&self) -> &[(String, String)] {
        &self.parameters
    }

    /// SHA-256 of the files, in lower-case hex. Parameters do not count.
    pub fn sha256(&self) -> String {
        verilate::rtl_sha256(&self.files)
    }

    /// Names end up on Verilator's command line and in paths.
    pub(super) fn check(&self) -> Result<(), CosimError> {
        let word = |text: &str| {
            !text.is_empty()
                && !text.starts_with(|c: char| c.is_ascii_digit())
                && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        let names = self.parameters.iter().map(|(name, _)| name).chain([&self.top]);
        if let Some(name) = names.into_iter().find(|name| !word(name)) {
            return Err(CosimError::Source(format!("`{name}` is not a name of a Verilog module or parameter")));
        }
        for File { name, .. } in &self.files {
            let inside = |part: &str| !part.is_empty() && part != "." && part != "..";
            if name.starts_with(['-', '+']) || name.contains('\0') || !name.split('/').all(inside) {
                return Err(CosimError::Source(format!("`{name}` is not a relative path inside the source")));
            }
        }
        if self.files.is_empty() {
            return Err(CosimError::Source(format!("no Verilog file for module {}", self.top)));
        }
        Ok(())
    }
}
