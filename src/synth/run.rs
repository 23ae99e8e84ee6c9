//! Measures a unit with Yosys and nextpnr.

use super::cells::{area, placed};
use super::figures::{Figures, SCHEMA, Seed, Tools};
use super::names::Source;
use super::route::{Routed, Run};
use super::yosys::{Design, synthesise as cells};
use super::{Area, Placer, SynthError, Target, Trimmed, Unit, floorplan, wrapper};
use crate::store::{Store, sha256};
use crate::tools::Program;

/// How a unit is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The FPGA family.
    pub target: Target,
    /// The placer's seeds. Without seeds, cells are counted and nothing is routed.
    pub seeds: Vec<u32>,
    /// The placer.
    pub placer: Placer,
}

/// Measures a unit; `progress` is called at each step.
///
/// If the target cannot be routed, its cells are counted and there is no clock.
///
/// # Errors
/// Returns [`SynthError::MissingTool`] if a program is missing, and the messages of a program that fails.
pub fn synthesise(unit: &Unit, options: &Options, mut progress: impl FnMut(&str)) -> Result<Figures, SynthError> {
    let target = options.target;
    let router = target.router().filter(|_| !options.seeds.is_empty());
    let yosys = Program::yosys()?;
    let nextpnr = router.map(|(architecture, _)| Program::nextpnr(architecture)).transpose()?;
    let store = kept()?;

    let bench = unit.wrapped()?;
    let files = Unit::files(&bench, target);
    let name = unit.title();
    progress(&format!("{name}: Yosys, {target}"));
    let design = Design { unit: &name, files: &files, top: wrapper::TOP };
    let whole = cells(&yosys, &design, target, &store)?;
    let alone = Unit::wrapper_files(&bench, &unit.module);
    let alone = cells(&yosys, &Design { files: &alone, ..design }, target, &store)?;
    let mut wrapper = area(target, &alone.cells);
    let trimmed = Trimmed::of(&whole.path, &unit.module)?;
    wrapper.ffs = wrapper.ffs.saturating_sub(trimmed.inputs + trimmed.outputs);

    let mut routed: Vec<(u32, Routed)> = Vec::new();
    if let (Some(nextpnr), Some((_, device))) = (&nextpnr, router) {
        let planned = match options.placer {
            Placer::Floorplan => Some(floorplan::planned(&whole, target, &store)?),
            Placer::Heap | Placer::Static => None,
        };
        let netlist = planned.as_ref().unwrap_or(&whole);
        for &seed in &options.seeds {
            progress(&format!("{name}: nextpnr, seed {seed}"));
            let placer = options.placer;
            let run = Run { nextpnr, netlist, target, device, placer, seed, unit: &name };
            routed.push((seed, run.route(&store)?));
        }
    }
    let seeds = routed.iter().map(|(seed, run)| Seed { seed: *seed, clock_mhz: run.clock_mhz }).collect();
    routed.sort_by(|(_, a), (_, b)| a.clock_mhz.total_cmp(&b.clock_mhz));
    // Of an even number of seeds, the lower one of the middle two: a clock that some seed reached.
    let median = routed.get(routed.len().saturating_sub(1) / 2).map(|(_, run)| run);
    let occupied: Option<Area> = median.and_then(|run| placed(target, &run.used));
    let clock_mhz = median.map(|run| run.clock_mhz);
    Ok(Figures {
        schema: SCHEMA.to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        unit: unit.name.clone(),
        profile: unit.profile.clone(),
        architecture: unit.architecture,
        interval: unit.interval,
        module: unit.module.name.clone(),
        target,
        placer: median.map(|_| options.placer),
        asked_mhz: unit.clock_mhz,
        modelled_mhz: unit.modelled_mhz(),
        clock_mhz,
        latency_cycles: unit.latency,
        latency_ns: clock_mhz.zip(unit.latency).map(|(clock, cycles)| 1000.0 * f64::from(cycles) / clock),
        area: occupied.unwrap_or_else(|| area(target, &whole.cells)) - wrapper,
        wrapper,
        trimmed,
        seeds,
        critical: median.map(|run| Source::new(&bench, &files).tell(&run.path)).unwrap_or_default(),
        verilog_sha256: sha256_of(&files),
        tools: Tools {
            yosys: yosys.version().to_owned(),
            nextpnr: nextpnr.map(|program| program.version().to_owned()),
        },
    })
}

/// The store of netlists and routes.
pub(super) fn kept() -> Result<Store, SynthError> {
    Ok(Store::of_user("synth")?)
}

/// SHA-256 of the texts of files.
pub(super) fn sha256_of(files: &[(String, String)]) -> String {
    let part = |(_, text): &(String, String)| [&(text.len() as u64).to_le_bytes()[..], text.as_bytes()].concat();
    sha256(&files.iter().flat_map(part).collect::<Vec<_>>())
}
