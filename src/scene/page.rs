//! A run as a page: the moving scene or its contacts, the plan, and the cost of each effect.

use maud::{Markup, PreEscaped, html};

use super::cost::Cost;
use super::plan::Row;
use super::results::SceneRun;
use super::text::cost_rows;
use super::viewer;
use crate::plot::{Axis, Line, Marker, Plot, Scale, Series};
use crate::report::page::{self, scripted, table};

/// The page of a run. `ladder` has the [`Cost`]s, by name, with one effect after another.
pub fn page(results: &SceneRun, ladder: &[(String, Cost)]) -> String {
    let body = html! {
        style { (PreEscaped(viewer::STYLE)) }
        p { "Contacts were computed by " (results.engine) "." }
        (viewer::view(results))
        h2 { "The run" }
        (table("", &["", ""], 1, &results.rows()))
        @if let Some(sentence) = results.energy_sentence() { p { (sentence) } }
        @if let Some(warning) = results.warning() { p { strong { "Warning: " } (warning) } }
        h2 { "What the scene calls for" }
        (plan(&results.rows))
        h2 { "What that costs, and what everything would cost" }
        (table("", &["", "what the scene calls for", "everything"], 1, &cost_rows(&[&results.cost, &results.everything])))
        @if ladder.len() > 1 {
            h2 { "The cost of one effect after another" }
            (ladder_of(ladder))
        }
    };
    scripted(&format!("Scene: {}", results.name), &body, viewer::SCRIPT)
}

/// A table of the parts that are on. The others are folded away.
fn plan(rows: &[Row]) -> Markup {
    let line = |row: &Row| vec![row.name.clone(), row.value.clone(), row.called_for_by().join("; ")];
    let on: Vec<Vec<String>> = rows.iter().filter(|row| row.on).map(line).collect();
    let off: Vec<Vec<String>> = rows.iter().filter(|row| !row.on).map(line).collect();
    html! {
        (table("", &["on", "value", "called for by"], 3, &on))
        @if !off.is_empty() {
            details {
                summary { (off.len()) " more are off: not in the Verilog, not in a record, not called in ODE" }
                (table("", &["off", "value", "called for by"], 3, &off))
            }
        }
    }
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
        "operators per SCPU",
        "latency, cycles",
        "LUTs per SCPU",
        "bytes sent per pair",
        "bytes per contact",
        "host time per step, µs",
    ];
    let points = |figure: fn(&Cost) -> f64| {
        (1..).zip(ladder).map(move |(step, (_, cost))| (f64::from(step), figure(cost))).collect::<Vec<_>>()
    };
    let plot = Plot::new(
        "The cost of one effect after another",
        Axis::new("row of the table", Scale::Linear),
        Axis::new("cycles; operators", Scale::Linear),
    )
    .with(
        Series::new("latency of a pair, cycles", 0, points(|cost| f64::from(cost.latency_cycles)))
            .line(Line::Solid)
            .marker(Marker::Circle),
    )
    .with(
        Series::new("operators per SCPU", 1, points(|cost| cost.operators.values().sum::<usize>() as f64))
            .line(Line::Dashed)
            .marker(Marker::Square),
    );
    html! {
        (table("", &heading, 1, &ladder.iter().map(row).collect::<Vec<_>>()))
        (page::figure(&plot))
    }
}
