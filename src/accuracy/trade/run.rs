//! Carries out a study.

use super::axes::{Choice, is_same, name, neighbours};
use super::front::{on_fronts, worth_routing};
use super::stages::Stages;
use super::{Counted, Plan, Point, Study, scene, software};
use crate::accuracy::study::StudyError;
use crate::config::Config;
use crate::link::LinkError;
use crate::report::{folder, manifest};
use crate::store::{Store, StoreError};
use crate::study::{News, PointError, State, Worker};
use crate::synth::SynthError;
use crate::verify::VerifyError;
use serde_json::json;
use std::collections::VecDeque;
use std::mem::replace;
use std::path::Path;
#[cfg(feature = "ode")]
use {
    super::Drift,
    crate::accuracy::{Contender, ContenderError, Profiled},
    crate::store::Key,
    crate::study::Point as Shared,
};

/// Why a study could not be completed.
#[derive(Debug, thiserror::Error)]
pub enum TradeError {
    /// A kernel failed, or the folder cannot be used.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A model could not be built, or a job did not finish.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// A synthesis program failed.
    #[error(transparent)]
    Synth(#[from] SynthError),
    /// The link cannot be modelled at a point's clock.
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

impl PointError for TradeError {
    fn is_of_point(&self) -> bool {
        match self {
            Self::Study(error) => matches!(error, StudyError::Engine(_)),
            Self::Verify(error) => error.is_of_afu(),
            Self::Synth(error) => error.is_of_unit(),
            Self::Link(_) => false,
        }
    }
}

/// The schema of the manifest in a study's folder.
const FOLDER: &str = "contact-afu/accuracy-store/2";

/// The state of a study when a process ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// The results of the points that are measured.
    pub results: Study,
    /// True if the rest of the study depends on points of others that are missing.
    pub is_waiting: bool,
}

/// Prepares a folder for the results of a study.
///
/// # Errors
/// Returns an error if the folder is not ours or holds another study, unless `force`, and an error if it cannot be
/// written.
pub fn prepare(folder: &Path, force: bool) -> Result<(), folder::Error> {
    folder::check_study(folder, FOLDER, force)?;
    folder::create(folder)?;
    let manifest = json!({ "schema": FOLDER, "version": env!("CARGO_PKG_VERSION") });
    folder::replace_json(&folder.join(manifest::NAME), &manifest)
}

/// Measures `plan`, as far as its points are the worker's. What the store holds is not measured again, and everything
/// new is put there. The errors, areas and cycles of all configurations decide which neighbours and routes follow: a
/// shard waits there for the others.
///
/// # Errors
/// Returns an error that other points would meet as well, such as a missing program, and an error if the store cannot
/// be read or written.
pub fn run(plan: &Plan, store: &Store, worker: &mut Worker, tell: impl FnMut(News<'_>)) -> Result<Ended, TradeError> {
    let mut results = Study::new(plan);
    if !plan.synthesis {
        results.left_out.push("areas, and the throughput of a full device: nothing was synthesised".to_owned());
    }
    let mut stages = Stages { plan, store, worker, tell };
    let is_whole = all(&mut stages, &mut results)?;
    let gaps = stages.worker.ledger().iter().filter(|(_, state)| *state == State::Missing);
    results.left_out.extend(gaps.map(|(point, _)| format!("{}: not measured yet", point.title)));
    if !plan.software {
        results.left_out.push("software: nothing was timed on this machine".to_owned());
    } else if is_whole {
        time_software(plan, &mut results);
    }
    Ok(Ended { results, is_waiting: !is_whole })
}

/// One stage after the other. Returns false if points are missing that decide what follows.
fn all<F: FnMut(News<'_>)>(stages: &mut Stages<'_, F>, results: &mut Study) -> Result<bool, TradeError> {
    let plan = stages.plan;
    if !add(stages, &plan.choices, results)? {
        return Ok(false);
    }
    let more = if plan.neighbours > 0 { beside_the_front(plan, results) } else { Vec::new() };
    if !more.is_empty() && !add(stages, &more, results)? {
        return Ok(false);
    }
    if !route(stages, results)? {
        return Ok(false);
    }
    drifts(stages, results)?;
    Ok(true)
}

/// Times software. This is the last step, so that nothing else runs.
fn time_software(plan: &Plan, results: &mut Study) {
    let pairs = plan.sets.iter().rfind(|set| set.is_scene).map_or(&[][..], |set| &set.pairs);
    results.kernels = software::kernels(pairs);
    for point in &mut results.points {
        point.software_ns = software::of_config(&point.config, pairs);
    }
}

/// New configurations one step from those on a front, at most as many as the plan says. Each point on a front gives one
/// in turn.
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

/// Places and routes the points that may be on a front. They are chosen again after each round, because a clock that
/// place and route lowers may bring another point to the front. Each point is tried once, so this terminates.
fn route<F: FnMut(News<'_>)>(stages: &mut Stages<'_, F>, results: &mut Study) -> Result<bool, TradeError> {
    let seeds = &stages.plan.placer_seeds;
    let mut tried: Vec<usize> = Vec::new();
    while !seeds.is_empty() {
        let is_open = |point: &Point| point.hardware.is_some() && point.routed_mhz().is_none();
        let worth = worth_routing(results).into_iter();
        let chosen: Vec<usize> =
            worth.filter(|index| is_open(&results.points[*index]) && !tried.contains(index)).collect();
        if chosen.is_empty() {
            break;
        }
        let configs: Vec<Config> = chosen.iter().map(|&index| results.points[index].config.clone()).collect();
        let costs = stages.costs(&configs.iter().collect::<Vec<_>>(), seeds)?;
        for (&index, cost) in chosen.iter().zip(costs) {
            leave_out(results, cost.missing);
            // If it could not be routed, its earlier figures stay.
            if let (Some(cycles), Some(routed)) = (cost.cycles, cost.hardware) {
                let point = &mut results.points[index];
                let cycles = replace(&mut point.cycles, cycles);
                point.before_routing = point.hardware.replace(routed).map(|hardware| Counted { cycles, hardware });
            }
        }
        if stages.worker.is_missing_any() {
            return Ok(false);
        }
        tried.extend(chosen);
    }
    Ok(true)
}

fn leave_out(results: &mut Study, what: Vec<String>) {
    for what in what {
        if !results.left_out.contains(&what) {
            results.left_out.push(what);
        }
    }
}

/// Measures `choices` and adds the points of those that have errors and cycles. Returns false if others have not
/// measured theirs.
fn add<F: FnMut(News<'_>)>(
    stages: &mut Stages<'_, F>,
    choices: &[Choice],
    results: &mut Study,
) -> Result<bool, TradeError> {
    let configs: Vec<&Config> = choices.iter().map(|(_, config)| config).collect();
    let mut errors = stages.errors(&configs)?;
    let costs = stages.costs(&configs, &[])?;
    let rows = stages.rows(&configs, &mut errors)?;
    for (((axis, config), rows), cost) in choices.iter().zip(rows).zip(costs) {
        leave_out(results, cost.missing);
        let (Some(rows), Some(cycles)) = (rows, cost.cycles) else { continue };
        results.points.push(Point {
            name: name(config),
            axis: (*axis).to_owned(),
            config: config.clone(),
            modelled_mhz: cost.modelled_mhz,
            scpu_cycles: cost.scpu_cycles,
            rtl_sha256: cost.rtl_sha256,
            rows,
            cycles,
            hardware: cost.hardware,
            before_routing: None,
            software_ns: None,
            drift: None,
        });
    }
    Ok(!stages.worker.is_missing_any())
}

/// Measures the drift of the diamond's spheres, once per arithmetic.
#[cfg(feature = "ode")]
fn drifts<F: FnMut(News<'_>)>(stages: &mut Stages<'_, F>, results: &mut Study) -> Result<(), TradeError> {
    let mut arithmetics: Vec<(String, &Config)> = Vec::new();
    for config in results.points.iter().map(|point| &point.config) {
        let name = Profiled::of(config).name();
        if arithmetics.iter().all(|(known, _)| *known != name) {
            arithmetics.push((name, config));
        }
    }
    let mut points = Vec::new();
    for (name, _) in &arithmetics {
        let of = (env!("CARGO_PKG_VERSION"), name, scene::LAYERS, scene::GAP, scene::STEPS);
        points.push(Shared::new(format!("drift of {name}"), Key::new("drift/1", &of)?).beside(name));
    }
    let fail = |error: crate::ode::Error| {
        StudyError::from(ContenderError { contender: "the diamond".to_owned(), error: error.into() })
    };
    let follow = |at: &[usize]| {
        let scene = scene::Scene::new().map_err(fail)?;
        let one = |&index: &usize| Ok(scene.drift(&mut arithmetics[index].1.reference()).map_err(fail)?);
        at.iter().map(one).collect()
    };
    // All at once, so that ODE's own result is computed once.
    let found = stages.measure(points, usize::MAX, follow)?;
    let names = arithmetics.into_iter().map(|(name, _)| name);
    let drifts: Vec<(String, Option<Drift>)> = names.zip(found.values.into_iter().map(Option::flatten)).collect();
    for point in &mut results.points {
        let name = Profiled::of(&point.config).name();
        point.drift = drifts.iter().find(|(known, _)| *known == name).and_then(|(_, drift)| *drift);
    }
    Ok(())
}

#[cfg(not(feature = "ode"))]
fn drifts<F>(_: &mut Stages<'_, F>, results: &mut Study) -> Result<(), TradeError> {
    results.left_out.push(scene::ABSENT.to_owned());
    Ok(())
}
