//! nextpnr: places and routes cells, and reports the clock.

use std::collections::BTreeMap;
use std::fs;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::cells::Cells;
use super::yosys::{Netlist, read, run};
use super::{Placer, SynthError, Target, wrapper};
use crate::store::{Key, Store};
use crate::tools::Program;

/// The clock the placer works towards, in MHz: more than any unit reaches, and the same for all.
const GOAL_MHZ: &str = "400";

/// A placed and routed design.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Routed {
    /// The clock in MHz that it reaches.
    pub clock_mhz: f64,
    /// Places in use, by kind.
    pub used: Cells,
    /// The critical path from register to register.
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
    #[serde(default)]
    detailed_net_timings: Vec<Net>,
}

#[derive(Deserialize)]
struct Net {
    event: String,
    endpoints: Vec<End>,
}

#[derive(Deserialize)]
struct End {
    cell: String,
    event: String,
    /// Earliest and latest arrival.
    delay: [f64; 2],
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

/// A run of nextpnr on a netlist.
pub(super) struct Run<'a> {
    /// The program.
    pub nextpnr: &'a Program,
    /// The netlist.
    pub netlist: &'a Netlist,
    /// The family.
    pub target: Target,
    /// The options of its device.
    pub device: &'a [&'a str],
    /// The placer.
    pub placer: Placer,
    /// The placer's seed.
    pub seed: u32,
    /// The name of the design, for messages.
    pub unit: &'a str,
}

impl Run<'_> {
    /// Places and routes, or finds the result in the store.
    pub fn route(&self, store: &Store) -> Result<Routed, SynthError> {
        self.kept(store, &[], |report| {
            let fastest = report.fmax.values().map(|clock| clock.achieved).reduce(f64::min);
            let clock_mhz = fastest.ok_or_else(|| self.unexpected("no clock in its report"))?;
            let clocked = |path: &&Path| path.from.starts_with("posedge") && path.to.starts_with("posedge");
            let path = report.critical_paths.iter().find(clocked).map(|path| path.path.clone()).unwrap_or_default();
            let used = report.utilization.into_iter().map(|(kind, used)| (kind, used.used)).collect();
            Ok(Routed { clock_mhz, used, path })
        })
    }

    /// The latest arrival at each cell from other registers, in ns after the clock, from the stored report if possible.
    pub fn arrivals(&self, store: &Store) -> Result<BTreeMap<String, f64>, SynthError> {
        self.kept(store, &["--detailed-timing-report"], |report| {
            let mut latest = BTreeMap::new();
            for net in report.detailed_net_timings.iter().filter(|net| net.event.starts_with("posedge")) {
                for end in net.endpoints.iter().filter(|end| end.event.starts_with("posedge")) {
                    let arrival: &mut f64 = latest.entry(end.cell.clone()).or_default();
                    *arrival = arrival.max(end.delay[1]);
                }
            }
            Ok(latest)
        })
    }

    pub fn unexpected(&self, what: &str) -> SynthError {
        let program = self.nextpnr.name().to_owned();
        SynthError::Unexpected { program, unit: self.unit.to_owned(), what: what.to_owned() }
    }

    fn kept<T: Serialize + DeserializeOwned>(
        &self,
        store: &Store,
        options: &[&str],
        take: impl FnOnce(Report) -> Result<T, SynthError>,
    ) -> Result<T, SynthError> {
        let seed = self.seed.to_string();
        let fixed = ["--top", wrapper::TOP, "--freq", GOAL_MHZ, "--timing-allow-fail", "-q"];
        let options = [self.placer.options(), options].concat();
        let words = [self.device, &fixed[..], &options].concat();
        let of = (self.nextpnr.version(), &self.netlist.key, self.target.name(), self.seed, words);
        store.get_or_make(&Key::new("route/1", &of)?, || {
            let room = store.scratch()?;
            let file = room.path().join("netlist.json");
            fs::copy(&self.netlist.path, &file).map_err(|e| SynthError::io("write into", store.folder(), e))?;
            let mut command = self.nextpnr.command();
            command.args(self.device).args(fixed).args(&options);
            command.args(["--json", "netlist.json", "--seed", &seed, "--report", "report.json"]);
            run(self.nextpnr, command.current_dir(room.path()), self.unit)?;
            take(read(self.nextpnr, &room.path().join("report.json"), self.unit)?)
        })
    }
}
