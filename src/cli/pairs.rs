//! `afu pairs`: a named set of pairs as a file.

use std::path::PathBuf;

use clap::Args;
#[cfg(feature = "cosim")]
use contact_afu::pairs::Loaded;
use contact_afu::pairs::{self, FileError, LoadError, Set, SetError};
#[cfg(feature = "cosim")]
use contact_afu::query::PairRecord;
use contact_afu::query::Query;
use contact_afu::report::table::counted;

use super::failure::{Failure, Kind};
use super::{output, usage};

/// Write a named set of test pairs to a CSV or npy file
///
/// Other commands accept the file, or the name of the set itself, with --pairs.
#[derive(Args, Debug)]
pub struct Pairs {
    /// Set of pairs: diamond:H, random:N, dense:N or hard:N
    ///
    /// `diamond:H` is the paper's diamond: touching spheres in the shape of an octahedron, with H layers from the
    /// centre to a tip. `random:N` holds N pairs of every kind: apart, touching, coincident (equal centres; the paper's
    /// "grazing") and invalid. `dense:N` holds N pairs with overlapping bounding boxes from crowded scenes. `hard:N`
    /// holds N pairs on which floating-point engines fail.
    #[arg(value_name = "SET")]
    set: Set,
    /// The two bodies of a pair; diamond and dense exist for sphere-sphere only
    #[arg(long, value_name = "QUERY", default_value_t, value_parser = usage::query())]
    query: Query,
    /// Seed of random, dense and hard pairs
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = usage::seed)]
    seed: u64,
    /// File to write, .csv or .npy; - writes CSV to standard output
    ///
    /// A row of the CSV holds the numbers of a pair, such as x1,y1,z1,r1,x2,y2,z2,r2, with all the digits needed to
    /// read back the same bits. The npy file holds an N × 8 array of f4.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// The pairs of a set or a file.
#[cfg(feature = "cosim")]
pub fn load(query: Query, source: &str, seed: u64) -> Result<Vec<PairRecord>, Failure> {
    Ok(noted(source, pairs::load_with_notes(query, source, seed)?))
}

/// The pairs of a file. A note on standard error counts numbers that had to be rounded.
#[cfg(feature = "cosim")]
pub fn noted(source: &str, Loaded { pairs, rounded }: Loaded) -> Vec<PairRecord> {
    if let Some(rounded) = rounded {
        eprintln!("afu: {source}: {rounded}");
    }
    pairs
}

pub fn run(options: &Pairs) -> Result<(), Failure> {
    let made = options.set.pairs_of(options.query, options.seed)?;
    if output::is_stdout(&options.out) {
        return output::stdout(|out| pairs::write_pairs_csv(out, options.query, &made));
    }
    pairs::write_pairs(options.query, &options.out, &made)?;
    let seed = match options.set {
        Set::Random(_) | Set::Dense(_) | Set::Hard(_) => format!(", seed {}", options.seed),
        Set::Diamond(_) => String::new(),
    };
    output::show(
        &format!("{}: {} of {}{seed}", options.out.display(), counted(made.len() as u64, "pair"), options.set),
        false,
    )
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        let kind = if matches!(error, FileError::Io { doing: "written", .. }) { Kind::Other } else { Kind::Usage };
        Self::caused(kind, error)
    }
}

impl From<SetError> for Failure {
    fn from(error: SetError) -> Self {
        Self::caused(Kind::Usage, error)
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::Set(error) => error.into(),
            LoadError::File(error) => error.into(),
        }
    }
}
