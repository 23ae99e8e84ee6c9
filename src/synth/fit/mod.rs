//! Fits a delay model to the delays that the router reports.
//!
//! Small graphs of one kind each are placed and routed. Graphs of similar delay share a design, because a placer
//! concentrates on the slowest paths and would neglect the others. Each graph's delay is the latest arrival at its own
//! registers, the median over the seeds. The model's parameters minimise the squares of the relative errors of the
//! clock over one part of the graphs. The other part tests the model.

mod graphs;
mod least_squares;

use serde::{Deserialize, Serialize};

use self::graphs::{Sample, port, samples, together};
use super::route::Run;
use super::run::kept;
use super::yosys::{Design, synthesise as cells};
use super::{Placer, SynthError, Target, Unit, wrapper};
use crate::config::Profile;
use crate::hdl::{BuildErrors, DelayModel};
use crate::tools::Program;

/// The schema of the JSON.
pub const SCHEMA: &str = "contact-afu/fit/1";
/// Graphs whose modelled delays differ by more than this factor are not put into one design.
const SPREAD: f64 = 1.25;

/// A fitted model, and how well it predicts the router.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// [`SCHEMA`].
    pub schema: String,
    /// The family.
    pub target: Target,
    /// The versions of Yosys and nextpnr.
    pub tools: [String; 2],
    /// The placer's seeds.
    pub seeds: Vec<u32>,
    /// The model.
    pub model: DelayModel,
    /// The graphs.
    pub points: Vec<Point>,
}

/// A graph's clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// The graph, as in `add_24`: an addition of 24 bits.
    pub graph: String,
    /// True for a graph of the fit, false for one of the test.
    pub fitted: bool,
    /// The clock that the router's delay allows, in MHz: the median over the seeds.
    pub routed_mhz: f64,
    /// The clock that the model predicts, in MHz.
    pub modelled_mhz: f64,
}

impl Point {
    /// The relative error of the model; positive if the model is above the router.
    pub fn error(&self) -> f64 {
        self.modelled_mhz / self.routed_mhz - 1.0
    }
}

/// Routes the graphs and fits a model for a target; `None` for a target without a router.
///
/// # Errors
/// Returns the errors of [`super::synthesise`].
pub fn fit(target: Target, seeds: &[u32], mut progress: impl FnMut(&str)) -> Result<Option<Fit>, SynthError> {
    let Some((architecture, device)) = target.router() else { return Ok(None) };
    let (yosys, nextpnr, store) = (Program::yosys()?, Program::nextpnr(architecture)?, kept()?);
    let start = DelayModel::guess();
    let delay = |sample: Sample| Ok((start.longest(&*sample.module()?), sample));
    let mut sorted = samples().into_iter().map(delay).collect::<Result<Vec<_>, BuildErrors>>()?;
    sorted.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let samples: Vec<Sample> = sorted.iter().map(|(_, sample)| *sample).collect();

    let mut measured = Vec::new();
    for group in groups(&sorted) {
        let unit = Unit::pipeline("samples", &Profile::WIDE, 400.0, together(&group)?);
        let files = Unit::files(&unit.wrapped()?, target);
        let design = Design { unit: &unit.name, files: &files, top: wrapper::TOP };
        progress(&format!("{} graphs: Yosys", group.len()));
        let netlist = cells(&yosys, &design, target, &store)?;
        let mut runs = Vec::new();
        for &seed in seeds {
            progress(&format!("{} graphs: nextpnr, seed {seed}", group.len()));
            let placer = Placer::default();
            let run = Run { nextpnr: &nextpnr, netlist: &netlist, target, device, placer, seed, unit: &unit.name };
            runs.push(run.arrivals(&store)?);
        }
        for sample in &group {
            // A register's cell is named after the port that it drives and the kind of cell.
            let mark = format!("{}_TRELLIS_FF", port(&sample.name()));
            let latest = runs.iter().map(|run| {
                let ends = run.iter().filter(|(cell, _)| cell.contains(&mark));
                ends.map(|(_, arrival)| *arrival).fold(0.0, f64::max)
            });
            let mut latest: Vec<f64> = latest.collect();
            latest.sort_by(f64::total_cmp);
            measured.push(latest[latest.len() / 2]);
        }
    }
    if let Some(missing) = measured.iter().position(|ns| *ns <= 0.0) {
        let what = format!("no register of {} in its report", samples[missing].name());
        return Err(SynthError::Unexpected { program: nextpnr.name().to_owned(), unit: "samples".to_owned(), what });
    }

    let modules = samples.iter().map(Sample::module).collect::<Result<Vec<_>, _>>()?;
    let period = |model: &DelayModel, index: usize| model.register + model.longest(&modules[index]);
    let found = least_squares::fit(&start.parameters(), |parameters| {
        let model = start.with_parameters(parameters);
        let fitted = (0..samples.len()).filter(|index| samples[*index].fitted);
        fitted.map(|index| period(&model, index) / measured[index] - 1.0).collect()
    });
    let model = DelayModel {
        name: target.name().to_owned(),
        ..start.with_parameters(&found.iter().map(thousandths).collect::<Vec<_>>())
    };
    let point = |(index, sample): (usize, &Sample)| Point {
        graph: sample.name(),
        fitted: sample.fitted,
        routed_mhz: 1000.0 / measured[index],
        modelled_mhz: 1000.0 / period(&model, index),
    };
    let points = samples.iter().enumerate().map(point).collect();
    let tools = [yosys.version().to_owned(), nextpnr.version().to_owned()];
    Ok(Some(Fit { schema: SCHEMA.to_owned(), target, tools, seeds: seeds.to_vec(), model, points }))
}

/// Rounds to a picosecond, because more digits are noise.
fn thousandths(time: &f64) -> f64 {
    (time * 1000.0).round() / 1000.0
}

/// Groups samples in the order of their delays, with a new group wherever the spread is exceeded.
fn groups(sorted: &[(f64, Sample)]) -> Vec<Vec<Sample>> {
    let mut groups: Vec<Vec<Sample>> = Vec::new();
    let mut first = 0.0;
    for (delay, sample) in sorted {
        match groups.last_mut() {
            Some(group) if (1.0 + delay) < SPREAD * (1.0 + first) => group.push(*sample),
            _ => {
                first = *delay;
                groups.push(vec![*sample]);
            }
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The model's structure may change after a fit. The file's modelled clocks must still be what the model says
    /// today.
    #[test]
    fn the_committed_points_are_what_the_model_says() {
        let fit: Fit = serde_json::from_str(include_str!("../../../docs/delays-ecp5.json")).unwrap();
        let samples = samples();
        assert_eq!(samples.len(), fit.points.len());
        for point in &fit.points {
            let sample = samples.iter().find(|sample| sample.name() == point.graph).unwrap();
            assert_eq!(sample.fitted, point.fitted, "{}", point.graph);
            let mhz = fit.model.clock(fit.model.longest(&sample.module().unwrap()));
            assert!(
                (mhz / point.modelled_mhz - 1.0).abs() < 1e-9,
                "{}: {mhz}, not {}",
                point.graph,
                point.modelled_mhz
            );
        }
    }
}
