//! The part of a page that shows the moving scene, or the contacts.

use maud::{Markup, PreEscaped, html};

use super::picture::{LISTED, Picture};
use super::results::{Energy, SceneRun};
use crate::plot::{Axis, Line, Plot, Scale, Series};
use crate::query::{ContactRecord, FLAGS};
use crate::report::table::grouped;

/// The viewer's script, in a block so that its names are local.
pub(super) const SCRIPT: &str = concat!(
    "\"use strict\";\n{\n",
    include_str!("viewer/data.js"),
    include_str!("viewer/vectors.js"),
    include_str!("viewer/camera.js"),
    include_str!("viewer/follow.js"),
    include_str!("viewer/program.js"),
    include_str!("viewer/spheres.js"),
    include_str!("viewer/room.js"),
    include_str!("viewer/bodies.js"),
    include_str!("viewer/playback.js"),
    include_str!("viewer/contacts.js"),
    include_str!("viewer/energy.js"),
    include_str!("viewer/main.js"),
    "}\n"
);

pub(super) const STYLE: &str = include_str!("viewer/viewer.css");

/// The most points of a curve.
const POINTS: usize = 500;

/// The bodies on a canvas, the energy below, and the contacts as a list.
pub(super) fn view(run: &SceneRun) -> Markup {
    let picture = Picture::of(run);
    let moves = picture.frames > 1;
    html! {
        div class=(if run.contacts.is_empty() { "view" } else { "view listed" }) {
            figure.stage {
                canvas id="scene" tabindex="0" role="img" aria-label=(label(run, moves)) {}
                button id="reset" type="button" hidden { "Reset view" }
                p id="missing" hidden {
                    "The bodies are not drawn: this browser has no WebGL 2, or it is switched off."
                }
                @if moves {
                    div.bar {
                        button id="play" type="button" { "Pause" }
                        input id="at" type="range" min="0" max=(picture.frames - 1) step="any" value="0" aria-label="time";
                        output id="step" { "step 0" }
                    }
                }
                figcaption { (caption(run, &picture)) }
            }
            (contacts(run, moves))
        }
        (energy(run))
        script id="picture" type="application/json" { (PreEscaped(picture.json())) }
    }
}

fn label(run: &SceneRun, moves: bool) -> String {
    if moves {
        format!("{} bodies in motion", run.radii.len())
    } else {
        format!("{} bodies, those that touch in bright colours", run.radii.len())
    }
}

fn caption(run: &SceneRun, picture: &Picture) -> Markup {
    let steps = run.places.len().saturating_sub(1) as u64;
    html! {
        "Drag to turn. To zoom, pinch, or click the picture and use the wheel. "
        @if picture.frames > 1 {
            kbd { "Space" } " pauses, " kbd { "←" } " and " kbd { "→" } " step. "
            @if picture.every > 1 { "The " (grouped(steps)) " steps are drawn " (picture.every) " at a time. " }
        } @else if !run.contacts.is_empty() {
            kbd { "←" } " and " kbd { "→" } " step through the contacts. "
        }
        @if let Some(numbers) = &picture.numbers {
            (grouped(numbers.len() as u64)) " of " (grouped(run.radii.len() as u64)) " bodies are drawn."
        }
    }
}

/// The list to step through.
fn contacts(run: &SceneRun, moves: bool) -> Markup {
    if run.contacts.is_empty() {
        return html! {};
    }
    let words: Vec<usize> = ContactRecord::words(run.config.contact).filter(|word| *word != FLAGS).collect();
    let listed = run.contacts.len().min(LISTED);
    html! {
        section.contacts {
            h2 { (grouped(run.contacts.len() as u64)) (if run.contacts.len() == 1 { " contact" } else { " contacts" }) }
            @if listed < run.contacts.len() { p.soft { "The first " (grouped(listed as u64)) " are listed; contacts.csv has all." } }
            @if run.queries_from < run.radii.len() { p.soft { "Queries have the numbers from " (run.queries_from) " on." } }
            div.bar {
                button id="previous" type="button" { "Previous" }
                button id="next" type="button" { "Next" }
                output id="which" { "none chosen" }
            }
            div.rows tabindex="0" {
                table id="contacts" {
                    thead { tr {
                        @if moves { th.n { "step" } }
                        th.n { "first" } th.n { "second" }
                        @for &word in &words { th.n { (ContactRecord::NAMES[word]) } }
                    } }
                    tbody {
                        @for contact in &run.contacts[..listed] {
                            tr {
                                @if moves { td.n { (contact.step) } }
                                @for body in contact.bodies { td.n { (body) } }
                                @for &word in &words { td.n { (short(contact.words[word])) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Five significant digits are enough to read. contacts.csv has all digits.
fn short(value: f32) -> String {
    if value != 0.0 && !(1e-4..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let whole = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    format!("{value:.places$}", places = (4.0 - whole).clamp(0.0, 8.0) as usize)
}

/// The energy over time, with the time that the view shows. It is drawn for a wide and a narrow screen.
fn energy(run: &SceneRun) -> Markup {
    if run.energy.is_empty() {
        return html! {};
    }
    let every = run.energy.len().div_ceil(POINTS);
    let curve = |name: &str, colour, figure: fn(&Energy) -> f64| {
        let point = move |(step, energy)| (step as f64 * run.time_step, figure(energy));
        Series::new(name, colour, run.energy.iter().enumerate().step_by(every).map(point)).line(Line::Solid)
    };
    let axis = |label| Axis::new(label, Scale::Linear);
    let mut plot = Plot::new("Energy", axis("time, in units of the scene"), axis("mass · length² / time²"))
        .with(curve("kinetic", 0, |energy| energy.kinetic));
    if run.energy.iter().any(|energy| energy.potential != 0.0) {
        plot = plot.with(curve("kinetic and potential", 1, |energy| energy.kinetic + energy.potential));
    }
    html! {
        figure.energy {
            div.broad { (plot.figure()) }
            div.narrow { (plot.narrow().figure()) }
            figcaption { "Click or drag on the curve to go to a time." }
        }
    }
}
