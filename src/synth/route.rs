//! nextpnr: cells to places and wires, and how fast that is.

use std::collections::BTreeMap;
use std::fs;

use serde::{Deserialize, Serialize};

use super::cache::{self, Cache};
use super::cells::Cells;
use super::yosys::{Netlist, read, run};
use super::{SynthError, Target, wrapper};
use crate::tools::Program;

/// The clock the placer works towards, in MHz: more than any unit reaches, and the same for all.
const GOAL_MHZ: &str = "400";

/// A placed and routed design.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Routed {
    /// The clock it reaches, MHz.
    pub clock_mhz: f64,
    /// Places in use, by kind.
    pub used: Cells,
    /// The slowest path from register to register.
    pub path: Vec<Segment>,
}

/// A piece of a path: through a cell, or along a net.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Segment {
    pub delay: f64,
    #[serde(rename = "type")]
    pub kind: String,
    pub to: Pin,
    #[serde(default)]
    pub sources: Vec<String>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Pin {
    pub cell: String,
}

#[derive(Deserialize)]
struct Report {
    critical_paths: Vec<Path>,
    fmax: BTreeMap<String, Fmax>,
    utilization: BTreeMap<String, Used>,
}

#[derive(Deserialize)]
struct Path {
    from: String,
    to: String,
    path: Vec<Segment>,
}

#[derive(Deserialize)]
struct Fmax {
    achieved: f64,
}

#[derive(Deserialize)]
struct Used {
    used: u64,
}

/// Places and routes a netlist with a seed, or finds the result in the cache.
pub(super) fn route(
    nextpnr: &Program,
    netlist: &Netlist,
    target: Target,
    device: &[&str],
    seed: u32,
    unit: &str,
    cache: &Cache,
) -> Result<Routed, SynthError> {
    let seed = seed.to_string();
    let fixed = ["--top", wrapper::TOP, "--freq", GOAL_MHZ, "--timing-allow-fail", "-q"];
    let mut parts = vec!["route 1", nextpnr.version(), &netlist.key, target.name(), &seed];
    parts.extend(device);
    parts.extend(fixed);
    let key = cache::key(&parts);
    if let Some(routed) = cache.get(&key) {
        return Ok(routed);
    }
    let room = cache.scratch()?;
    let file = room.path().join("netlist.json");
    fs::copy(&netlist.path, &file).map_err(|e| SynthError::io("write", &file, e))?;
    let mut command = nextpnr.command();
    command.args(device).args(fixed).args(["--json", "netlist.json", "--seed", &seed, "--report", "report.json"]);
    run(nextpnr, command.current_dir(room.path()), unit)?;
    let report: Report = read(nextpnr, &room.path().join("report.json"), unit)?;
    let fastest = report.fmax.values().map(|clock| clock.achieved).reduce(f64::min);
    let clock_mhz = fastest.ok_or_else(|| SynthError::Unexpected {
        program: nextpnr.name().to_owned(),
        unit: unit.to_owned(),
        what: "no clock in its report".to_owned(),
    })?;
    let clocked = |path: &&Path| path.from.starts_with("posedge") && path.to.starts_with("posedge");
    let path = report.critical_paths.iter().find(clocked).map(|path| path.path.clone()).unwrap_or_default();
    let used = report.utilization.into_iter().map(|(kind, used)| (kind, used.used)).collect();
    let routed = Routed { clock_mhz, used, path };
    cache.put(&key, &routed)?;
    Ok(routed)
}
