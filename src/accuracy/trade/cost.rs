//! The cost of a configuration: cycles by co-simulation, area and clock by synthesis.

use super::plan::Plan;
use crate::accuracy::measure::with_pairs;
use crate::config::Config;
use crate::link::LinkModel;
use crate::query::PairRecord;
use crate::report::tally::Tally;
use crate::store::sha256;
use crate::synth::{Area, Figures, Options, Placer, SynthError, Unit, synthesise};
use crate::verify::{Bench, VerifyError};
use serde::{Deserialize, Serialize};

/// Cycles of an AFU, each counted by simulating its Verilog.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cycles {
    /// Hash of the simulated Verilog, link and clock.
    pub key: String,
    /// Latency of a single pair, from its line in to its contact's line out, over the link `ideal`.
    pub lone: u64,
    /// Cycles per pair over the link `ideal`: the throughput of one SCPU.
    pub compute: f64,
    /// Cycles per pair over the link of the study, at the clock of the point.
    pub link: f64,
    /// The link limit in cycles per pair.
    pub link_limit: f64,
    /// Records that differ from the reference kernel's, and other checks that failed. Unless it is 0, the other figures
    /// are invalid.
    pub mismatches: u64,
}

/// Counts the cycles of an AFU for a single pair, and for `pairs` over the link `ideal` and over `link`.
///
/// # Errors
/// Returns an error if a job does not end.
pub fn cycles(
    bench: &Bench,
    pairs: &[PairRecord],
    link: &LinkModel,
    seed: u64,
    key: String,
) -> Result<Cycles, VerifyError> {
    let mut mismatches = 0;
    let mut tally = |pairs: &[PairRecord], link: &LinkModel| {
        let verdict = bench.run(pairs, link, seed)?;
        mismatches += (verdict.mismatches.len() + verdict.failed_checks.len()) as u64;
        Ok::<_, VerifyError>(Tally::of(&verdict, bench.config()))
    };
    let ideal = LinkModel::ideal();
    let lone = tally(&pairs[..pairs.len().min(1)], &ideal)?;
    let alone = tally(pairs, &ideal)?;
    let linked = tally(pairs, link)?;
    Ok(Cycles {
        key,
        lone: lone.latency_cycles.unwrap_or_default(),
        compute: alone.cycles_per_pair().unwrap_or_default(),
        link: linked.cycles_per_pair().unwrap_or_default(),
        link_limit: linked.limit_per_pair().unwrap_or_default(),
        mismatches,
    })
}

/// The hash of everything that affects [`Cycles`].
pub(super) fn cycles_hash(rtl: &str, pairs: &[PairRecord], link: &LinkModel, seed: u64) -> String {
    // A link consists of plain values, so it can be written as JSON.
    let link = serde_json::to_string(link).unwrap_or_default();
    with_pairs(format!("cycles 1 {rtl} {link} {seed} "), pairs)
}

/// The area and clock of an SCPU on an FPGA.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hardware {
    /// Hash of the synthesised Verilog and the options.
    pub key: String,
    /// Its area.
    pub area: Area,
    /// The clock after place and route, MHz; `None` if cells were only counted.
    pub routed_mhz: Option<f64>,
}

/// The hash of everything that affects [`Hardware`].
pub(super) fn hardware_hash(rtl: &str, plan: &Plan, seeds: &[u32]) -> String {
    sha256(format!("hardware 2 {rtl} {} {seeds:?}", plan.target).as_bytes())
}

/// Synthesises the SCPU of a configuration. Also places and routes it if there are `seeds` for the placer.
pub(super) fn hardware(
    config: &Config,
    plan: &Plan,
    seeds: &[u32],
    key: String,
    progress: impl FnMut(&str),
) -> Result<Hardware, SynthError> {
    let options = Options { target: plan.target, seeds: seeds.to_vec(), placer: Placer::default() };
    // The same stages, with the target's own blocks.
    let Figures { area, clock_mhz, .. } = synthesise(&Unit::scpu_for(config, plan.target)?, &options, progress)?;
    Ok(Hardware { key, area, routed_mhz: clock_mhz })
}
