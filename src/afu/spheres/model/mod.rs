//! A model of the search that counts cycles: what moves from queue to queue, without its bits. It says how fast a
//! configuration finds what touches in given sets over a link, without simulating the Verilog.

mod item;
mod port;
mod stages;
mod takers;

use self::item::{Hits, item};
use self::port::Port;
use self::stages::run;
use self::takers::Takers;
use super::{ROW, Sizes};
use crate::afu::Spec;
use crate::afu::generate::decision;
use crate::config::{self, Config};
use crate::hdl::BuildErrors;
use crate::kernel::EngineError;
use crate::link::{LinkError, LinkModel};
use crate::query::Fields;
use crate::spheres::{RefusedArithmetic, RowTrace, Search, Spheres};

/// Cycles that a search takes, and the steps of its stages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Predicted {
    /// Cycles, loading and draining counted.
    pub cycles: u64,
    /// The name of each stage, and the cycles in which it makes a step.
    pub stages: Vec<(&'static str, u64)>,
    /// The cycles that the link needs at least.
    pub link_cycles: u64,
}

impl Predicted {
    /// The stage with the most steps, or the link.
    pub fn slowest(&self) -> &'static str {
        let stages = self.stages.iter().copied().chain([("link", self.link_cycles)]);
        stages.max_by_key(|(_, steps)| *steps).map_or("", |(name, _)| name)
    }
}

/// Why there is no prediction.
#[derive(Debug, thiserror::Error)]
pub enum PredictError {
    /// The arithmetic, or the bits of a box.
    #[error(transparent)]
    Refused(#[from] RefusedArithmetic),
    /// The kernel that decides could not be generated.
    #[error("the generated kernel is faulty:\n{0}")]
    Kernel(#[from] BuildErrors),
    /// The reference that decides failed.
    #[error("the reference kernel: {0}")]
    Reference(EngineError),
    /// The link is not one.
    #[error(transparent)]
    Link(#[from] LinkError),
}

/// A job of spheres, whose cycles are predicted for hardware of any size.
#[derive(Debug)]
pub struct SearchModel {
    rows: Vec<RowTrace>,
    hits: Hits,
    /// Rows of a first set, which are loaded and not searched.
    before: u64,
    box_bits: u32,
    candidates: u64,
}

impl SearchModel {
    /// The job of these sets, in the arithmetic and with the boxes of a configuration.
    ///
    /// # Errors
    /// Returns an error if the arithmetic has no boxes, or if its reference fails.
    pub fn new(config: &Config, sets: &Spheres) -> Result<Self, PredictError> {
        let box_bits = config.search.box_bits;
        let search = Search::new(config.profile.arithmetic(), box_bits)?;
        let second = sets.second.as_deref();
        let found = search.find(&mut config.profile.reference(Fields::HIT), &sets.first, second);
        let found = found.map_err(PredictError::Reference)?;
        let mut hits = Hits::new();
        let row = ROW as usize;
        for hit in found.hits {
            let [first, second] = hit.spheres.map(|number| number as usize);
            *hits.entry((first / row, second / row, second % row)).or_default() += 1;
        }
        let before = if second.is_some() { sets.first.len().div_ceil(row) as u64 } else { 0 };
        let candidates = found.counts.candidates;
        Ok(Self { rows: search.trace(&sets.first, second), hits, before, box_bits, candidates })
    }

    /// Pairs whose boxes meet.
    pub fn candidates(&self) -> u64 {
        self.candidates
    }

    /// Pairs that touch.
    pub fn contacts(&self) -> u64 {
        self.hits.values().sum()
    }

    /// The cycles that this takes over a link in a configuration with such boxes, from start to done at the line port.
    ///
    /// # Errors
    /// Returns an error if the configuration has no search, or if the link is not one.
    pub fn predict(&self, config: &Config, link: &LinkModel) -> Result<Predicted, PredictError> {
        let search = config::Search { box_bits: self.box_bits, ..config.search };
        let sizes = Sizes::of(&Config { search, ..config.clone() })?;
        let spec = Spec::from(config.clone());
        let rows = self.rows.iter().enumerate().map(|(row, trace)| item(&sizes, row, trace, &self.hits)).collect();
        let (takers, room) = Takers::of(&spec, &sizes)?;
        let lines = (self.before + self.rows.len() as u64) * u64::from(ROW) / Port::PER_LINE;
        let mut port = Port::new(&spec, link, lines, room)?;
        let decision = decision(&spec, false)?.latency.into();
        let (cycles, stages) = run(&sizes, self.before, rows, takers, &mut port, decision);
        let written = spec.layout().destination_lines(self.contacts());
        Ok(Predicted { cycles, stages, link_cycles: link.limit_cycles(lines, written).ceil() as u64 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Input, Results};
    use crate::link::Fault;
    use crate::spheres::SphereSet;

    fn cycles(sets: &Spheres, link: &LinkModel) -> u64 {
        let search = config::Search { table: 2048, ..config::Search::default() };
        let (contact, results) = (Fields::HIT, Results::Hits);
        let config = Config { input: Input::Spheres, search, contact, results, scpus: 1, ..Config::default() };
        SearchModel::new(&config, sets).expect("boxes").predict(&config, link).expect("a prediction").cycles
    }

    fn gas() -> Spheres {
        "gas:200:0.3".parse::<SphereSet>().expect("a set").spheres(1)
    }

    /// A link whose response is lost once kept the model waiting for ever.
    #[test]
    fn faults_of_a_link_are_no_part_of_a_prediction() {
        let ideal = LinkModel::ideal();
        let faults = vec![Fault::ReadLost(3), Fault::WriteLost(0), Fault::ReadTwice(1)];
        assert_eq!(cycles(&gas(), &LinkModel { faults, ..ideal.clone() }), cycles(&gas(), &ideal));
    }

    #[test]
    fn a_first_set_is_loaded_even_if_the_second_is_empty() {
        let sets = Spheres { second: Some(Vec::new()), ..gas() };
        assert!((200..300).contains(&cycles(&sets, &LinkModel::ideal())));
        assert!(cycles(&Spheres::default(), &LinkModel::ideal()) < 100);
    }
}
