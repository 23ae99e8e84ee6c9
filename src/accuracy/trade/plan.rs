//! The plan of a study: what it measures.

use super::axes::{self, Choice};
use crate::config::Profile;
use crate::link::Description;
use crate::pairs::Set;
use crate::query::PairRecord;
use crate::synth::Target;

/// The extent of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// A configuration a profile, some fifty thousand pairs.
    Profiles,
    /// Some ten configurations, as many pairs.
    Quick,
    /// One axis at a time from `wide`, the neighbours of the front, a million pairs, routes.
    Full,
}

/// Pairs that errors are found on.
#[derive(Clone, Debug)]
pub struct Named {
    /// The set's name.
    pub name: String,
    /// True for the pairs of a scene, whose errors the pictures show; false for hard pairs.
    pub is_scene: bool,
    /// The pairs.
    pub pairs: Vec<PairRecord>,
}

/// A study to be made.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The configurations, each with its axis.
    pub choices: Vec<Choice>,
    /// Configurations that cannot be generated, with the reason.
    pub left_out: Vec<String>,
    /// The sets of pairs.
    pub sets: Vec<Named>,
    /// The link over which cycles are counted.
    pub link: Description,
    /// The name in reports.
    pub link_name: String,
    /// Seed of pairs and link.
    pub seed: u64,
    /// The family that area is counted for.
    pub target: Target,
    /// True if area is counted.
    pub synthesis: bool,
    /// Neighbours of the front that are added, at most.
    pub neighbours: usize,
    /// The placer's seeds for the points on the front; none: nothing is routed.
    pub placer_seeds: Vec<u32>,
    /// True if a missing program for it is an error, and not only a message.
    pub must_route: bool,
    /// Configurations that are worked on at a time.
    pub jobs: usize,
}

impl Size {
    /// The plan of a study of this size: the full one alone with routes and neighbours, the quick one without areas.
    pub fn plan(self, link: Description, link_name: &str, seed: u64, jobs: usize) -> Plan {
        let (choices, dense, hard) = match self {
            Self::Profiles => (axes::of_profiles(), 20_000, 17_000),
            Self::Quick => (axes::few(), 20_000, 34_000),
            Self::Full => (axes::each_alone(), 300_000, 690_200),
        };
        let (choices, left_out) = axes::possible(choices);
        let named = |set: Set, is_scene| Named { name: set.to_string(), is_scene, pairs: set.pairs(seed) };
        let full = self == Self::Full;
        // Three quarters of a quick study's time would go there.
        let synthesis = self != Self::Quick;
        Plan {
            choices,
            left_out,
            sets: vec![named(Set::Diamond(10), true), named(Set::Dense(dense), true), named(Set::Hard(hard), false)],
            link,
            link_name: link_name.to_owned(),
            seed,
            target: Target::Ecp5,
            synthesis,
            neighbours: if full { 6 } else { 0 },
            placer_seeds: if full { vec![1] } else { Vec::new() },
            must_route: false,
            jobs,
        }
    }
}

impl Plan {
    /// Keeps only the configurations of these profiles.
    pub fn only(&mut self, profiles: &[Profile]) {
        self.choices.retain(|(_, config)| profiles.contains(&config.profile));
        let there = |profile: &&Profile| !self.choices.iter().any(|(_, config)| config.profile == **profile);
        let (more, left_out) = axes::possible(axes::chosen(profiles.iter().filter(there).cloned().collect()));
        self.choices.extend(more);
        self.left_out.extend(left_out);
    }
}
