//! A run as a page: the scene moving, the plan, and what each effect cost.

use maud::{Markup, PreEscaped, html};

use super::cost::Cost;
use super::results::SceneRun;
use super::text::cost_rows;
use crate::plot::{Axis, Plot, Scale, Series};
use crate::report::page::{base64, scripted, table};

/// Frames at most, and numbers in all of them.
const FRAMES: usize = 600;
const NUMBERS: usize = 1_500_000;
/// Steps of a coordinate across the scene: 16 bits.
const STEPS: f64 = 65_535.0;

const SCRIPT: &str = include_str!("viewer.js");
const STYLE: &str = "canvas{width:100%;height:26rem;border:1px solid var(--grid);touch-action:none;display:block}\
div.bar{display:flex;gap:.6rem;align-items:center;margin:.5rem 0}div.bar input{flex:1}\
button{font:inherit;padding:.2rem .9rem;background:none;color:inherit;border:1px solid var(--soft);border-radius:.3rem}";

/// The page of a run; `ladder` is the cost with one effect after another, from [`Cost`]s by name.
pub fn page(results: &SceneRun, ladder: &[(String, Cost)]) -> String {
    let body = html! {
        style { (PreEscaped(STYLE)) }
        p { (results.name) ", contacts by " (results.engine) "." }
        (picture(results))
        h2 { "What the scene takes" }
        (plan(results))
        h2 { "What that cost, and what everything would" }
        (table("", &["", "what the scene calls for", "everything"], 1, &cost_rows(&[&results.cost, &results.everything])))
        h2 { "One effect after another" }
        (ladder_of(ladder))
        h2 { "The run" }
        (summary(results))
        (energy(results))
    };
    scripted(&format!("Scene: {}", results.name), &body, SCRIPT)
}

/// The bodies' places as 16-bit numbers between the scene's corners, frame after frame, in base 64.
fn picture(results: &SceneRun) -> Markup {
    let bodies = results.radii.len().max(1);
    let most = FRAMES.min(NUMBERS / (3 * bodies)).max(1);
    let every = results.places.len().div_ceil(most).max(1);
    let frames: Vec<(usize, &Vec<[f64; 3]>)> = results.places.iter().enumerate().step_by(every).collect();
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (ball, radius) in frames.iter().flat_map(|(_, places)| places.iter().zip(&results.radii)) {
        for axis in 0..3 {
            low[axis] = low[axis].min(ball[axis] - radius);
            high[axis] = high[axis].max(ball[axis] + radius);
        }
    }
    let span = (0..3).map(|axis| high[axis] - low[axis]).fold(f64::MIN_POSITIVE, f64::max);
    let mut bytes = Vec::with_capacity(frames.len() * bodies * 6);
    for place in frames.iter().flat_map(|(_, places)| places.iter()) {
        for axis in 0..3 {
            let value = ((place[axis] - low[axis]) / span * STEPS).round() as u16;
            bytes.extend(value.to_le_bytes());
        }
    }
    let shares: Vec<String> = results.radii.iter().map(|radius| format!("{:.5}", radius / span)).collect();
    let middle: Vec<String> = (0..3).map(|axis| format!("{:.5}", (high[axis] - low[axis]) / span / 2.0)).collect();
    let steps: Vec<String> = frames.iter().map(|(step, _)| step.to_string()).collect();
    html! {
        figure {
            canvas id="scene" data-places=(base64(&bytes)) data-radii=(shares.join(" ")) data-middle=(middle.join(" "))
                data-steps=(steps.join(" ")) aria-label="the bodies of the scene, moving" {}
            @if frames.len() > 1 {
                div.bar {
                    button id="play" type="button" { "Pause" }
                    input id="at" type="range" min="0" max=(frames.len() - 1) value="0" aria-label="step";
                    output id="step" { "step 0" }
                }
            }
            figcaption { "Drag to turn, wheel to come nearer. "
                @if frames.len() > 1 { "Every " (every) " of " (results.places.len() - 1) " steps." }
                @else { "Trajectories are not wanted, or nothing moves: the bodies as they lie at first." } }
        }
    }
}

fn plan(results: &SceneRun) -> Markup {
    let row = |row: &super::Row| {
        let calls = row.called_for_by().join("; ");
        vec![row.name.clone(), if row.on { "on" } else { "off" }.to_owned(), row.value.clone(), calls]
    };
    table("", &["", "", "value", "called for by"], 4, &results.rows.iter().map(row).collect::<Vec<_>>())
}

fn ladder_of(ladder: &[(String, Cost)]) -> Markup {
    let row = |(name, cost): &(String, Cost)| {
        vec![
            name.clone(),
            cost.operators.values().sum::<usize>().to_string(),
            cost.latency_cycles.to_string(),
            cost.luts.map_or_else(|| "not counted".to_owned(), crate::report::table::grouped),
            cost.bytes_sent.to_string(),
            cost.bytes_returned.to_string(),
            cost.host_step_ns.map_or_else(|| "-".to_owned(), |ns| format!("{:.1}", ns / 1000.0)),
        ]
    };
    let heading = [
        "with",
        "operators of an SCPU",
        "cycles",
        "LUTs of an SCPU",
        "bytes sent a pair",
        "bytes a contact",
        "host time a step, µs",
    ];
    let points = |figure: fn(&Cost) -> f64| {
        (1..).zip(ladder).map(move |(step, (_, cost))| (f64::from(step), figure(cost))).collect::<Vec<_>>()
    };
    let plot = Plot::new(
        "One effect after another: rows of the table, from the first",
        Axis::new("row", Scale::Linear),
        Axis::new("cycles, operators", Scale::Linear),
    )
    .with(Series::new("cycles from a pair to its contact", 0, points(|cost| f64::from(cost.latency_cycles))))
    .with(Series::new("operators of an SCPU", 1, points(|cost| cost.operators.values().sum::<usize>() as f64)));
    html! {
        (table("", &heading, 1, &ladder.iter().map(row).collect::<Vec<_>>()))
        figure { (plot.figure()) }
    }
}

fn summary(results: &SceneRun) -> Markup {
    html! { pre { (results.text()) } }
}

fn energy(results: &SceneRun) -> Markup {
    if results.energy.is_empty() {
        return html! {};
    }
    let points = |figure: fn(&super::Energy) -> f64| {
        let every = results.energy.len().div_ceil(500);
        results
            .energy
            .iter()
            .enumerate()
            .step_by(every)
            .map(move |(step, e)| (step as f64, figure(e)))
            .collect::<Vec<_>>()
    };
    let plot = Plot::new("Energy", Axis::new("step", Scale::Linear), Axis::new("energy", Scale::Linear))
        .with(Series::new("kinetic", 0, points(|e| e.kinetic)))
        .with(Series::new("with the field's", 1, points(|e| e.kinetic + e.potential)));
    html! { figure { (plot.figure()) } }
}
