//! The table for people: one row per configuration, with each time relative to that of `paper`.

use super::{Point, Study};
use crate::report::table::{grouped, table as drawn};

/// The profile that times are relative to.
pub(super) const BASE: &str = "paper";
/// Times over a link that differ by less than this share count as equal, because the link stalls at random, and
/// differently at another clock.
const SAME: f64 = 0.05;
/// A configuration is link-bound if its time per pair is at most this share above the link limit.
const LIMITED: f64 = 0.09;

/// The table, with a legend below it.
pub fn table(results: &Study) -> String {
    let has_areas = results.has_areas();
    let mut heading = vec!["", "wrong", "gross", "worst error", "mean error", "latency, ns", "×", "link, ns", "×"];
    if has_areas {
        heading.extend(["device, ns", "×", "LUT"]);
    }
    heading.push("at the link");
    let base = results.point(BASE);
    // A point that was not routed is compared with the base at its own modelled clock.
    let unrouted = base.map(Point::unrouted);
    let alike = |point: &Point| if point.routed_mhz().is_some() { base } else { unrouted.as_ref() };
    let rows = results.points.iter().map(|point| row(results, point, alike(point), has_areas));
    let scenes = results.scenes().join(" and ");
    let (device, luts) = match has_areas {
        true => (format!("; device: on a {} full of SCPUs", results.target.device()), " LUT: per SCPU."),
        false => (String::new(), ""),
    };
    let mut text = format!(
        "{}\n\
         wrong: decisions, of {} pairs; gross: gross failures. Errors are relative, of {scenes}. Latency: a single pair, line\n\
         in to line out; a pair over link {}{device}. ×: to {BASE}.{luts}\n",
        drawn(&heading, rows),
        grouped(results.pairs()),
        results.link,
    );
    text += if results.points.iter().any(|point| point.routed_mhz().is_some()) {
        "Clocks come from place and route, or from the delay model for what was not routed.\n"
    } else {
        "Clocks come from the delay model: nothing was placed and routed.\n"
    };
    results.left_out.iter().for_each(|what| text += &format!("left out: {what}\n"));
    text.trim_end().to_owned()
}

fn row(results: &Study, point: &Point, base: Option<&Point>, has_areas: bool) -> Vec<String> {
    let times = |time: &dyn Fn(&Point) -> Option<f64>| {
        let mine = time(point);
        let ratio = mine.zip(base.and_then(time)).map(|(mine, base)| mine / base);
        let show = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2}"));
        [show(mine), show(ratio)]
    };
    let mut cells = vec![
        point.name.clone(),
        grouped(point.wrong()),
        grouped(point.tally().bad),
        format!("{:.1e}", results.worst(point)),
        format!("{:.1e}", results.typical(point)),
    ];
    cells.extend(times(&|point| Some(point.lone_ns())));
    cells.extend(times(&|point| Some(point.link_ns())));
    if has_areas {
        cells.extend(times(&|point| point.device_ns(results.target)));
        cells.push(point.area().map_or("-".to_owned(), |area| grouped(area.luts)));
    }
    cells.push(base.map_or_else(String::new, |base| at_the_link(point, base)));
    cells
}

/// The cost of a point over a link, compared with `base`.
pub(super) fn at_the_link(point: &Point, base: &Point) -> String {
    let ratio = point.link_ns() / base.link_ns();
    let hidden = |point: &Point| point.cycles.link <= point.cycles.link_limit * (1.0 + LIMITED);
    if point.name == base.name {
        return String::new();
    }
    if (ratio - 1.0).abs() > SAME {
        return format!("{ratio:.2} × the time");
    }
    let why = if hidden(point) { "no slower: link-bound" } else { "no slower" };
    let Some((mine, base)) = point.area().zip(base.area()) else { return why.to_owned() };
    match mine.luts.checked_sub(base.luts) {
        Some(0) => why.to_owned(),
        Some(more) => format!("{why}; costs {} LUT", grouped(more)),
        None => format!("{why}; saves {} LUT", grouped(base.luts - mine.luts)),
    }
}

#[cfg(test)]
mod tests {
    use super::{BASE, Point, table};
    use crate::accuracy::trade::committed;

    #[test]
    fn a_row_is_compared_with_what_is_of_its_kind() {
        let mut results = committed().expect("results");
        let base = results.point(BASE).expect("what is compared with").clone();
        assert!(base.routed_mhz().is_some() && base.unrouted().clock_mhz() != base.clock_mhz());
        results.points = [("unrouted", base.unrouted()), ("routed", base.clone())]
            .map(|(name, point)| Point { name: name.to_owned(), ..point })
            .into();
        results.points.push(base);
        let text = table(&results);
        let rows: Vec<&str> = text.lines().filter(|line| line.contains("routed ")).collect();
        assert_eq!(rows.len(), 2, "{text}");
        assert!(rows.iter().all(|row| row.matches(" 1.00 ").count() == 3 && row.contains("no slower")), "{text}");
    }
}
