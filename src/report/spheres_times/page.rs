//! `report.html`: the pictures, the tables, and how they came about.

use maud::{Markup, html};

use super::columns::Kind;
use super::figures::{Family, figure};
use super::output::{cells, goal_cells};
use super::{Settings, Times};
use crate::report::page::{self, table};
use crate::report::table::{counted, grouped};

/// The text of the page.
pub(super) fn page(times: &Times) -> String {
    let goals = times.goals();
    let body = html! {
        p { "Spheres in memory, and all pairs of them that touch: how long that takes in software on one thread, and in the "
            "simulated AFU. Every hit and contact that the AFU wrote was compared with the software, bit for bit." }
        (legend(&times.settings))
        @for family in Family::ALL {
            @if let Some(plot) = figure(times, family) { (page::figure(&plot)) }
        }
        h2 { "Times" }
        (rows(times, "Simulated: the AFU, ns per sphere", true, &[Kind::Simulated]))
        (rows(times, "Measured: software, ns per sphere", false, &[Kind::Measured]))
        (rows(times, "The AFU’s time as a share of others’, and the share of the link limit that it reaches", false, &[Kind::Share]))
        @if !goals.is_empty() {
            @let (heading, lines) = goal_cells(&goals);
            (table("Goals", &heading, 2, &lines))
        }
        h2 { "How it was done" }
        (method(&times.settings))
    };
    page::page("Spheres in, contacts out: times", &body)
}

fn rows(times: &Times, caption: &str, with_counts: bool, kinds: &[Kind]) -> Markup {
    let (heading, lines) = cells(&times.rows, with_counts, kinds);
    // The stars are Markdown's.
    let heading: Vec<_> = heading.iter().map(|name| name.trim_matches('*')).collect();
    table(caption, &heading, 1, &lines)
}

fn legend(settings: &Settings) -> Markup {
    html! {
        p { b { "Solid" } " lines were measured on this machine (" (settings.processor) ", " (settings.level) ", one thread), "
            b { "dashed" } " ones were simulated: cycles of the Verilog, converted to time at an assumed " (settings.clock_mhz)
            " MHz over the link model " code { (settings.link) } ". " b { "Measured and simulated times are not directly comparable" }
            ": nothing here has run on a board." }
    }
}

fn method(s: &Settings) -> Markup {
    // A sphere is 16 bytes, and each decider keeps those of its columns.
    let mbit = f64::from(s.table) * 128.0 / 1e6;
    html! {
        ul {
            li { "Each pass begins with the spheres in memory, in the order of a Hilbert curve, and finds every contact. Sorting "
                "along the curve is a column of its own: the AFU and the search need it, as seldom as the host likes." }
            li { "Measured times are the median of several passes. If the first pass takes more than three seconds, it is the "
                "only one. If other work ran on the machine, compare within a row." }
            li { "Numbers are the two spheres of each contact; contacts are depth, normal and position too." }
            li { "Cells: a list of cells as wide as the largest sphere, built in each pass, with 16 distances at a time where the "
                "processor has AVX-512; contacts by the f32 kernel in batch." }
            li { "ODE: the near callback with dCollide. The spheres stand in its space before the first pass and do not move. "
                "ODE takes no points, so it has no times for probes." }
            li { "AFU: spheres in; a table of " (grouped(s.table.into())) " spheres (" (format!("{mbit:.1}")) " Mbit of block RAM for the "
                "deciders, and as much again where contacts come back), " (s.lanes) " lanes, " (s.deciders) " deciders; contacts by "
                (counted(s.scpus.into(), "SCPU")) " at interval 1. Loading and draining are counted." }
            li { "AFU, pairs: the AFU that is sent pairs (" (counted(s.pair_scpus.into(), "SCPU")) " at interval " (s.pair_interval)
                ") gets those that the cell list finds. The time to find them is not included." }
        }
        pre { (s.command) }
        p.soft { "Verilog SHA-256: numbers " code { (s.rtl_sha256[0]) } ", contacts " code { (s.rtl_sha256[1]) } ", pairs "
            code { (s.rtl_sha256[2]) } "; seed " (s.seed) "." }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;
    use super::*;

    #[test]
    fn the_page_has_pictures_tables_and_goals_and_loads_nothing() {
        let page = page(&example());
        // Each picture is drawn for a wide and for a narrow screen.
        assert_eq!(page.matches("<svg class=\"plot\"").count(), 4);
        for text in [
            "a &lt;processor&gt;",
            "8.4 Mbit",
            "<td class=\"\">diamond:30+1000</td>",
            ">AFU, numbers<",
            ">missed<",
            "10 SCPUs at interval 5",
            "<pre>cargo bench",
        ] {
            assert!(page.contains(text), "{text}");
        }
        assert!(!page.contains("*AFU"), "no Markdown");
        for load in ["http:", "https:", "<script", "<link", "src=", "@import"] {
            assert!(!page.contains(load), "{load}");
        }
    }
}
