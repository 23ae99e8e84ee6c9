//! A study, carried out.

use super::axes::{Choice, is_same, name, neighbours};
use super::cost::{Cycles, Hardware, cycles, cycles_key, hardware, hardware_key};
use super::front::{on_fronts, worth_routing};
use super::results::Store;
use super::software;
use super::{Counted, Plan, Point, ResultsError, Study};
use crate::accuracy::{ContenderError, Contenders, Profiled, Row, measure};
use crate::config::Config;
use crate::link::LinkError;
use crate::synth::{SynthError, Unit};
use crate::verify::{Bench, VerifyError, rtl_sha256};
use std::collections::VecDeque;
use std::mem::{replace, take};
use std::path::Path;
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;

/// Why a study did not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum TradeError {
    /// A kernel failed.
    #[error(transparent)]
    Engine(#[from] ContenderError),
    /// No model, or no end of a job.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// A synthesis program refused.
    #[error(transparent)]
    Synth(#[from] SynthError),
    /// The link cannot be at a point's clock.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The store of results.
    #[error(transparent)]
    Results(#[from] ResultsError),
}

/// A piece of work done, for progress. How long a piece takes is guessed, in seconds of one processor where nothing is
/// known yet: only the shares count.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// So many seconds of work more; or less, where there turns out to be less to do.
    Planned(f64),
    /// Something begins.
    Begun(String),
    /// So many of them are done.
    Done(f64),
    /// A configuration's times and area are known: a line on it.
    Configuration(String),
}

/// Guesses: a pair's answer and its judgement; a model; a netlist; place and route.
const PAIR_SECONDS: f64 = 5e-6;
const MODEL_SECONDS: f64 = 25.0;
const NETLIST_SECONDS: f64 = 45.0;
const ROUTE_SECONDS: f64 = 600.0;
/// The diamond, and software on this machine: a configuration each.
const DRIFT_SECONDS: f64 = 0.5;
const SOFTWARE_SECONDS: f64 = 0.5;
/// Points on fronts, before any is known.
const ON_FRONTS: f64 = 8.0;
/// Arithmetics that answer a set before their rows are kept: the truth about the set is found anew for each so many.
const AT_ONCE: usize = 16;

/// A guess at the seconds of so many configurations.
fn seconds(plan: &Plan, configs: usize) -> f64 {
    let pairs: usize = plan.sets.iter().map(|set| set.pairs.len()).sum();
    configs as f64 * (cost_seconds(plan) + PAIR_SECONDS * pairs as f64)
}

/// A guess at the seconds of a configuration without routes and errors.
fn cost_seconds(plan: &Plan) -> f64 {
    MODEL_SECONDS + if plan.synthesis { NETLIST_SECONDS } else { 0.0 }
}

/// Measures `plan`. What `folder` (taken even if it is not ours with `true`) holds from an earlier run is not measured
/// again, and everything new is put there as it comes.
///
/// # Errors
/// When a program refuses, a job does not end, or the folder is not ours or cannot be written. A missing synthesis
/// program is no error: the results say so.
pub fn run(plan: &Plan, folder: Option<(&Path, bool)>, mut progress: impl FnMut(Work)) -> Result<Study, TradeError> {
    let mut store = Store::open(folder)?;
    let mut results = Study::new(plan);
    if !plan.synthesis {
        results.left_out.push("areas, and the throughput of a full device: nothing was synthesised".to_owned());
    }
    let routes = ON_FRONTS * ROUTE_SECONDS * plan.placer_seeds.len() as f64;
    progress(Work::Planned(seconds(plan, plan.choices.len() + plan.neighbours) + routes));
    add(plan, &plan.choices, &mut results, &mut store, &mut progress)?;
    if plan.neighbours > 0 {
        let more = beside_the_front(plan, &results);
        progress(Work::Planned(seconds(plan, more.len()) - seconds(plan, plan.neighbours)));
        add(plan, &more, &mut results, &mut store, &mut progress)?;
    }
    route(plan, routes, &mut results, &mut store, &mut progress)?;
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
    let fail = |error: crate::ode::Error| ContenderError { contender: "the diamond".to_owned(), error: error.into() };
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
    store: &mut Store,
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
            // Where it could not be routed, what was known of it stays.
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
    store: &mut Store,
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
    store: &mut Store,
    progress: &mut impl FnMut(Work),
) -> Result<Vec<Vec<Row>>, TradeError> {
    let contender = |config: &Config| Profiled::over(&config.profile, config.record);
    // The clock changes no bit: an arithmetic answers once.
    let mut contenders = Contenders::new();
    let mut names: Vec<String> = Vec::new();
    for config in configs {
        let contender = contender(config);
        if !names.contains(&contender.title()) {
            names.push(contender.title());
            contenders.push(Box::new(contender));
        }
    }
    let mut found: Vec<Vec<Row>> = vec![Vec::new(); configs.len()];
    for set in &plan.sets {
        progress(Work::Begun(format!("errors on {}", set.name)));
        let mut rows = Vec::new();
        for some in contenders.chunks_mut(AT_ONCE) {
            let (of_some, _) = measure(&set.name, &set.pairs, some, &store.rows, |_| {})?;
            let is_new = |row: &&Row| !store.rows.iter().any(|known| known.key == row.key);
            let new: Vec<Row> = of_some.iter().filter(is_new).cloned().collect();
            store.rows.extend(new);
            store.save()?;
            rows.extend(of_some);
        }
        for (config, found) in configs.iter().zip(&mut found) {
            let name = contender(config).title();
            found.extend(rows.iter().find(|row| row.contender == name).cloned());
        }
        progress(Work::Done(PAIR_SECONDS * (set.pairs.len() * configs.len()) as f64));
    }
    Ok(found)
}

/// What was measured of a configuration's hardware.
struct Cost {
    rtl_sha256: String,
    scpu_cycles: u32,
    modelled_mhz: f64,
    cycles: Cycles,
    hardware: Option<Hardware>,
    missing: Option<String>,
}

impl Cost {
    fn line(&self, name: &str) -> String {
        let mut line = format!("{name}: {} cycles, line in to line out", self.cycles.lone);
        if let Some(hardware) = &self.hardware {
            line += &format!(", {} LUTs", hardware.area.luts);
            line += &hardware.routed_mhz.map_or_else(String::new, |clock| format!(", {clock:.0} MHz after routing"));
        }
        line
    }
}

/// What workers tell.
enum News {
    Begun(String),
    Cycles(Cycles),
    Hardware(Hardware),
    Ended(usize, Box<Result<Cost, TradeError>>),
}

/// The cost of each configuration, `plan.jobs` of them at a time.
fn costs(
    plan: &Plan,
    configs: &[&Config],
    seeds: &[u32],
    store: &mut Store,
    progress: &mut impl FnMut(Work),
) -> Result<Vec<Cost>, TradeError> {
    let open: Mutex<VecDeque<usize>> = Mutex::new((0..configs.len()).collect());
    let next = || open.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
    let stop = || open.lock().unwrap_or_else(PoisonError::into_inner).clear();
    let known = (store.cycles.clone(), store.hardware.clone());
    let mut costs: Vec<Option<Cost>> = configs.iter().map(|_| None).collect();
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..plan.jobs.clamp(1, configs.len().max(1)) {
            let (sender, known, next) = (sender.clone(), &known, &next);
            scope.spawn(move || {
                while let Some(index) = next() {
                    let tell = |news| drop(sender.send(news)); // nobody listens any more: nothing to tell
                    let cost = cost(plan, configs[index], seeds, known, &tell);
                    tell(News::Ended(index, Box::new(cost)));
                }
            });
        }
        drop(sender);
        for news in receiver {
            match news {
                News::Begun(what) => progress(Work::Begun(what)),
                News::Cycles(cycles) => {
                    store.cycles.push(cycles);
                    store.save().inspect_err(|_| stop())?;
                }
                News::Hardware(hardware) => {
                    store.hardware.push(hardware);
                    store.save().inspect_err(|_| stop())?;
                }
                News::Ended(index, cost) => {
                    let cost = (*cost).inspect_err(|_| stop())?;
                    progress(Work::Configuration(cost.line(&name(configs[index]))));
                    costs[index] = Some(cost);
                    progress(Work::Done(if seeds.is_empty() {
                        cost_seconds(plan)
                    } else {
                        ROUTE_SECONDS * seeds.len() as f64
                    }));
                }
            }
        }
        Ok::<_, TradeError>(())
    })?;
    Ok(costs.into_iter().flatten().collect())
}

fn cost(
    plan: &Plan,
    config: &Config,
    seeds: &[u32],
    (known_cycles, known_hardware): &(Vec<Cycles>, Vec<Hardware>),
    tell: &impl Fn(News),
) -> Result<Cost, TradeError> {
    let rtl_sha256 = rtl_sha256(config)?;
    let unit = Unit::scpu(config)?;
    let modelled_mhz = unit.modelled_mhz().unwrap_or(config.clock_mhz).min(config.clock_mhz);
    let scpu_cycles = unit.latency.unwrap_or_default();

    let key = hardware_key(&rtl_sha256, plan, seeds);
    let mut missing = None;
    let kept = known_hardware.iter().find(|hardware| hardware.key == key).cloned();
    let hardware = match kept {
        Some(kept) => Some(kept),
        None if !plan.synthesis => None,
        None => match hardware(config, plan, seeds, key, |what| tell(News::Begun(what.to_owned()))) {
            Ok(made) => {
                tell(News::Hardware(made.clone()));
                Some(made)
            }
            Err(SynthError::MissingTool(tool)) if seeds.is_empty() => {
                missing = Some(format!("area and clock: {tool}"));
                None
            }
            Err(SynthError::MissingTool(tool)) if !plan.must_route => {
                missing = Some(format!("place and route: {tool}"));
                None
            }
            // One that a program refuses leaves the others their figures.
            Err(error @ SynthError::Failed { .. }) => {
                let what = if seeds.is_empty() { "area and clock" } else { "place and route" };
                let text = error.to_string();
                missing = Some(format!("{what} of {}: {}", name(config), text.lines().next().unwrap_or_default()));
                None
            }
            Err(error) => return Err(error.into()),
        },
    };
    let clock = hardware.as_ref().and_then(|hardware| hardware.routed_mhz).unwrap_or(modelled_mhz);
    let link = plan.link.at(clock)?;
    let pairs = plan.sets.first().map_or(&[][..], |set| &set.pairs);
    let key = cycles_key(&rtl_sha256, pairs, &link, plan.seed);
    let cycles = match known_cycles.iter().find(|cycles| cycles.key == key) {
        Some(kept) => kept.clone(),
        None => {
            tell(News::Begun(format!("{}: cosim", name(config))));
            let made = cycles(&Bench::new(config)?, pairs, &link, plan.seed, key)?;
            tell(News::Cycles(made.clone()));
            made
        }
    };
    Ok(Cost { rtl_sha256, scpu_cycles, modelled_mhz, cycles, hardware, missing })
}
