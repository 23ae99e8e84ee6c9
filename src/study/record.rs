//! What was asked for, kept in the store.

use std::fs;
use std::io;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::files;
use crate::store::{Store, StoreError, sha256};

const SCHEMA: &str = "contact-afu/study/1";
/// The folder of all records within a store.
const FOLDER: &str = "studies";

/// A study that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    schema: String,
    version: String,
    /// The kind of study: the name of its command.
    pub kind: String,
    /// The command that asked, without options that say where results go or who measures.
    pub command: String,
    /// Everything that decides the results, as its kind has it.
    of: Value,
}

impl Record {
    /// A record of this kind.
    ///
    /// # Errors
    /// Returns an error if `of` has no JSON.
    pub fn new(kind: &str, command: &str, of: &impl Serialize) -> Result<Self, StoreError> {
        Ok(Self {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            kind: kind.to_owned(),
            command: command.to_owned(),
            of: serde_json::to_value(of).map_err(|error| StoreError::Json(error.to_string()))?,
        })
    }

    /// What was asked for; `None` if this version cannot read it.
    pub fn of<T: DeserializeOwned>(&self) -> Option<T> {
        serde_json::from_value(self.of.clone()).ok().filter(|_| self.version == env!("CARGO_PKG_VERSION"))
    }

    /// A short name, unlike that of any other study.
    pub fn name(&self) -> String {
        let hash = sha256(format!("{} {} {}", self.kind, self.version, self.of).as_bytes());
        hash.chars().take(12).collect()
    }

    /// Keeps the record in a store. The same study asked for again, perhaps in other words, is there already.
    ///
    /// # Errors
    /// Returns an error if the file system refuses.
    pub fn keep(&self, store: &Store) -> Result<(), StoreError> {
        let folder = store.folder().join(FOLDER);
        let path = folder.join(format!("{}.json", self.name()));
        if path.exists() {
            return Ok(());
        }
        fs::create_dir_all(&folder).map_err(|error| StoreError::io("create", &folder, error))?;
        let text = serde_json::to_vec_pretty(self).map_err(|error| StoreError::Json(error.to_string()))?;
        files::replace(&path, |out| out.write_all(&text)).map_err(|error| StoreError::io("write", &path, error))
    }

    /// The records of a store, in the order of their names. Files that are not records are passed over.
    ///
    /// # Errors
    /// Returns an error if the folder is there and cannot be read.
    pub fn all(store: &Store) -> Result<Vec<Self>, StoreError> {
        let folder = store.folder().join(FOLDER);
        let fail = |error| StoreError::io("read", &folder, error);
        let entries = match fs::read_dir(&folder) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => entries.map_err(fail)?,
        };
        let mut all = Vec::new();
        for entry in entries {
            let text = fs::read(entry.map_err(fail)?.path()).map_err(fail)?;
            all.extend(serde_json::from_slice::<Self>(&text).ok().filter(|record| record.schema == SCHEMA));
        }
        all.sort_by_key(Self::name);
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_study_is_kept_once_and_found() {
        let store = Store::temporary().expect("a temporary folder");
        assert_eq!(Record::all(&store).expect("no folder is no error"), []);
        let one = Record::new("sweep", "afu sweep --scpus 1,2", &[1, 2]).expect("JSON");
        let other = Record::new("sweep", "afu sweep --scpus 1", &[1]).expect("JSON");
        for record in [&one, &other, &Record { command: "afu sweep --scpus 1..2".to_owned(), ..one.clone() }] {
            record.keep(&store).expect("kept");
        }
        fs::write(store.folder().join("studies/notes.txt"), "of mine").expect("written");
        let mut both = [one.clone(), other];
        both.sort_by_key(Record::name);
        assert_eq!(Record::all(&store).expect("read"), both, "in the words of who came first");
        assert_eq!(one.of::<Vec<u32>>(), Some(vec![1, 2]));
        assert_eq!(one.of::<String>(), None);
        assert_eq!(Record { version: "0.0.0".to_owned(), ..one }.of::<Vec<u32>>(), None, "of another version");
    }
}
