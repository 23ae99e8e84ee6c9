//! `report.html` of a sweep with spheres: time and candidates over each option that was varied, and over LUTs.

use maud::html;

use super::{Size, SpheresRow, SweepResults};
use crate::plot::{Axis, Line, Marker, Plot, Scale, Series};
use crate::report::page::{self, table};
use crate::report::table::grouped;

/// An option that a sweep varies.
struct Varied {
    name: &'static str,
    scale: Scale,
    of: fn(&Size) -> Option<u32>,
    /// A size without it: what its line is named by.
    without: fn(Size) -> Size,
}

const OPTIONS: [Varied; 5] = [
    Varied {
        name: "bits of a box",
        scale: Scale::Linear,
        of: |size| size.box_bits,
        without: |size| Size { box_bits: None, ..size },
    },
    Varied { name: "lanes", scale: Scale::Log, of: |size| size.lanes, without: |size| Size { lanes: None, ..size } },
    Varied {
        name: "deciders",
        scale: Scale::Log,
        of: |size| size.deciders,
        without: |size| Size { deciders: None, ..size },
    },
    Varied { name: "SCPUs", scale: Scale::Linear, of: |size| size.scpus, without: |size| Size { scpus: None, ..size } },
    Varied {
        name: "interval",
        scale: Scale::Linear,
        of: |size| size.interval,
        without: |size| Size { interval: None, ..size },
    },
];

/// The page.
pub(super) fn page(results: &SweepResults) -> String {
    let config = &results.config;
    let candidates = |row: &SpheresRow| row.candidates_per_sphere;
    let rows: Vec<_> = results.of_spheres().map(|row| row.cells().into()).collect();
    let body = html! {
        p { "The same search on accelerators of different sizes: " (results.spheres) " over the link " code { (results.link) }
            ", seed " (results.seed) ", " (config.profile.to_string()) " arithmetic at " (config.clock_mhz) " MHz, table of "
            (grouped(config.search.table.into())) " spheres. "
            "Cycles are simulated; every contact was compared with the search in software." }
        @for option in varied(results) {
            (page::figure(&over(results, option, "ns per sphere", |row| row.ns_per_sphere, Some(model))))
            @if option.name == OPTIONS[0].name {
                (page::figure(&over(results, option, "candidates per sphere", candidates, None)))
            }
        }
        p { "Dotted lines are the cycle model’s, over the same link. Fewer bits of a box make more "
            "candidates and the same contacts." }
        @if let Some(plot) = area(results) {
            (page::figure(&plot))
            p { "LUTs are those of the whole accelerator on an ECP5, as Yosys counts them." }
        }
        (super::page::end(results, table("", &SpheresRow::HEADING, 0, &rows)))
    };
    page::page("Search by its sizes", &body)
}

/// Nanoseconds per sphere that the model predicts.
fn model(row: &SpheresRow) -> Option<f64> {
    row.ns_per_sphere.map(|ns| ns * row.predicted_cycles as f64 / row.cycles.max(1) as f64)
}

/// The options that take more than one value; the first option, if each takes one.
fn varied(results: &SweepResults) -> Vec<&'static Varied> {
    let is_varied = |option: &&Varied| {
        let mut values = results.of_spheres().filter_map(|row| (option.of)(&row.size()));
        let first = values.next();
        values.any(|value| Some(value) != first)
    };
    let varied: Vec<_> = OPTIONS.iter().filter(is_varied).collect();
    if varied.is_empty() { vec![&OPTIONS[0]] } else { varied }
}

/// The time over the first option that was varied.
pub(super) fn times(results: &SweepResults) -> Plot {
    over(results, varied(results)[0], "ns per sphere", |row| row.ns_per_sphere, Some(model))
}

/// Something over an option, a line for all rows that differ in this option alone.
fn over(
    results: &SweepResults,
    option: &Varied,
    label: &str,
    value: impl Fn(&SpheresRow) -> Option<f64>,
    model: Option<fn(&SpheresRow) -> Option<f64>>,
) -> Plot {
    let title = format!("{} by {}", label, option.name);
    let mut plot = Plot::new(&title, Axis::new(option.name, option.scale), Axis::new(label, Scale::Linear));
    let line_of = |row: &SpheresRow| (option.without)(row.size());
    let mut lines: Vec<Size> = Vec::new();
    for row in results.of_spheres() {
        if !lines.contains(&line_of(row)) {
            lines.push(line_of(row));
        }
    }
    for (colour, line) in lines.into_iter().enumerate() {
        let mut rows: Vec<_> = results.of_spheres().filter(|row| line_of(row) == line).collect();
        rows.sort_by_key(|row| (option.of)(&row.size()));
        let points = |value: &dyn Fn(&SpheresRow) -> Option<f64>| -> Vec<(f64, f64)> {
            rows.iter().filter_map(|row| Some(((option.of)(&row.size())?.into(), value(row)?))).collect()
        };
        let name = line.title();
        plot = plot.with(Series::new(&name, colour, points(&value)).line(Line::Solid).marker(Marker::Circle));
        if let Some(model) = model {
            plot = plot.with(Series::new(&format!("{name}, model"), colour, points(&model)).line(Line::Dotted));
        }
    }
    plot
}

/// The time over LUTs, if any were counted.
fn area(results: &SweepResults) -> Option<Plot> {
    let point = |row: &SpheresRow| Some((row.luts? as f64, row.ns_per_sphere?));
    let points: Vec<_> = results.of_spheres().filter_map(point).collect();
    let axes = (Axis::new("LUTs of the whole", Scale::Linear), Axis::new("ns per sphere", Scale::Linear));
    (!points.is_empty()).then(|| {
        let names = results.of_spheres().filter(|row| point(row).is_some()).map(|row| row.size().title());
        let series = Series::new("rows", 0, points).marker(Marker::Circle).named(names);
        Plot::new("Time over area", axes.0, axes.1).with(series)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Config, Input, Shell};
    use crate::link::LinkModel;
    use crate::spheres::Spheres;
    use crate::sweep::{Job, Row, Swept, Task};

    fn results(luts: Option<u64>) -> SweepResults {
        let row = |lanes, box_bits, candidates| {
            let row = SpheresRow::example(lanes, box_bits, candidates);
            Row::Spheres(SpheresRow { luts, ffs: luts, dsps: luts, brams: luts, ..row })
        };
        let config = Config { input: Input::Spheres, shell: Shell::Line, ..Config::default() };
        let sets = Spheres::default();
        let task = Task { job: Job::Spheres(&sets), link: &LinkModel::ideal(), seed: 1, counts: luts.is_some() };
        let swept = Swept { lanes: vec![16, 32], deciders: vec![4], box_bits: vec![24, 10], ..Swept::default() };
        let mut results = SweepResults::new("diamond:5", "ideal", &task, &config, swept);
        results.rows = vec![row(16, 24, 50), row(16, 10, 90), row(32, 24, 50), row(32, 10, 90)];
        results
    }

    #[test]
    fn a_line_is_all_that_differs_in_one_option() {
        let results = results(Some(7));
        let [bits, lanes] = varied(&results)[..] else { panic!("two are varied") };
        assert_eq!((bits.name, lanes.name), ("bits of a box", "lanes"));
        let plot = times(&results);
        assert_eq!(plot.series.len(), 4, "two lines, and the model's: {plot:?}");
        let line = |name: &str, y| Series::new(name, 0, [(10.0, y), (24.0, y)]);
        let name = "16 lanes, 4 deciders";
        assert_eq!(plot.series[0], line(name, 20.0).line(Line::Solid).marker(Marker::Circle));
        assert_eq!(plot.series[1], line(&format!("{name}, model"), 10.0).line(Line::Dotted));
        let text = page(&results);
        for words in ["candidates per sphere by bits of a box", "ns per sphere by lanes", "LUTs of the whole"] {
            assert!(text.contains(words), "{words}");
        }
        assert!(area(&self::results(None)).is_none() && !text.contains("NaN"));
    }

    #[test]
    fn another_sweep_of_spheres_is_told_apart() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let folder = room.path().join("out");
        let base = results(None);
        base.save(&folder).expect("written");
        base.check(&folder, false).expect("ours");
        let csv = std::fs::read_to_string(folder.join("sweep.csv")).expect("written");
        assert!(csv.starts_with("lanes,deciders,box_bits,scpus,interval,spheres,candidates,"), "{csv}");
        assert_eq!(csv.lines().count(), 5, "{csv}");
        let fewer = Swept { box_bits: vec![24], ..base.swept.clone() };
        for (other, words) in [
            (SweepResults { spheres: "diamond:6".to_owned(), ..base.clone() }, "of diamond:5, not diamond:6;"),
            (SweepResults { spheres_sha256: "ab".to_owned(), ..base.clone() }, "diamond:5 as it was before"),
            (SweepResults { swept: fewer, ..base.clone() }, "now (16 lanes, 4 deciders, boxes of 10 bits; 32 lanes"),
        ] {
            let refused = other.check(&folder, false).expect_err("another").to_string();
            assert!(refused.contains(words), "{words}: {refused}");
        }
    }
}
