//! `docs/interval.md`: the area of an SCPU at each interval, as a table and a picture.

use std::collections::BTreeMap;

use super::table::figure;
use crate::plot::{Axis, Line, Marker, Plot, Scale, Series};
use crate::synth::{Area, Figures};

/// The figures of an SCPU at one interval.
#[derive(Default)]
struct Row<'a> {
    counted: Option<&'a Figures>,
    routed: Option<&'a Figures>,
}

fn rows(all: &[Figures]) -> BTreeMap<u32, Row<'_>> {
    let mut rows: BTreeMap<u32, Row<'_>> = BTreeMap::new();
    for figures in all {
        let Some(interval) = figures.interval else { continue };
        let row = rows.entry(interval).or_default();
        match figures.clock_mhz {
            None => row.counted = Some(figures),
            Some(_) => row.routed = Some(figures),
        }
    }
    rows
}

const ABOUT: &str = "# Area by interval

`scripts/intervals` makes this page. For each interval it runs `afu synth --kernel --interval II --no-route --json FILE`, and \
the same with place and route where asked, and passes the JSON to `afu synth --intervals`.

An SCPU at interval II takes a pair every II cycles, and has as few operators as that allows:

- Operations are placed by modulo scheduling. Sums, differences and sums of magnitudes take turns in one adder; products \
and squares take turns in one multiplier where that is smaller.
- Values that wait are stored once in II cycles.
- Root and reciprocal compute one or a few digits per cycle, in stages that hold a number for up to II cycles.

N SCPUs take N/II pairs per cycle, and never more than one line of pairs per cycle.

![LUTs, flip-flops and DSPs of an SCPU by interval](img/interval.svg)

";

/// The page with the figures of an SCPU, which may be in any order: counted ones, and routed ones if there are any.
pub fn page(all: &[Figures]) -> String {
    let rows = rows(all);
    let mut page = ABOUT.to_owned();
    let first = all.first();
    let (target, profile) = first.map(|of| (of.target.to_string(), of.profile.to_string())).unwrap_or_default();
    page += &format!(
        "One SCPU, {profile}, {target}. Cells as Yosys counts them, the wrapper's subtracted; shares are of interval 1.\n\n"
    );
    page += "| interval | cut for MHz | cycles | LUT | share | FF | share | DSP | BRAM | routed LUT | share | routed MHz |\n";
    page += "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    let base = rows.get(&1);
    let share = |area: Option<Area>, base: Option<Area>, of: fn(&Area) -> u64| {
        let ratio =
            area.zip(base).filter(|(_, base)| of(base) > 0).map(|(area, base)| of(&area) as f64 / of(&base) as f64);
        figure(ratio, 2)
    };
    for (interval, row) in &rows {
        let counted = row.counted.map(|of| of.area);
        let routed = row.routed.map(|of| of.area);
        let base_counted = base.and_then(|row| row.counted).map(|of| of.area);
        let base_routed = base.and_then(|row| row.routed).map(|of| of.area);
        let number = |area: Option<Area>, of: fn(&Area) -> u64| {
            area.map_or_else(|| "-".to_owned(), |area| of(&area).to_string())
        };
        let any = row.counted.or(row.routed);
        let cells = [
            interval.to_string(),
            figure(any.map(|of| of.asked_mhz), 0),
            any.and_then(|of| of.latency_cycles).map_or_else(|| "-".to_owned(), |cycles| cycles.to_string()),
            number(counted, |area| area.luts),
            share(counted, base_counted, |area| area.luts),
            number(counted, |area| area.ffs),
            share(counted, base_counted, |area| area.ffs),
            number(counted, |area| area.dsps),
            number(counted, |area| area.brams),
            number(routed, |area| area.luts),
            share(routed, base_routed, |area| area.luts),
            figure(row.routed.and_then(|of| of.clock_mhz), 0),
        ];
        page += &format!("| {} |\n", cells.join(" | "));
    }
    for (interval, row) in &rows {
        if let Some(routed) = row.routed {
            let path: Vec<String> = routed.critical.iter().map(|hop| format!("`{}`", hop.signal)).collect();
            page += &format!("\nCritical path at interval {interval}: {}.\n", path.join(" → "));
        }
    }
    page
}

/// Plots the area over the interval, relative to the area at interval 1.
pub fn picture(all: &[Figures]) -> Plot {
    let rows = rows(all);
    let counted = |row: &Row<'_>| row.counted.or(row.routed).map(|of| of.area);
    let base = rows.get(&1).and_then(counted);
    let points = |of: fn(&Area) -> u64| -> Vec<(f64, f64)> {
        let share =
            |row: &Row<'_>| counted(row).zip(base).map(|(area, base)| of(&area) as f64 / of(&base).max(1) as f64);
        rows.iter().filter_map(|(interval, row)| Some((f64::from(*interval), share(row)?))).collect()
    };
    let even = rows.keys().map(|interval| (f64::from(*interval), 1.0 / f64::from(*interval)));
    let longest = rows.keys().last().map_or(1.0, |interval| f64::from(*interval));
    let series = |name, colour, points: Vec<(f64, f64)>| {
        Series::new(name, colour, points).line(Line::Solid).marker(Marker::Circle)
    };
    Plot::new(
        "An SCPU's area by interval",
        Axis::new("interval, cycles", Scale::Log).with_range(1.0, longest),
        Axis::new("share of interval 1", Scale::Linear).with_range(0.0, 1.0),
    )
    .with(series("LUTs", 0, points(|area| area.luts)))
    .with(series("flip-flops", 1, points(|area| area.ffs)))
    .with(series("DSPs", 2, points(|area| area.dsps)))
    .with(Series::new("1 / interval", 5, even).line(Line::Dotted))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(interval: u32, luts: u64, clock_mhz: Option<f64>) -> Figures {
        let area = |luts: u64| serde_json::json!({"luts": luts, "ffs": 2 * luts, "dsps": 33 / interval, "brams": 0});
        let mut json = serde_json::json!({
            "schema": "contact-afu/synth/1", "version": "0", "unit": "scpu", "profile": "wide", "interval": interval,
            "module": "scpu", "target": "ecp5", "asked_mhz": 200.0, "modelled_mhz": 201.0, "clock_mhz": clock_mhz,
            "latency_cycles": 70, "latency_ns": null, "wrapper": area(1), "trimmed": {"inputs": 0, "outputs": 0}, "seeds": [], "critical": [],
            "verilog_sha256": "", "tools": {"yosys": "0", "nextpnr": null}
        });
        let own = area(luts);
        own.as_object().expect("an object").iter().for_each(|(key, value)| json[key] = value.clone());
        serde_json::from_value(json).expect("figures")
    }

    #[test]
    fn shares_are_of_interval_1() {
        let all = [
            figures(8, 300, None),
            figures(1, 1000, None),
            figures(1, 1100, Some(190.0)),
            figures(8, 330, Some(210.0)),
        ];
        let page = page(&all);
        assert!(page.contains("| 1 | 200 | 70 | 1000 | 1.00 | 2000 | 1.00 | 33 | 0 | 1100 | 1.00 | 190 |"), "{page}");
        assert!(page.contains("| 8 | 200 | 70 | 300 | 0.30 | 600 | 0.30 | 4 | 0 | 330 | 0.30 | 210 |"), "{page}");
        let svg = picture(&all).svg();
        assert!(svg.contains("flip-flops"));
        crate::plot::overlap::check(&svg);
    }
}
