//! `report.html`: throughput over SCPUs, and over LUTs where they were counted, beside the limits that apply.

use std::collections::BTreeMap;

use maud::{Markup, html};

use super::{PairsRow, SweepResults};
use crate::plot::{Axis, Line, Marker, Plot, Scale, Series};
use crate::report::page::{self, table};
use crate::report::table::{figure, grouped};

const LINK: usize = 5;

/// The page.
pub(super) fn page(results: &SweepResults) -> String {
    let config = &results.config;
    let body = html! {
        p { "The same job on accelerators of different sizes: " (results.pairs) " over the link " code { (results.link) }
            ", seed " (results.seed) ", " (config.profile.to_string()) " arithmetic at " (config.clock_mhz) " MHz. "
            "Cycles are simulated; every contact was compared with the reference kernel." }
        (page::figure(&throughput(results)))
        p { "Dotted lines are the paper’s law: N SCPUs take 1/N of the time of one (section III.E). Here that is one pair per "
            "interval and SCPU. The dashed line is the link limit. The law holds until bandwidth or the number of "
            "reads in flight limits the accelerator; more SCPUs then only wait." }
        @if let Some(plot) = area(results) {
            (page::figure(&plot))
            p { "LUTs are those of all SCPUs on an ECP5, as Yosys counts them; controller and shell are not included." }
        }
        (end(results, rows(results)))
    };
    page::page("Throughput by number of SCPUs", &body)
}

/// The end of a sweep's page: its rows, and what is missing.
pub(super) fn end(results: &SweepResults, rows: Markup) -> Markup {
    html! {
        h2 { "Rows" }
        (rows)
        @if !results.missing.is_empty() { p { b { "Missing: " } (results.missing.join("; ")) "." } }
        p.soft { code { "sweep.csv" } " has every column, " code { "manifest.json" } " the configuration." }
    }
}

/// Pairs per second over SCPUs: one line per interval, with its law and the link limit.
pub(super) fn throughput(results: &SweepResults) -> Plot {
    let axes = (Axis::new("SCPUs", Scale::Linear), Axis::new("million pairs per second", Scale::Linear));
    let mut plot = Plot::new("Throughput", axes.0, axes.1);
    let ceiling: Vec<(f64, f64)> = by_interval(results).into_values().flatten().filter_map(limit).collect();
    let most = ceiling.iter().map(|point| point.1).fold(0.0, f64::max);
    for (colour, (interval, rows)) in by_interval(results).into_iter().enumerate() {
        let reached = rows.iter().map(|row| (f64::from(row.scpus), row.pairs_per_second.map_or(f64::NAN, |p| p / 1e6)));
        let reached = Series::new(&name(interval), colour, reached).line(Line::Solid).marker(Marker::Circle);
        // Above the link limit the law says nothing that could be reached, and would shrink the rest of the plot.
        let law =
            |row: &&PairsRow| (f64::from(row.scpus), f64::from(row.scpus) * row.clock_mhz / f64::from(row.interval));
        let law = rows.iter().map(law).filter(|&(_, pairs)| most == 0.0 || pairs <= 1.3 * most);
        plot = plot.with(reached);
        plot = plot
            .with(Series::new(&format!("{}, N/{interval} per cycle", name(interval)), colour, law).line(Line::Dotted));
    }
    plot.with(Series::new("link limit", LINK, sorted(ceiling)).line(Line::Dashed))
}

/// Pairs per second over LUTs, if any were counted.
pub(super) fn area(results: &SweepResults) -> Option<Plot> {
    results.of_pairs().any(|row| row.scpu_luts.is_some()).then(|| {
        let axes =
            (Axis::new("LUTs of all SCPUs", Scale::Linear), Axis::new("million pairs per second", Scale::Linear));
        let mut plot = Plot::new("Throughput over area", axes.0, axes.1);
        for (colour, (interval, rows)) in by_interval(results).into_iter().enumerate() {
            let point = |row: &&PairsRow| {
                let luts = row.scpu_luts? * u64::from(row.scpus);
                Some((luts as f64, row.pairs_per_second? / 1e6))
            };
            let points: Vec<_> = rows.iter().filter_map(point).collect();
            plot = plot.with(Series::new(&name(interval), colour, points).line(Line::Solid).marker(Marker::Circle));
        }
        plot
    })
}

fn name(interval: u32) -> String {
    format!("interval {interval}")
}

/// The rows of each interval, by their number of SCPUs.
fn by_interval(results: &SweepResults) -> BTreeMap<u32, Vec<&PairsRow>> {
    let mut all: BTreeMap<u32, Vec<&PairsRow>> = BTreeMap::new();
    for row in results.of_pairs() {
        all.entry(row.interval).or_default().push(row);
    }
    all.values_mut().for_each(|rows| rows.sort_by_key(|row| row.scpus));
    all
}

/// The link limit of a row, in million pairs per second.
fn limit(row: &PairsRow) -> Option<(f64, f64)> {
    let share = row.efficiency.filter(|share| *share > 0.0)?;
    Some((f64::from(row.scpus), row.pairs_per_second? / share / 1e6))
}

/// Points in their order, one per place: the same AFU at two intervals has the same limit.
fn sorted(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by_key(|point| point.0);
    points
}

fn rows(results: &SweepResults) -> Markup {
    let counted = results.of_pairs().any(|row| row.scpu_luts.is_some());
    let heading = ["SCPUs", "interval", "M pairs/s", "share of the link limit", "latency, cycles", "cycles per pair"];
    let area = counted.then_some(["LUT per SCPU", "DSP per SCPU"]);
    let heading = heading.into_iter().chain(area.into_iter().flatten()).chain(["mismatches"]);
    let count = |count: Option<u64>| count.map_or_else(|| "–".to_owned(), grouped);
    let row = |row: &PairsRow| {
        let figures = [
            row.scpus.to_string(),
            row.interval.to_string(),
            figure(row.pairs_per_second.map(|pairs| pairs / 1e6), 1),
            row.efficiency.map_or_else(|| "–".to_owned(), |share| format!("{:.1} %", 100.0 * share)),
            count(row.latency_cycles),
            figure(row.cycles_per_pair, 3),
        ];
        let area = counted.then(|| [count(row.scpu_luts), count(row.scpu_dsps)]);
        figures.into_iter().chain(area.into_iter().flatten()).chain([grouped(row.mismatches)]).collect()
    };
    table("", &heading.collect::<Vec<_>>(), 0, &results.of_pairs().map(row).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::link::LinkModel;
    use crate::sweep::{Job, Row, Swept, Task};

    fn results(luts: Option<u64>) -> SweepResults {
        let row = |scpus: u32, pairs_per_second: f64| PairsRow {
            scpus,
            interval: 4,
            pairs: 100,
            contacts: 30,
            mismatches: 0,
            failed_checks: 0,
            cycles: 100,
            cycles_per_pair: Some(1.0),
            pairs_per_second: Some(pairs_per_second),
            efficiency: Some(pairs_per_second / 4e8),
            bytes_read: 3200,
            bytes_written: 3200,
            latency_cycles: Some(80),
            clock_mhz: 200.0,
            scpu_luts: luts,
            scpu_ffs: luts,
            scpu_dsps: luts,
            rtl_sha256: String::new(),
        };
        let task = Task { job: Job::Pairs(&[]), link: &LinkModel::ideal(), seed: 1, counts: luts.is_some() };
        let swept = Swept { scpus: vec![2, 1], interval: vec![4], ..Swept::default() };
        let mut results = SweepResults::new("random:100", "ideal", &task, &Config::default(), swept);
        results.rows = vec![Row::Pairs(row(2, 98e6)), Row::Pairs(row(1, 49e6))];
        results
    }

    #[test]
    fn area_is_drawn_where_it_was_counted() {
        let plot = area(&results(Some(5_000))).expect("counted");
        assert!(plot.svg().contains("LUTs of all SCPUs"));
        assert_eq!(
            plot.series[0],
            Series::new("interval 4", 0, [(5e3, 49.0), (1e4, 98.0)]).line(Line::Solid).marker(Marker::Circle)
        );
        assert!(area(&results(None)).is_none() && !page(&results(None)).contains("LUT"));
        assert!(page(&results(Some(5_000))).contains("LUT per SCPU"));
    }

    #[test]
    fn the_law_and_the_link_limit_are_beside_what_was_reached() {
        let plot = throughput(&results(None));
        let [reached, law, link] = &plot.series[..] else { panic!("three series: {plot:?}") };
        assert_eq!(
            *reached,
            Series::new("interval 4", 0, [(1.0, 49.0), (2.0, 98.0)]).line(Line::Solid).marker(Marker::Circle)
        );
        assert_eq!(*law, Series::new("interval 4, N/4 per cycle", 0, [(1.0, 50.0), (2.0, 100.0)]).line(Line::Dotted));
        assert_eq!(*link, Series::new("link limit", LINK, [(1.0, 400.0), (2.0, 400.0)]).line(Line::Dashed));
    }
}
