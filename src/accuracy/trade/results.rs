//! The store of a study's measurements, and its results.

use super::cost::{Cycles, Hardware};
use super::{Plan, Point, Time};
use crate::accuracy::Row;
use crate::report::folder::{self, replace_file};
use crate::synth::Target;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The schema of a study's results. Within a number keys are only added.
pub const SCHEMA: &str = "contact-afu/accuracy/1";
const STORE: &str = "contact-afu/accuracy-store/1";
const MANIFEST: &str = "manifest.json";

/// Why results could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// The folder belongs to somebody else, or the file system refused.
    #[error(transparent)]
    Folder(#[from] folder::Error),
    /// A file or folder could not be read or made.
    #[error("{}: {error}", path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// Something could not be turned into text.
    #[error("cannot write the results: {0}")]
    Write(String),
}

impl ResultsError {
    pub(super) fn write(error: impl std::fmt::Display) -> Self {
        Self::Write(error.to_string())
    }
}

/// Measurements by the hash of what went into them, in a folder's `manifest.json` as they come.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Store {
    schema: String,
    version: String,
    pub rows: Vec<Row>,
    pub cycles: Vec<Cycles>,
    pub hardware: Vec<Hardware>,
    #[serde(skip)]
    folder: Option<PathBuf>,
}

impl Store {
    /// What `folder` holds already; nothing is kept without one.
    pub fn open(folder: Option<(&Path, bool)>) -> Result<Self, ResultsError> {
        let empty = Self { schema: STORE.to_owned(), version: env!("CARGO_PKG_VERSION").to_owned(), ..Self::default() };
        let Some((folder, force)) = folder else { return Ok(empty) };
        folder::check(folder, force)?;
        let path = folder.join(MANIFEST);
        let known = match fs::read(&path) {
            // What cannot be read as a store, or is one of another version, is another one.
            Ok(text) => serde_json::from_slice::<Self>(&text).ok().filter(|known| known.is_like(&empty)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(ResultsError::Io { path, error }),
        };
        Ok(Self { folder: Some(folder.to_owned()), ..known.unwrap_or(empty) })
    }

    fn is_like(&self, other: &Self) -> bool {
        (&self.schema, &self.version) == (&other.schema, &other.version)
    }

    /// Writes it where it was opened.
    pub fn save(&self) -> Result<(), ResultsError> {
        let Some(folder) = &self.folder else { return Ok(()) };
        fs::create_dir_all(folder).map_err(|error| ResultsError::Io { path: folder.clone(), error })?;
        let mut json = serde_json::to_vec(self).map_err(ResultsError::write)?;
        json.push(b'\n');
        Ok(replace_file(&folder.join(MANIFEST), &json)?)
    }
}

/// A set of pairs, as results name it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetFigures {
    /// Its name.
    pub name: String,
    /// Its pairs.
    pub pairs: u64,
    /// Whether errors in pictures are of it.
    pub is_scene: bool,
}

/// Everything a study came to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// [`SCHEMA`].
    pub schema: String,
    /// This crate's.
    pub version: String,
    /// The day, year first, in UTC.
    pub date: String,
    /// The command that made it.
    pub command: String,
    /// The processor that software was timed on.
    pub processor: String,
    /// The sets of pairs.
    pub sets: Vec<SetFigures>,
    /// Seed of pairs and link.
    pub seed: u64,
    /// The link.
    pub link: String,
    /// The FPGA family.
    pub target: Target,
    /// What is missing, and why.
    pub left_out: Vec<String>,
    /// The best kernels of this machine in software, ns a pair: name and time.
    pub kernels: Vec<(String, f64)>,
    /// The points, in the order of the plan.
    pub points: Vec<Point>,
}

impl Study {
    /// Without points.
    pub(super) fn new(plan: &Plan) -> Self {
        let set = |set: &super::Named| SetFigures {
            name: set.name.clone(),
            pairs: set.pairs.len() as u64,
            is_scene: set.is_scene,
        };
        Self {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            date: String::new(),
            command: String::new(),
            processor: String::new(),
            sets: plan.sets.iter().map(set).collect(),
            seed: plan.seed,
            link: plan.link_name.clone(),
            target: plan.target,
            left_out: plan.left_out.clone(),
            kernels: Vec::new(),
            points: Vec::new(),
        }
    }

    /// The times that any point has: that of a full device is known where areas are.
    pub fn times(&self) -> Vec<Time> {
        let is_known = |time: &Time| self.points.iter().any(|point| time.of(point, self).is_some());
        Time::ALL.into_iter().filter(is_known).collect()
    }

    /// Whether the area of any point is known.
    pub fn has_areas(&self) -> bool {
        self.points.iter().any(|point| point.area().is_some())
    }

    /// The names of the sets that are scenes.
    pub fn scenes(&self) -> Vec<String> {
        self.sets.iter().filter(|set| set.is_scene).map(|set| set.name.clone()).collect()
    }

    /// Pairs of all sets.
    pub fn pairs(&self) -> u64 {
        self.sets.iter().fold(0, |sum, set| sum.saturating_add(set.pairs))
    }

    /// Whether a point may be compared with others: it was placed and routed, or none was. A clock of the delay model's
    /// is one that no router gave.
    pub fn is_comparable(&self, point: &Point) -> bool {
        let is_routed = |point: &Point| point.routed_mhz().is_some();
        is_routed(point) || !self.points.iter().any(is_routed)
    }

    /// The points that may be compared.
    pub fn comparable(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(|point| self.is_comparable(point))
    }

    /// The point of this name.
    pub fn point(&self, name: &str) -> Option<&Point> {
        self.points.iter().find(|point| point.name == name)
    }

    /// A point's largest relative error on the scenes ([`contact`](crate::accuracy::ErrorStatistics::contact)).
    pub fn worst(&self, point: &Point) -> f64 {
        point.errors(&self.scenes()).contact.largest
    }

    /// Its mean.
    pub fn typical(&self, point: &Point) -> f64 {
        point.errors(&self.scenes()).contact.mean
    }
}

/// The results that are part of this crate: of the day and by the command that they name.
///
/// # Errors
/// When the file of the crate is not what this version reads; a test holds that it is.
pub fn committed() -> Result<Study, ResultsError> {
    serde_json::from_str(include_str!("committed.json")).map_err(ResultsError::write)
}
