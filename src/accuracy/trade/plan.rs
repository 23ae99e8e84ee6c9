//! The plan of a study: what it measures.

use super::axes::{self, Choice};
use crate::config::Profile;
use crate::link::{Description, LinkError};
use crate::pairs::Set;
use crate::query::PairRecord;
use crate::synth::Target;
use crate::tools::{MissingTool, Program};
use serde::{Deserialize, Serialize};

/// The family that areas and routes are of.
const TARGET: Target = Target::Ecp5;

/// The extent of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Size {
    /// One configuration per profile, some fifty thousand pairs.
    Profiles,
    /// Some ten configurations, the same number of pairs.
    Quick,
    /// One axis at a time from `wide`, the neighbours of the front, a million pairs, routes.
    Full,
}

/// Pairs on which errors are measured.
#[derive(Clone, Debug)]
pub struct Named {
    /// The set's name.
    pub name: String,
    /// True for the pairs of a scene, whose errors the pictures show; false for hard pairs.
    pub is_scene: bool,
    /// The pairs.
    pub pairs: Vec<PairRecord>,
}

/// The plan of a study.
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
    /// True if the same arithmetic is timed in software on this machine.
    pub software: bool,
}

/// A study that was asked for, as data: all that is needed to find its results in a store.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// The extent of the study.
    pub size: Size,
    /// The profiles that it is limited to; none: all.
    pub profiles: Vec<Profile>,
    /// The link: a name, or a file and its text.
    pub link: (String, Option<String>),
    /// Seed of pairs and link.
    pub seed: u64,
    /// True if area is counted.
    pub synthesis: bool,
    /// Neighbours of the front that are added, at most.
    pub neighbours: usize,
    /// The placer's seeds for the points on the front; none: nothing is routed.
    pub placer_seeds: Vec<u32>,
    /// True if the same arithmetic is timed in software.
    pub software: bool,
    /// The command, for reports.
    pub command: String,
}

impl Request {
    /// The study of this size with its usual extent: the full one alone with routes and neighbours, the quick one
    /// without areas. `link` is a name.
    pub fn new(size: Size, link: &str, seed: u64) -> Self {
        let full = size == Size::Full;
        Self {
            size,
            profiles: Vec::new(),
            link: (link.to_owned(), None),
            seed,
            // Three quarters of a quick study's time would go there.
            synthesis: size != Size::Quick,
            neighbours: if full { 6 } else { 0 },
            placer_seeds: if full { vec![1] } else { Vec::new() },
            software: true,
            command: String::new(),
        }
    }

    /// Leaves out the parts of the study whose programs are missing.
    ///
    /// Returns what was left out, with the command that installs it.
    pub fn without_missing_programs(&mut self) -> Vec<String> {
        let mut left_out = Vec::new();
        if let Err(missing) = self.programs() {
            let has_yosys = Program::yosys().is_ok();
            left_out.push(format!("{}: {missing}", if has_yosys { "place and route" } else { "area and clock" }));
            self.placer_seeds.clear();
            self.synthesis &= has_yosys;
        }
        left_out
    }

    /// The programs that the study needs.
    ///
    /// # Errors
    /// Returns an error if one is missing.
    pub fn programs(&self) -> Result<(), MissingTool> {
        if self.synthesis {
            Program::yosys()?;
        }
        match TARGET.router().filter(|_| !self.placer_seeds.is_empty()) {
            Some((architecture, _)) => Program::nextpnr(architecture).map(|_| ()),
            None => Ok(()),
        }
    }

    /// The plan of the study.
    ///
    /// # Errors
    /// Returns an error if the link is not one.
    pub fn plan(&self) -> Result<Plan, LinkError> {
        let (name, text) = &self.link;
        let link = match text {
            Some(text) => Description::parse(name, text)?,
            None => name.parse()?,
        };
        let (choices, dense, hard) = match self.size {
            Size::Profiles => (axes::of_profiles(), 20_000, 17_000),
            Size::Quick => (axes::few(), 20_000, 34_000),
            Size::Full => (axes::each_alone(), 300_000, 690_200),
        };
        let (choices, left_out) = axes::possible(choices);
        let named = |set: Set, is_scene| Named { name: set.to_string(), is_scene, pairs: set.pairs(self.seed) };
        let mut plan = Plan {
            choices,
            left_out,
            sets: vec![named(Set::Diamond(10), true), named(Set::Dense(dense), true), named(Set::Hard(hard), false)],
            link,
            link_name: name.clone(),
            seed: self.seed,
            target: TARGET,
            synthesis: self.synthesis,
            neighbours: self.neighbours,
            placer_seeds: self.placer_seeds.clone(),
            software: self.software,
        };
        if !self.profiles.is_empty() {
            plan.only(&self.profiles);
        }
        Ok(plan)
    }
}

impl Plan {
    /// Keeps only the configurations of these profiles.
    fn only(&mut self, profiles: &[Profile]) {
        self.choices.retain(|(_, config)| profiles.contains(&config.profile));
        let there = |profile: &&Profile| !self.choices.iter().any(|(_, config)| config.profile == **profile);
        let (more, left_out) = axes::possible(axes::chosen(profiles.iter().filter(there).cloned().collect()));
        self.choices.extend(more);
        self.left_out.extend(left_out);
    }
}
