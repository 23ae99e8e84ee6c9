//! The results of a study.

use super::{Plan, Point, Time};
use crate::synth::Target;
use serde::{Deserialize, Serialize};

/// The schema of a study's results. Within a number keys are only added.
pub const SCHEMA: &str = "contact-afu/accuracy/1";
/// A set of pairs, as results name it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetFigures {
    /// The name of the set.
    pub name: String,
    /// The number of pairs.
    pub pairs: u64,
    /// True if the pictures show the errors of this set.
    pub is_scene: bool,
}

/// All results of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// [`SCHEMA`].
    pub schema: String,
    /// The version of this crate.
    pub version: String,
    /// The day that software was timed, year first, in UTC; empty if it was not.
    pub date: String,
    /// The command that made the study.
    pub command: String,
    /// The processor that software was timed on; empty if it was not.
    pub processor: String,
    /// The sets of pairs.
    pub sets: Vec<SetFigures>,
    /// Seed of pairs and link.
    pub seed: u64,
    /// The link.
    pub link: String,
    /// The FPGA family.
    pub target: Target,
    /// What is missing, with the reason.
    pub left_out: Vec<String>,
    /// The fastest software kernels on this machine: name, and ns per pair.
    pub kernels: Vec<(String, f64)>,
    /// The points, in the order of the plan.
    pub points: Vec<Point>,
}

impl Study {
    /// The results of a plan, without points.
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

    /// The kinds of time that any point has. The time of a full device is known only if areas are.
    pub fn times(&self) -> Vec<Time> {
        let is_known = |time: &Time| self.points.iter().any(|point| time.of(point, self).is_some());
        Time::ALL.into_iter().filter(is_known).collect()
    }

    /// True if the area of any point is known.
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

    /// True if a point may be compared with others: it was placed and routed, or no point was. A clock of the delay
    /// model cannot be compared with one of a router.
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

    /// The mean of a point's relative errors on the scenes.
    pub(crate) fn typical(&self, point: &Point) -> f64 {
        point.errors(&self.scenes()).contact.mean
    }
}

/// The results that are part of this crate. They contain the command that made them.
///
/// # Errors
/// Returns an error if the file of the crate is not what this version reads; a test checks that it is.
pub fn committed() -> Result<Study, serde_json::Error> {
    serde_json::from_str(include_str!("committed.json"))
}
