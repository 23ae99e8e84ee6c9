//! Pairs that once mismatched, in a CSV file. A later run tries them first.

use std::collections::HashSet;
use std::path::Path;

use crate::pairs::{FileError, Loaded, read_with_notes, write_pairs};
use crate::query::{PairRecord, Query};

/// The pairs of the corpus `file`; empty if the file does not exist.
///
/// # Errors
/// Returns an error if the file cannot be read or is not a CSV or npy file of pairs.
pub fn read(query: Query, file: &Path) -> Result<Loaded, FileError> {
    match file.try_exists() {
        Ok(false) => Ok(Loaded { pairs: Vec::new(), rounded: None }),
        _ => read_with_notes(query, file),
    }
}

/// Adds those of `pairs` to `file` that are not in it yet, each once. Returns their number. If there are none, the file
/// is not touched.
///
/// # Errors
/// Returns the errors of [`read`], and an error if the file cannot be written.
pub fn join(query: Query, file: &Path, pairs: impl IntoIterator<Item = PairRecord>) -> Result<usize, FileError> {
    let mut corpus = read(query, file)?.pairs;
    let mut known: HashSet<PairRecord> = corpus.iter().copied().collect();
    let before = corpus.len();
    corpus.extend(pairs.into_iter().filter(|pair| known.insert(*pair)));
    let added = corpus.len() - before;
    if added > 0 {
        write_pairs(query, file, &corpus)?;
    }
    Ok(added)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corpus_grows_by_what_is_new() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let file = room.path().join("corpus.csv");
        let pair = |x: f32| PairRecord::from_spheres([x, 0.0, 0.0, 1.0], [0.0, f32::NAN, -0.0, 1e-45]);
        assert_eq!(read(Query::SphereSphere, &file).expect("no file is no pairs").pairs, []);
        assert_eq!(join(Query::SphereSphere, &file, []).expect("nothing to write"), 0);
        assert!(!file.exists());
        assert_eq!(join(Query::SphereSphere, &file, [pair(1.0), pair(2.0), pair(1.0)]).expect("written"), 2);
        assert_eq!(join(Query::SphereSphere, &file, [pair(2.0), pair(3.0)]).expect("written"), 1);
        assert_eq!(read(Query::SphereSphere, &file).expect("as written").pairs, [pair(1.0), pair(2.0), pair(3.0)]);
    }
}
