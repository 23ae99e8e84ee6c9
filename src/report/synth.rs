//! The tables of `afu synth`.

use super::table::{figure, grouped, table};
use crate::synth::fit::{Fit, Point};
use crate::synth::{Figures, Hop, Placer};

/// The columns of [`row`].
pub(super) const HEADING: [&str; 11] =
    ["unit", "asked MHz", "model MHz", "MHz", "cycles", "ns", "LUT", "FF", "DSP", "BRAM", "MHz by seed"];

/// The figures of the units side by side, then the critical path of each.
pub fn text(all: &[Figures]) -> String {
    let mut out = table(&HEADING, all.iter().map(row));
    for figures in all.iter().filter(|figures| !figures.critical.is_empty()) {
        out += &format!("\n\n{}: critical path\n{}", title(figures), path(&figures.critical));
    }
    out
}

/// The architecture, as in ` by table`, if the operator has several.
pub(super) fn by(figures: &Figures) -> String {
    figures.architecture.map_or_else(String::new, |architecture| format!(" by {}", architecture.name()))
}

/// A unit, its arithmetic, its target, and its placer if that is not the usual one.
pub fn title(figures: &Figures) -> String {
    let placer = figures.placer.filter(|placer| *placer != Placer::default());
    let placed = placer.map_or_else(String::new, |placer| format!(", placer {placer}"));
    format!("{} {}{}, {}{placed}", figures.unit, figures.profile, by(figures), figures.target)
}

/// The cells of a unit.
pub(super) fn row(figures: &Figures) -> [String; 11] {
    let seeds: Vec<String> = figures.seeds.iter().map(|run| format!("{}: {:.1}", run.seed, run.clock_mhz)).collect();
    [
        title(figures),
        figure(Some(figures.asked_mhz), 0),
        figure(figures.modelled_mhz, 0),
        figure(figures.clock_mhz, 1),
        figures.latency_cycles.map_or_else(|| "-".to_owned(), |cycles| cycles.to_string()),
        figure(figures.latency_ns, 1),
        grouped(figures.area.luts),
        grouped(figures.area.ffs),
        figures.area.dsps.to_string(),
        figures.area.brams.to_string(),
        if seeds.is_empty() { "not routed".to_owned() } else { seeds.join(", ") },
    ]
}

/// A path, one line per hop: stage, logic delay, routing delay, signal.
pub(super) fn path(hops: &[Hop]) -> String {
    let line = |hop: &Hop| {
        let stage = hop.stage.map_or_else(String::new, |stage| format!("stage {stage}"));
        format!("  {stage:<9} {:5.2} ns logic, {:5.2} ns routing  {}", hop.logic_ns, hop.routing_ns, hop.signal)
    };
    let (logic, routing) = hops.iter().fold((0.0, 0.0), |sum, hop| (sum.0 + hop.logic_ns, sum.1 + hop.routing_ns));
    let mut lines: Vec<String> = hops.iter().map(line).collect();
    lines.push(format!("  {:<9} {logic:5.2} ns logic, {routing:5.2} ns routing", "total"));
    lines.join("\n")
}

/// The circuits that a delay model was fitted to and tested on, with its errors.
pub fn fit(fit: &Fit) -> String {
    let row = |point: &Point| {
        let set = if point.fitted { "fit" } else { "test" };
        let [routed, modelled] = [point.routed_mhz, point.modelled_mhz].map(|clock| figure(Some(clock), 0));
        [point.graph.clone(), set.to_owned(), routed, modelled, format!("{:+.1} %", 100.0 * point.error())]
    };
    let worst = |fitted: bool| {
        let errors = fit.points.iter().filter(|point| point.fitted == fitted).map(|point| point.error().abs());
        100.0 * errors.fold(0.0, f64::max)
    };
    format!(
        "{}\nlargest error: {:.1} % on the fitted circuits, {:.1} % on the test circuits",
        table(&["circuit", "set", "routed MHz", "model MHz", "error"], fit.points.iter().map(row)),
        worst(true),
        worst(false)
    )
}
