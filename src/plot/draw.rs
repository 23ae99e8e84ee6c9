//! A plot's SVG.

use maud::{Markup, PreEscaped, html};

use super::layout::{Layout, SAMPLE};
use super::style::{FONT, LIGHT, STYLE};
use super::{Line, Marker, Plot, Series, names};

pub(super) fn file(plot: &Plot) -> Markup {
    let layout = Layout::new(plot);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" class="plot" viewBox=(view(plot, &layout)) width=(plot.width)
            height=(layout.height) font-family=(FONT) font-size="12" role="img" aria-label=(plot.title) {
            style { (PreEscaped(STYLE)) }
            (inside(plot, &layout))
        }
    }
}

pub(super) fn figure(plot: &Plot) -> Markup {
    let layout = Layout::new(plot);
    html! {
        svg class="plot" viewBox=(view(plot, &layout)) width="100%" font-family=(FONT) font-size="12" role="img" aria-label=(plot.title)
            data-area=(area(&layout)) {
            (inside(plot, &layout))
        }
    }
}

fn view(plot: &Plot, layout: &Layout) -> String {
    format!("0 0 {} {}", plot.width, layout.height)
}

/// Where the x axis lies, for a script: left, top, width and height in the picture, then its least and largest value.
fn area(layout: &Layout) -> String {
    let [least, most] = layout.x.ends();
    format!("{} {} {} {} {least} {most}", layout.left, layout.top, layout.wide, layout.high)
}

/// The left edge of the title: above the axes, or further left if it would not fit.
fn title_left(plot: &Plot, left: f64) -> f64 {
    const BOLD_CHARACTER: f64 = 8.2;
    const MARGIN: f64 = 8.0;
    let fits = plot.width - MARGIN - BOLD_CHARACTER * plot.title.chars().count() as f64;
    round(left.min(fits.max(MARGIN)))
}

fn inside(plot: &Plot, layout: &Layout) -> Markup {
    let Layout { left, top, wide, high, height, .. } = *layout;
    let (right, bottom) = (left + wide, top + high);
    html! {
        rect class="ground" width=(plot.width) height=(height) fill=(LIGHT.ground) {}
        text class="title" x=(title_left(plot, left)) y="20" fill=(LIGHT.ink) font-size="14" font-weight="600" { (plot.title) }
        g class="ticks" {
            @for (value, words) in &layout.x.ticks {
                @let x = round(left + layout.x.place(*value) * wide);
                (grid(&format!("M{x} {top}V{bottom}")))
                text class="soft" x=(x) y=(bottom + 18.0) text-anchor="middle" fill=(LIGHT.soft) { (words) }
            }
            @for (value, words) in &layout.y.ticks {
                @let y = round(top + (1.0 - layout.y.place(*value)) * high);
                (grid(&format!("M{left} {y}H{right}")))
                text class="soft" x=(left - 8.0) y=(y + 4.0) text-anchor="end" fill=(LIGHT.soft) { (words) }
            }
        }
        path class="axis" d=(format!("M{left} {top}V{bottom}H{right}")) fill="none" stroke=(LIGHT.soft) {}
        text x=(left + wide / 2.0) y=(bottom + 38.0) text-anchor="middle" fill=(LIGHT.ink) { (plot.x.label) }
        text transform=(format!("translate(14 {}) rotate(-90)", top + high / 2.0)) text-anchor="middle" fill=(LIGHT.ink) {
            (plot.y.label)
        }
        @for (mark, (x, y)) in plot.marks.iter().zip(&layout.marks) {
            @let at = round(left + layout.x.place(mark.at) * wide);
            @let (class, colour) = match mark.colour {
                None => ("ink".to_owned(), LIGHT.soft),
                Some(colour) => (class(colour), LIGHT.series(colour)),
            };
            @if plot.x.holds(mark.at) && (left..=right).contains(&at) {
                path class={ "mark " (class) } d=(format!("M{at} {}V{bottom}", y + 4.0)) stroke=(colour)
                    stroke-dasharray="3 3" {}
                text x=(round(*x)) y=(y) text-anchor="middle" fill=(LIGHT.ink) { (mark.label) }
            }
        }
        // An svg within one cuts off what lies beyond it; a margin keeps signs on the border whole.
        svg x=(left - 5.0) y=(top - 5.0) width=(wide + 10.0) height=(high + 10.0)
            viewBox=(format!("{} {} {} {}", left - 5.0, top - 5.0, wide + 10.0, high + 10.0)) {
            @for series in &plot.series {
                g data-series=(series.name) {
                    @if let Some(style) = series.line { (line(series, style, &path(plot, series, layout))) }
                    @if let Some(marker) = series.marker {
                        @for (number, &(x, y)) in series.points.iter().enumerate().filter(|(_, p)| shown(plot, p)) {
                            (pointed(series.names.get(number), layout.at(x, y), sign(marker, layout.at(x, y), series.colour)))
                        }
                    }
                }
            }
        }
        (beside(plot, layout))
        g class="legend" {
            @for (series, &(x, y)) in plot.series.iter().zip(&layout.legend) {
                @if let Some(style) = series.line { (line(series, style, &format!("M{x} {}h{SAMPLE}", y - 4.0))) }
                @if let Some(marker) = series.marker {
                    (sign(marker, (x + SAMPLE / 2.0, y - 4.0), series.colour))
                }
                text x=(x + SAMPLE + 8.0) y=(y) fill=(LIGHT.ink) { (series.name) }
            }
        }
    }
}

/// The class of a series' colour, which the style sheet replaces in dark mode.
fn class(colour: usize) -> String {
    format!("c{}", LIGHT.place(colour))
}

fn grid(path: &str) -> Markup {
    html! { path class="grid" d=(path) fill="none" stroke=(LIGHT.grid) {} }
}

fn line(series: &Series, style: Line, path: &str) -> Markup {
    let (dashes, cap) = match style {
        Line::Solid => (None, None),
        Line::Dashed => (Some("8 4"), None),
        Line::Dotted => (Some("1.5 4"), Some("round")),
    };
    html! {
        path class={ "line " (class(series.colour)) " " (format!("{style:?}")) } d=(path) fill="none"
            stroke=(LIGHT.series(series.colour)) stroke-width="2" stroke-linejoin="round" stroke-dasharray=[dashes]
            stroke-linecap=[cap] {}
    }
}

/// A marker that shows its point's name on hover, if the point has one. A larger invisible area makes it easier to hit.
fn pointed(name: Option<&String>, (x, y): (f64, f64), sign: Markup) -> Markup {
    let Some(name) = name else { return sign };
    html! {
        g class="point" data-point=(name) tabindex="0" {
            title { (name) }
            circle class="around" cx=(round(x)) cy=(round(y)) r="8" fill="none" pointer-events="all" {}
            (sign)
        }
    }
}

/// The names beside points. Names of the first series are placed first.
fn beside(plot: &Plot, layout: &Layout) -> Markup {
    let named = plot.series.iter().flat_map(|series| series.points.iter().zip(&series.names));
    let points: Vec<(f64, f64, &str)> = named
        .filter(|(point, _)| shown(plot, point))
        .map(|(&(x, y), name)| (layout.at(x, y), name.as_str()))
        .map(|((x, y), name)| (x, y, name))
        .collect();
    let within = [layout.left + 2.0, layout.top + 2.0, layout.left + layout.wide - 2.0, layout.top + layout.high - 2.0];
    let joined = plot.series.iter().filter(|series| series.line.is_some()).flat_map(|series| series.points.windows(2));
    let both_shown = joined.filter(|two| two.iter().all(|point| shown(plot, point)));
    let lines: Vec<names::Stroke> =
        both_shown.map(|two| [layout.at(two[0].0, two[0].1), layout.at(two[1].0, two[1].1)]).collect();
    let places = names::place(&points, &lines, within);
    html! {
        g class="names" {
            @for ((_, _, name), place) in points.iter().zip(places) {
                @if let Some((x, y)) = place {
                    // Drawn twice: the halo separates the name from lines, also in viewers without `paint-order`.
                    text class="halo" aria-hidden="true" x=(round(x)) y=(round(y)) fill=(LIGHT.ground)
                        stroke=(LIGHT.ground) stroke-width="3" font-size="11" { (name) }
                    text x=(round(x)) y=(round(y)) fill=(LIGHT.ink) font-size="11" { (name) }
                }
            }
        }
    }
}

/// A tenth of a pixel is enough, and keeps files short.
fn round(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

fn shown(plot: &Plot, &(x, y): &(f64, f64)) -> bool {
    plot.x.holds(x) && plot.y.holds(y)
}

fn path(plot: &Plot, series: &Series, layout: &Layout) -> String {
    let mut path = String::new();
    let mut pen_down = false;
    for point in &series.points {
        if !shown(plot, point) {
            pen_down = false;
            continue;
        }
        let (x, y) = layout.at(point.0, point.1);
        path.push_str(&format!("{}{} {}", if pen_down { 'L' } else { 'M' }, round(x), round(y)));
        pen_down = true;
    }
    path
}

fn sign((marker, hollow): (Marker, bool), (x, y): (f64, f64), colour: usize) -> Markup {
    let (x, y) = (round(x), round(y));
    let class = format!("sign {} {}", if hollow { "hollow" } else { "full" }, class(colour));
    let stroke = LIGHT.series(colour);
    let fill = if hollow { LIGHT.ground } else { stroke };
    let corners = match marker {
        Marker::Circle => {
            return html! { circle class=(class) cx=(x) cy=(y) r="3.5" fill=(fill) stroke=(stroke) stroke-width="1.5" {} };
        }
        Marker::Square => "m-3.2 -3.2h6.4v6.4h-6.4z",
        Marker::Diamond => "m0 -4.4l4.4 4.4l-4.4 4.4l-4.4 -4.4z",
        Marker::Triangle => "m0 -4.4l4.2 7.4h-8.4z",
    };
    html! { path class=(class) d=(format!("M{x} {y}{corners}")) fill=(fill) stroke=(stroke) stroke-width="1.5" {} }
}
