//! The columns of a study's table: one list for the page and for the CSV.

use super::{Point, Study, Time};
use crate::report::table::grouped;
use crate::synth::Area;

/// How a figure is written for people.
#[derive(Clone, Copy)]
pub(super) enum Show {
    /// In full, digits grouped.
    Count,
    /// With two decimals.
    Time,
    /// With two decimals, and from a thousand on like an error.
    Units,
    /// With two significant digits and a power of ten.
    Error,
}

/// A column of figures.
pub(super) struct Column {
    /// The key in the CSV.
    pub key: &'static str,
    /// The heading in tables for people.
    pub heading: &'static str,
    /// The figure; `None` if it was not measured.
    pub value: fn(&Study, &Point) -> Option<f64>,
    /// How it is written.
    pub show: Show,
}

impl Column {
    /// The figure for people.
    pub fn text(&self, results: &Study, point: &Point) -> String {
        let Some(value) = (self.value)(results, point) else { return "–".to_owned() };
        match self.show {
            Show::Count => grouped(value as u64),
            Show::Units if value >= 1000.0 => format!("{value:.1e}"),
            Show::Time | Show::Units => format!("{value:.2}"),
            Show::Error if value == 0.0 => "0".to_owned(),
            Show::Error => format!("{value:.1e}"),
        }
    }
}

const fn column(
    key: &'static str,
    heading: &'static str,
    show: Show,
    value: fn(&Study, &Point) -> Option<f64>,
) -> Column {
    Column { key, heading, value, show }
}

fn area(point: &Point, of: fn(Area) -> u64) -> Option<f64> {
    point.area().map(|area| of(area) as f64)
}

fn ulps(results: &Study, point: &Point, which: usize) -> Option<f64> {
    let errors = point.errors(&results.scenes());
    [errors.depth_ulps, errors.normal_ulps, errors.position_ulps].get(which).map(|spread| spread.largest)
}

/// The first columns of the page, in this order. The other columns follow.
pub(super) const FIRST: [&str; 7] = ["worst", "lone_ns", "link_ns", "device_ns", "luts", "wrong", "bad"];

/// All columns, in the order of the CSV.
pub(super) const COLUMNS: [Column; 26] = [
    column("wrong", "wrong decisions", Show::Count, |_, p| Some(p.wrong() as f64)),
    column("missed", "missed", Show::Count, |_, p| Some(p.tally().missed as f64)),
    column("false", "false positives", Show::Count, |_, p| Some(p.tally().false_hits as f64)),
    column("bad", "gross failures", Show::Count, |_, p| Some(p.tally().bad as f64)),
    column("worst", "largest error", Show::Error, |r, p| Some(r.worst(p))),
    column("p999", "99.9 % within", Show::Error, |r, p| Some(p.errors(&r.scenes()).contact.p999)),
    column("typical", "mean error", Show::Error, |r, p| Some(r.typical(p))),
    column("depth_ulps", "depth, ulp", Show::Units, |r, p| ulps(r, p, 0)),
    column("normal_ulps", "normal, ulp", Show::Units, |r, p| ulps(r, p, 1)),
    column("position_ulps", "position, ulp", Show::Units, |r, p| ulps(r, p, 2)),
    column("lone_cycles", "latency, cycles", Show::Count, |_, p| Some(p.cycles.lone as f64)),
    column("lone_ns", "latency, ns", Show::Time, |r, p| Time::Lone.of(p, r)),
    column("compute_ns", "one SCPU, ns per pair", Show::Time, |_, p| Some(p.compute_ns())),
    column("device_ns", "full device, ns per pair", Show::Time, |r, p| Time::Device.of(p, r)),
    column("device_scpus", "SCPUs per device", Show::Count, |r, p| p.on_device(r.target).map(|scpus| scpus as f64)),
    column("device_pairs_per_second", "its pairs per second", Show::Count, |r, p| {
        Time::Device.of(p, r).map(|ns| 1e9 / ns)
    }),
    column("link_ns", "link, ns per pair", Show::Time, |r, p| Time::Link.of(p, r)),
    column("modelled_mhz", "clock by model, MHz", Show::Count, |_, p| Some(p.modelled_mhz.round())),
    column("routed_mhz", "clock routed, MHz", Show::Count, |_, p| p.routed_mhz().map(f64::round)),
    column("luts", "LUTs", Show::Count, |_, p| area(p, |a| a.luts)),
    column("ffs", "flip-flops", Show::Count, |_, p| area(p, |a| a.ffs)),
    column("dsps", "DSPs", Show::Count, |_, p| area(p, |a| a.dsps)),
    column("brams", "memories", Show::Count, |_, p| area(p, |a| a.brams)),
    column("software_ns", "software, ns per pair", Show::Time, |_, p| p.software_ns),
    column("drift", "drift of the diamond, radii", Show::Error, |_, p| p.drift.map(|drift| drift.mean)),
    column("asked_mhz", "clock asked, MHz", Show::Count, |_, p| Some(p.config.clock_mhz.round())),
];
