//! The costs of configurations: several are worked on at a time.

use super::axes::name;
use super::cost::{Cycles, Hardware, cycles, cycles_hash, hardware, hardware_hash};
use super::run::{ROUTE_SECONDS, cost_seconds};
use super::{Plan, TradeError, Work};
use crate::config::Config;
use crate::store::{Key, Store};
use crate::synth::{SynthError, Unit};
use crate::verify::{Bench, rtl_sha256};
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;

/// The measured figures of a configuration's hardware.
pub(super) struct Cost {
    pub rtl_sha256: String,
    pub scpu_cycles: u32,
    pub modelled_mhz: f64,
    pub cycles: Cycles,
    pub hardware: Option<Hardware>,
    pub missing: Option<String>,
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

/// The messages of workers.
enum News {
    Begun(String),
    Ended(usize, Box<Result<Cost, TradeError>>),
}

/// The cost of each configuration, `plan.jobs` of them at a time.
pub(super) fn costs(
    plan: &Plan,
    configs: &[&Config],
    seeds: &[u32],
    store: &Store,
    progress: &mut impl FnMut(Work),
) -> Result<Vec<Cost>, TradeError> {
    let open: Mutex<VecDeque<usize>> = Mutex::new((0..configs.len()).collect());
    let next = || open.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
    let stop = || open.lock().unwrap_or_else(PoisonError::into_inner).clear();
    let mut costs: Vec<Option<Cost>> = configs.iter().map(|_| None).collect();
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..plan.jobs.clamp(1, configs.len().max(1)) {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                while let Some(index) = next() {
                    let tell = |news| drop(sender.send(news)); // nobody listens any more: nothing to tell
                    let cost = cost(plan, configs[index], seeds, store, &tell);
                    tell(News::Ended(index, Box::new(cost)));
                }
            });
        }
        drop(sender);
        for news in receiver {
            match news {
                News::Begun(what) => progress(Work::Begun(what)),
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

fn cost(plan: &Plan, config: &Config, seeds: &[u32], store: &Store, tell: &impl Fn(News)) -> Result<Cost, TradeError> {
    let rtl_sha256 = rtl_sha256(config)?;
    let unit = Unit::scpu(config)?;
    let modelled_mhz = unit.modelled_mhz().unwrap_or(config.clock_mhz).min(config.clock_mhz);
    let scpu_cycles = unit.latency.unwrap_or_default();

    let version = env!("CARGO_PKG_VERSION");
    let hash = hardware_hash(&rtl_sha256, plan, seeds);
    let key = Key::new("hardware/1", &(version, &hash))?;
    let mut missing = None;
    let hardware = match store.get(&key)? {
        Some(kept) => Some(kept),
        None if !plan.synthesis => None,
        None => match hardware(config, plan, seeds, hash, |what| tell(News::Begun(what.to_owned()))) {
            Ok(made) => {
                store.put(&key, &made)?;
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
    let hash = cycles_hash(&rtl_sha256, pairs, &link, plan.seed);
    let cycles = store.get_or_make(&Key::new("cycles/1", &(version, &hash))?, || {
        tell(News::Begun(format!("{}: cosim", name(config))));
        Ok::<_, TradeError>(cycles(&Bench::new(config)?, pairs, &link, plan.seed, hash.clone())?)
    })?;
    Ok(Cost { rtl_sha256, scpu_cycles, modelled_mhz, cycles, hardware, missing })
}
