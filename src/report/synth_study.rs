//! The folder of a study of units: the figures as JSON, as CSV and as a page.

use std::path::Path;

use maud::{Markup, html};
use serde::{Deserialize, Serialize};

use super::synth::{HEADING, path, row, text, title};
use super::{folder, manifest, page};
use crate::study::{State, Worker};
use crate::synth::{Figures, Placer};

/// The schema of the folder's `manifest.json`.
pub const SCHEMA: &str = "contact-afu/synth-study/1";
const CSV: &str = "figures.csv";
const PAGE: &str = "report.html";

/// The figures of units. Its folder has `manifest.json` with all of them, `figures.csv` and the page `report.html`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SynthStudy {
    schema: String,
    version: String,
    /// The figures, in the order asked for.
    pub figures: Vec<Figures>,
    /// The units that are missing, or that failed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<String>,
}

/// A line of the CSV.
#[derive(Serialize)]
struct Line<'a> {
    unit: &'a str,
    profile: String,
    architecture: &'a str,
    interval: Option<u32>,
    target: String,
    placer: Option<Placer>,
    asked_mhz: f64,
    modelled_mhz: Option<f64>,
    clock_mhz: Option<f64>,
    latency_cycles: Option<u32>,
    latency_ns: Option<f64>,
    luts: u64,
    ffs: u64,
    dsps: u64,
    brams: u64,
}

impl SynthStudy {
    /// The figures that a worker found or measured.
    pub fn new(figures: Vec<Figures>, worker: &Worker) -> Self {
        let gaps = worker.ledger().iter().filter(|(_, state)| *state != State::Made);
        Self {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            figures,
            missing: gaps.map(|(point, _)| point.title.clone()).collect(),
        }
    }

    /// Writes the folder, or replaces the files of an earlier run. Whether it is ours is asked before
    /// ([`folder::check_study`]).
    ///
    /// # Errors
    /// Returns an error if the file system refuses.
    pub fn save(&self, folder: &Path) -> Result<(), folder::Error> {
        folder::create(folder)?;
        folder::replace_json(&folder.join(manifest::NAME), self)?;
        folder::replace_csv(&folder.join(CSV), |out| self.figures.iter().try_for_each(|one| out.serialize(line(one))))?;
        folder::replace_file(&folder.join(PAGE), self.page().as_bytes())
    }

    /// The tables for people.
    pub fn text(&self) -> String {
        text(&self.figures)
    }

    fn page(&self) -> String {
        let rows: Vec<Vec<String>> = self.figures.iter().map(|figures| row(figures).into()).collect();
        let paths = self.figures.iter().filter(|figures| !figures.critical.is_empty());
        let body = html! {
            p { "Cells as Yosys counts them, without those of the wrapper around each unit. Where a unit was placed and "
                "routed, its clock is the median over the seeds of the placer." }
            (page::table("", &HEADING, 1, &rows))
            @if !self.missing.is_empty() { p { b { "Missing: " } (self.missing.join("; ")) "." } }
            @for figures in paths { (critical(figures)) }
            p.soft { code { "figures.csv" } " has the table, " code { "manifest.json" } " every figure; contact-afu " (self.version) "." }
        };
        page::page("Units on an FPGA", &body)
    }
}

fn critical(figures: &Figures) -> Markup {
    html! {
        h2 { (title(figures)) ": critical path" }
        pre { (path(&figures.critical)) }
    }
}

fn line(figures: &Figures) -> Line<'_> {
    Line {
        unit: &figures.unit,
        profile: figures.profile.to_string(),
        architecture: figures.architecture.map_or("", |architecture| architecture.name()),
        interval: figures.interval,
        target: figures.target.to_string(),
        placer: figures.placer,
        asked_mhz: figures.asked_mhz,
        modelled_mhz: figures.modelled_mhz,
        clock_mhz: figures.clock_mhz,
        latency_cycles: figures.latency_cycles,
        latency_ns: figures.latency_ns,
        luts: figures.area.luts,
        ffs: figures.area.ffs,
        dsps: figures.area.dsps,
        brams: figures.area.brams,
    }
}
