//! A study, carried out.

use super::axes::{Choice, is_same, name, neighbours};
use super::front::{on_fronts, worth_routing};
use super::software;
use super::workers::costs;
use super::{Counted, Plan, Point, Study};
use crate::accuracy::study::{self, StudyError};
use crate::accuracy::{Contender, Contenders, Profiled, Row, measure};
use crate::config::Config;
use crate::link::LinkError;
use crate::query::Query;
use crate::report::{folder, manifest};
use crate::store::{Store, StoreError};
use crate::synth::SynthError;
use crate::verify::VerifyError;
use serde_json::json;
use std::collections::VecDeque;
use std::mem::{replace, take};
use std::path::Path;

/// Why a study was not completed.
#[derive(Debug, thiserror::Error)]
pub enum TradeError {
    /// A kernel failed, or the folder cannot be used.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// No model, or no end of a job.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// A synthesis program refused.
    #[error(transparent)]
    Synth(#[from] SynthError),
    /// The link cannot be at a point's clock.
    #[error(transparent)]
    Link(#[from] LinkError),
}

impl From<StoreError> for TradeError {
    fn from(error: StoreError) -> Self {
        StudyError::from(error).into()
    }
}

impl From<folder::Error> for TradeError {
    fn from(error: folder::Error) -> Self {
        StudyError::from(error).into()
    }
}

/// The schema of the manifest in a study's folder.
const FOLDER: &str = "contact-afu/accuracy-store/2";

/// A piece of work done, for progress. How long a piece takes is guessed, in seconds of one processor where nothing is
/// known yet: only the shares count.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// The estimate of the work changed by this number of seconds, up or down.
    Planned(f64),
    /// Something begins.
    Begun(String),
    /// This number of seconds of it is done.
    Done(f64),
    /// A configuration's times and area are known: a line on it.
    Configuration(String),
}

/// Guesses: a pair's answer and its judgement; a model; a netlist; place and route.
const PAIR_SECONDS: f64 = 5e-6;
const MODEL_SECONDS: f64 = 25.0;
const NETLIST_SECONDS: f64 = 45.0;
pub(super) const ROUTE_SECONDS: f64 = 600.0;
/// The diamond, and software on this machine: a configuration each.
const DRIFT_SECONDS: f64 = 0.5;
const SOFTWARE_SECONDS: f64 = 0.5;
/// Points on fronts, before any is known.
const ON_FRONTS: f64 = 8.0;
/// Arithmetics that answer a set before their rows are kept: the truth about the set is found anew for each so many.
const AT_ONCE: usize = 16;

/// An estimate of the seconds that this number of configurations takes.
fn seconds(plan: &Plan, configs: usize) -> f64 {
    let pairs: usize = plan.sets.iter().map(|set| set.pairs.len()).sum();
    configs as f64 * (cost_seconds(plan) + PAIR_SECONDS * pairs as f64)
}

/// A guess at the seconds of a configuration without routes and errors.
pub(super) fn cost_seconds(plan: &Plan) -> f64 {
    MODEL_SECONDS + if plan.synthesis { NETLIST_SECONDS } else { 0.0 }
}

/// Measures `plan`. What `folder` (taken even if it is not ours with `true`) holds from an earlier run is not measured
/// again, and everything new is put there as it comes.
///
/// # Errors
/// Returns an error if a program refuses, a job does not end, or the folder is not ours or cannot be written. A missing
/// synthesis program is no error: the results say so.
pub fn run(plan: &Plan, folder: Option<(&Path, bool)>, mut progress: impl FnMut(Work)) -> Result<Study, TradeError> {
    let store = &study::open(folder, FOLDER)?;
    if let Some((folder, _)) = folder {
        folder::create(folder)?;
        let manifest = json!({ "schema": FOLDER, "version": env!("CARGO_PKG_VERSION") });
        folder::replace_json(&folder.join(manifest::NAME), &manifest)?;
    }
    let mut results = Study::new(plan);
    if !plan.synthesis {
        results.left_out.push("areas, and the throughput of a full device: nothing was synthesised".to_owned());
    }
    let routes = ON_FRONTS * ROUTE_SECONDS * plan.placer_seeds.len() as f64;
    progress(Work::Planned(seconds(plan, plan.choices.len() + plan.neighbours) + routes));
    add(plan, &plan.choices, &mut results, store, &mut progress)?;
    if plan.neighbours > 0 {
        let more = beside_the_front(plan, &results);
        progress(Work::Planned(seconds(plan, more.len()) - seconds(plan, plan.neighbours)));
        add(plan, &more, &mut results, store, &mut progress)?;
    }
    route(plan, routes, &mut results, store, &mut progress)?;
    let (drifts, timings) =
        (DRIFT_SECONDS * results.points.len() as f64, SOFTWARE_SECONDS * results.points.len() as f64);
    progress(Work::Planned(drifts + timings));
    progress(Work::Begun("the diamond".to_owned()));
    drift(&mut results)?;
    progress(Work::Done(drifts));
    // Last of all, when nothing else runs.
    progress(Work::Begun("software".to_owned()));
    let pairs = plan.sets.iter().rfind(|set| set.is_scene).map_or(&[][..], |set| &set.pairs);
    results.kernels = software::kernels(pairs);
    for point in &mut results.points {
        point.software_ns = software::of_config(&point.config, pairs);
    }
    progress(Work::Done(timings));
    Ok(results)
}

/// Where each arithmetic leads the diamond's spheres: an arithmetic once.
#[cfg(feature = "ode")]
fn drift(results: &mut Study) -> Result<(), TradeError> {
    let fail = |error: crate::ode::Error| {
        StudyError::from(crate::accuracy::ContenderError { contender: "the diamond".to_owned(), error: error.into() })
    };
    let scene = super::scene::Scene::new().map_err(fail)?;
    for index in 0..results.points.len() {
        let (known, rest) = results.points.split_at_mut(index);
        let Some(point) = rest.first_mut() else { break };
        let mut reference = point.config.reference();
        point.drift = match known.iter().find(|known| known.config.reference() == reference) {
            Some(known) => known.drift,
            None => scene.drift(&mut reference).map_err(fail)?,
        };
    }
    Ok(())
}

#[cfg(not(feature = "ode"))]
fn drift(results: &mut Study) -> Result<(), TradeError> {
    results.left_out.push(super::scene::ABSENT.to_owned());
    Ok(())
}

/// Configurations a step from those on a front that are not there yet: as many as the plan has, those of each in turn.
fn beside_the_front(plan: &Plan, results: &Study) -> Vec<Choice> {
    let mut around: Vec<VecDeque<Choice>> =
        on_fronts(results).into_iter().map(|index| neighbours(&results.points[index].config).into()).collect();
    let there = |choices: &[Choice], config: &Config| choices.iter().any(|(_, other)| is_same(other, config));
    let mut more: Vec<Choice> = Vec::new();
    while more.len() < plan.neighbours && around.iter().any(|choices| !choices.is_empty()) {
        for choice in around.iter_mut().filter_map(VecDeque::pop_front) {
            let is_new = !there(&plan.choices, &choice.1) && !there(&more, &choice.1) && choice.1.check().is_ok();
            if is_new && more.len() < plan.neighbours {
                more.push(choice);
            }
        }
    }
    more
}

/// Places and routes the points that fronts may be drawn through. Which are worth it is looked anew after each round: a
/// clock that place and route lowers may bring another point there. Each is tried once, so that comes to an end.
fn route(
    plan: &Plan,
    mut guessed: f64,
    results: &mut Study,
    store: &Store,
    progress: &mut impl FnMut(Work),
) -> Result<(), TradeError> {
    let seeds = &plan.placer_seeds;
    let mut tried: Vec<usize> = Vec::new();
    while !seeds.is_empty() {
        let is_open = |point: &Point| point.hardware.is_some() && point.routed_mhz().is_none();
        let worth = worth_routing(results).into_iter();
        let chosen: Vec<usize> =
            worth.filter(|index| is_open(&results.points[*index]) && !tried.contains(index)).collect();
        if chosen.is_empty() {
            break;
        }
        progress(Work::Planned(ROUTE_SECONDS * (chosen.len() * seeds.len()) as f64 - take(&mut guessed)));
        let configs: Vec<Config> = chosen.iter().map(|&index| results.points[index].config.clone()).collect();
        let costs = costs(plan, &configs.iter().collect::<Vec<_>>(), seeds, store, progress)?;
        for (&index, cost) in chosen.iter().zip(costs) {
            results.left_out.extend(cost.missing.filter(|missing| !results.left_out.contains(missing)));
            // If it could not be routed, its earlier figures stay.
            if let Some(routed) = cost.hardware {
                let point = &mut results.points[index];
                let cycles = replace(&mut point.cycles, cost.cycles);
                point.before_routing = point.hardware.replace(routed).map(|hardware| Counted { cycles, hardware });
            }
        }
        tried.extend(chosen);
    }
    progress(Work::Planned(-guessed));
    Ok(())
}

/// Measures `choices` and adds their points.
fn add(
    plan: &Plan,
    choices: &[Choice],
    results: &mut Study,
    store: &Store,
    progress: &mut impl FnMut(Work),
) -> Result<(), TradeError> {
    let configs: Vec<&Config> = choices.iter().map(|(_, config)| config).collect();
    let rows = errors(plan, &configs, store, progress)?;
    let costs = costs(plan, &configs, &[], store, progress)?;
    for (((axis, config), rows), cost) in choices.iter().zip(rows).zip(costs) {
        results.left_out.extend(cost.missing.filter(|missing| !results.left_out.contains(missing)));
        results.points.push(Point {
            name: name(config),
            axis: (*axis).to_owned(),
            config: config.clone(),
            modelled_mhz: cost.modelled_mhz,
            scpu_cycles: cost.scpu_cycles,
            rtl_sha256: cost.rtl_sha256,
            rows,
            cycles: cost.cycles,
            hardware: cost.hardware,
            before_routing: None,
            software_ns: None,
            drift: None,
        });
    }
    Ok(())
}

/// The rows of each configuration: the errors of its arithmetic on each set.
fn errors(
    plan: &Plan,
    configs: &[&Config],
    store: &Store,
    progress: &mut impl FnMut(Work),
) -> Result<Vec<Vec<Row>>, TradeError> {
    let contender = |config: &Config| Profiled::of(config);
    // The clock changes no bit: an arithmetic answers once.
    let mut contenders = Contenders::new();
    let mut names: Vec<String> = Vec::new();
    for config in configs {
        let contender = contender(config);
        if !names.contains(&contender.name()) {
            names.push(contender.name());
            contenders.push(Box::new(contender));
        }
    }
    let mut found: Vec<Vec<Row>> = vec![Vec::new(); configs.len()];
    for set in &plan.sets {
        progress(Work::Begun(format!("errors on {}", set.name)));
        let mut rows = Vec::new();
        for some in contenders.chunks_mut(AT_ONCE) {
            rows.extend(measure(Query::SphereSphere, &set.name, &set.pairs, some, store, |_| {})?.0);
        }
        for (config, found) in configs.iter().zip(&mut found) {
            let name = contender(config).name();
            found.extend(rows.iter().find(|row| row.contender == name).cloned());
        }
        progress(Work::Done(PAIR_SECONDS * (set.pairs.len() * configs.len()) as f64));
    }
    Ok(found)
}
