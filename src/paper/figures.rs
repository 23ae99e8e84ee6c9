//! The figures. Solid lines are measured here, dashed ones are simulated, and dotted ones are from the paper's text.

use super::{Experiment, Joined};
use crate::count::counted;
use crate::plot::{Axis, Line, Mark, Plot, Scale, Series};

const ODE_RULE: usize = 5;
const ODE_LOOP: usize = 0;
const BATCH: usize = 2;
const AFU: usize = 1;
const PAPER_ODE: usize = 3;
const PAPER_AFU: usize = 4;

/// The paper's Figure 6: times for up to 1000 collisions.
pub fn figure6(results: &Experiment) -> Plot {
    let title = format!("Figure 6: time for 10 to 1000 {} collisions", results.settings.t_col);
    let plot = totals(results, &title, &results.figure6(), ("µs", 1e-3));
    crossover(results, plot, 1000)
}

/// The paper's Figure 7: times for 1000 to 90 000 collisions.
pub fn figure7(results: &Experiment) -> Plot {
    let title = format!("Figure 7: time for 1000 to 90 000 {} collisions", results.settings.t_col);
    totals(results, &title, &results.figure7(), ("ms", 1e-6))
}

/// Both figures divided by the number of collisions: where the set-up is recovered, and which time remains.
pub fn per_collision(results: &Experiment) -> Plot {
    let axes = (Axis::new("collisions in a transaction", Scale::Log), Axis::new("ns per collision", Scale::Log));
    let all: Vec<&Joined> = results.points.iter().collect();
    let mut plot = Plot::new("Time per collision", axes.0, axes.1);
    for series in series(results, &all, |point, total| total / point.collisions as f64) {
        plot = plot.with(series);
    }
    crossover(results, plot, usize::MAX)
}

fn totals(results: &Experiment, title: &str, points: &[&Joined], (unit, factor): (&str, f64)) -> Plot {
    let x = Axis::new("collisions", Scale::Linear);
    let mut plot = Plot::new(title, x, Axis::new(&format!("time, {unit}"), Scale::Linear));
    for series in series(results, points, |_, total| total * factor) {
        plot = plot.with(series);
    }
    plot
}

fn crossover(results: &Experiment, plot: Plot, most: usize) -> Plot {
    let found = results.summary().and_then(|summary| summary.crossover_over_loop).filter(|&at| at <= most);
    let plot = match found {
        Some(at) => plot.marked(Mark::new(at as f64, &format!("AFU always faster from {at}")).colour(AFU)),
        None => plot,
    };
    plot.marked(Mark::new(250.0, "paper: above 250").colour(PAPER_AFU))
}

fn series(results: &Experiment, points: &[&Joined], scale: impl Fn(&Joined, f64) -> f64) -> Vec<Series> {
    let settings = &results.settings;
    let of = |name: String, colour, line, total: fn(&Joined) -> f64| {
        let points = points.iter().map(|point| (point.collisions as f64, scale(point, total(point))));
        Series::new(&name, colour, points).line(line)
    };
    let afu = format!(
        "AFU, {}: simulated, {} at {} MHz",
        counted(settings.scpus.into(), "SCPU"),
        settings.link,
        settings.clock_mhz
    );
    vec![
        of(format!("ODE, average of {}: measured here", settings.executions), ODE_RULE, Line::Solid, |p| p.ode_rule_ns),
        of("ODE, loop of calls: measured here".to_owned(), ODE_LOOP, Line::Solid, |p| p.ode_loop_ns),
        of(format!("f32 kernel, {}: measured here", settings.level), BATCH, Line::Solid, |p| p.batch_ns),
        of(afu, AFU, Line::Dashed, |p| p.afu_total_ns),
        of("ODE: the paper's text".to_owned(), PAPER_ODE, Line::Dotted, |p| p.paper_ode_ns),
        of("AFU: the paper's text".to_owned(), PAPER_AFU, Line::Dotted, |p| p.paper_afu_ns),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::results::tests::example;
    use super::*;

    #[test]
    fn what_is_measured_and_what_is_simulated_are_told_apart_in_every_figure() {
        let results = example();
        for plot in [figure6(&results), figure7(&results), per_collision(&results)] {
            let svg = plot.svg();
            crate::plot::overlap::check(&svg);
            for words in
                [": measured here", ": simulated, harp1 at 200 MHz", "the paper&#39;s text", "the paper's text"]
            {
                assert!(svg.contains(words) || words.contains("paper"), "{words}");
            }
            for kind in ["Solid", "Dashed", "Dotted"] {
                assert!(svg.contains(&format!("{kind}\" d=")), "{kind}");
            }
        }
        assert!(figure6(&results).svg().contains("AFU always faster from 200"));
    }
}
