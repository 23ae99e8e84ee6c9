//! `report.html`: the pictures, the steps along their fronts, and a sortable table.

use super::columns::{COLUMNS, Column, FIRST};
use super::front::{Time, front, step};
use super::{GAP, LAYERS, Point, STEPS, Study, picture};
use crate::report::page;
use crate::report::table::grouped;
use maud::{Markup, html};

/// The page's own script. Hovering over a point shows its row, and a click on a heading sorts.
const SCRIPT: &str = include_str!("report.js");

/// The text of the page.
pub fn page(results: &Study) -> String {
    let body = html! {
        p { "Each point is a configuration of the AFU: its error, measured against the truth in arbitrary precision, over "
            "its time, counted by simulating its Verilog. Down is more accurate, left is faster. A hollow one is at the delay "
            "model’s clock, which place and route would lower. Hover over a point to see its row." }
        @for time in results.times() { (page::figure(&picture(results, time))) }
        aside #row aria-live="polite" { span { small { "Hover over a point to see its row." } } }
        (sentences(results))
        h2 { "Points" }
        p.soft { "Click a heading to sort. Errors are of " (results.scenes().join(" and ")) ": of a contact the largest of the "
            "depth’s (relative to the sum of the radii), the normal’s (to 1) and the position’s (to the largest coordinate or "
            "radius), and in units in the last place of binary32. Decisions and gross failures are of all "
            (grouped(results.pairs())) " pairs." }
        (table(results))
        h2 { "How it was done" }
        (method(results))
    };
    page::scripted("What accuracy costs in time", &body, SCRIPT)
}

/// The sentences for each step along the fronts.
pub fn steps(results: &Study) -> Vec<(Time, Vec<String>)> {
    let of = |time: Time| {
        let front = front(results, time, |point| results.is_comparable(point));
        let pairs = front.windows(2).map(|two| step(results, time, &results.points[two[0]], &results.points[two[1]]));
        (time, pairs.collect())
    };
    results.times().into_iter().map(of).collect()
}

fn sentences(results: &Study) -> Markup {
    html! {
        h2 { "Step by step" }
        @for (time, steps) in steps(results) {
            details {
                summary { "By " (time.words()) }
                @if steps.is_empty() {
                    p { "One configuration has both the least time and the least error." }
                } @else {
                    ol { @for step in steps { li { (step) } } }
                }
            }
        }
    }
}

fn table(results: &Study) -> Markup {
    html! {
        div.wide {
            table #points {
                thead { tr {
                    th { "configuration" }
                    @for column in known(results) { th.n { (column.heading) } }
                    th { "axis" }
                } }
                tbody { @for point in &results.points { (row(results, point)) } }
            }
        }
    }
}

/// The columns with any value: first those that the page is about, then the others.
fn known(results: &Study) -> impl Iterator<Item = &'static Column> {
    let is_known = |column: &&Column| results.points.iter().any(|point| (column.value)(results, point).is_some());
    let first = FIRST.iter().filter_map(|key| COLUMNS.iter().find(|column| column.key == *key));
    let others = COLUMNS.iter().filter(|column| !FIRST.contains(&column.key));
    first.chain(others).filter(is_known)
}

fn row(results: &Study, point: &Point) -> Markup {
    html! {
        tr data-name=(point.name) {
            td { (point.name) }
            @for column in known(results) {
                td.n data-v=((column.value)(results, point).map_or(String::new(), |value| value.to_string())) {
                    (column.text(results, point))
                }
            }
            td { (point.axis) }
        }
    }
}

fn method(results: &Study) -> Markup {
    html! {
        ul {
            li { "Pairs: "
                @for (number, set) in results.sets.iter().enumerate() {
                    @if number > 0 { ", " }
                    (grouped(set.pairs)) " of " code { (set.name) }
                }
                "; seed " (results.seed) "." }
            li { "Time: cycles of one SCPU’s AFU, simulated, at the clock after place and route where there is one (filled points), "
                "otherwise at the delay model’s (hollow). Latency: of a single pair, from its line in to its contact’s line out. Over the link: "
                code { (results.link) } "." }
            @if results.has_areas() {
                li { "Area: an SCPU on " (results.target.device()) ", cells as they were placed, or as Yosys counts them where "
                    "nothing was; a full device holds as many as fit by what runs out first, controller and shell not counted." }
            }
            @if !results.kernels.is_empty() {
                li { "Software: the same arithmetic on one thread of " (results.processor) "; its best kernels take "
                    @for (number, (name, ns)) in results.kernels.iter().enumerate() {
                        @if number > 0 { ", " }
                        (format!("{ns:.2}")) " ns per pair (" (name) ")"
                    } "." }
            }
            @if results.points.iter().any(|point| point.drift.is_some()) {
                li { "The diamond: " (LAYERS) " layers with gaps of " (GAP) ", " (STEPS) " steps with each arithmetic in the place of ODE’s collider; how far "
                    "its spheres are, on average, from where ODE in f64 has them, in radii. The scene is chaotic." }
            }
            @for what in &results.left_out { li { "Left out: " (what) "." } }
        }
        pre { (results.command) }
        p.soft { @if !results.date.is_empty() { (results.date) ", " } "contact-afu " (results.version) }
    }
}
