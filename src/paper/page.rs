//! `report.html`: the figures and their meaning.

use maud::{Markup, html};

use super::{Claim, Experiment, Joined, Published, Settings, Summary, figure6, figure7, per_collision};
use crate::report::page::{self, table};
use crate::report::table::{counted, grouped};

/// The text of the page.
pub fn page(results: &Experiment, claims: &[Claim], paper: &Published) -> String {
    let body = html! {
        p { "The experiment of “A hardware accelerator implementation for real-time collision detection” (Alves et al.), "
            "run again: collisions recorded in the Open Dynamics Engine, timed on this machine, and sent through the "
            "Verilog of the AFU in simulation. Every contact that the AFU wrote was compared with the reference kernel, "
            "bit for bit." }
        @if let Some(summary) = results.summary() { (sums(&summary, &results.settings, paper)) }
        h2 { "Figures" }
        (legend(&results.settings))
        (page::figure(&figure6(results)))
        // A run of a thousand collisions ends where this figure begins.
        @if results.figure7().len() > 1 { (page::figure(&figure7(results))) }
        (page::figure(&per_collision(results)))
        h2 { "What in the paper’s text is inconsistent" }
        (doubts(claims))
        h2 { "How it was done" }
        (method(results))
        h2 { "Points" }
        (points(results))
    };
    page::page("The paper’s Figures 6 and 7, run again", &body)
}

fn sums(s: &Summary, settings: &Settings, paper: &Published) -> Markup {
    let from = |at: Option<usize>| at.map_or("never".to_owned(), |at| grouped(at as u64));
    let row = |who: &str, how: String, ns: f64, gain: Option<f64>, crossover: String| {
        let gain = gain.map_or("–".to_owned(), |gain| format!("{gain:.2} ×"));
        vec![who.to_owned(), how, format!("{ns:.2}"), gain, crossover]
    };
    let measured = || "measured here".to_owned();
    let simulated = format!("simulated, {} at {} MHz", settings.link, settings.clock_mhz);
    let none = || "–".to_owned();
    let rows = [
        row("AFU with set-up", simulated, s.afu_ns, None, none()),
        row("ODE, paper’s rule", measured(), s.ode_rule_ns, Some(s.speed_up_over_rule), from(s.crossover_over_rule)),
        row("ODE, loop of calls", measured(), s.ode_loop_ns, Some(s.speed_up_over_loop), from(s.crossover_over_loop)),
        row("f32 kernel, batch", measured(), s.batch_ns, Some(s.speed_up_over_batch), from(s.crossover_over_batch)),
        row("AFU", "the paper’s text".to_owned(), paper.afu_ns, None, none()),
        row(
            "ODE",
            "the paper’s text".to_owned(),
            paper.ode_ns,
            Some(paper.ode_ns / paper.afu_ns),
            format!("{}", paper.crossover),
        ),
    ];
    let caption = format!("At {} collisions in one transaction", grouped(s.collisions as u64));
    html! {
        h2 { "Results" }
        (table(&caption, &["engine", "source", "ns per collision", "time over the AFU’s", "AFU faster from"], 2, &rows))
        p { "The link limit is " (format!("{:.2}", s.link_limit_ns)) " ns per collision. Without set-up, the AFU reaches "
            (format!("{:.1}", 100.0 * s.link_share)) " % of this limit. “AFU faster from” is the smallest "
            "number of collisions tried from which the AFU takes less time at every point. " b { "Measured and simulated times are "
            "not directly comparable" } ": the simulated clock and link are assumptions about hardware of 2014, and the "
            "measured processor is a different one." }
        p { "The AFU finds " (grouped(s.afu_contacts)) " contacts in the " (grouped(s.collisions as u64)) " collisions. It gets every number "
            "rounded to binary32, and spheres that touch with almost no depth may then be apart." }
        @if s.speed_up_over_batch < 1.0 {
            p { "The same arithmetic on this processor, in batch, is faster: the AFU takes "
                (format!("{:.1}", 1.0 / s.speed_up_over_batch)) " times as long. The AFU is link-bound, because the link carries "
                "64 bytes per collision." }
        }
    }
}

fn legend(settings: &Settings) -> Markup {
    html! {
        p { b { "Solid" } " lines were measured on this machine (" (settings.processor) "), " b { "dashed" } " ones were simulated: "
            "cycles of the Verilog, converted to time at an assumed " (settings.clock_mhz) " MHz over the link model "
            code { (settings.link) } ", with " (format!("{:.0}", settings.set_up_ns)) " ns of set-up and tear-down. "
            b { "Dotted" } " lines come from the paper’s text, not from its plots: 102 and 86 ns per collision, and the set-up "
            "time that its crossover implies." }
    }
}

fn doubts(claims: &[Claim]) -> Markup {
    let row = |claim: &Claim| {
        vec![claim.says.clone(), claim.place.to_owned(), claim.arithmetic.clone(), claim.follows.clone()]
    };
    let rows: Vec<_> = claims.iter().map(row).collect();
    table("", &["the paper says", "section", "arithmetic", "so"], 4, &rows)
}

fn method(results: &Experiment) -> Markup {
    let s = &results.settings;
    html! {
        ul {
            li { "Collisions: the first " (grouped(s.n_col_max as u64)) " " (s.t_col) " ones of the diamond with hMax " (s.h_max)
                " and dSph " (s.d_sph) ", from " (grouped(s.steps as u64)) " steps. The diamond is "
                "rebuilt every " (grouped(s.steps_of_a_run as u64)) " steps, because its spheres fly apart in the end. A transaction "
                "gathers the collisions of several steps." }
            li { "ODE, the paper’s rule: each collision executed " (s.executions) " times within the simulation, and the averages "
                "are added. Reading the clock takes " (s.clock_ns) " ns here, and each average includes a part of it." }
            li { "ODE, loop of calls: dCollide on all collisions one after the other, timed as a whole. The time is the shortest of "
                "several passes. The f32 kernel in batch is timed in the same way (" (s.level) ", one thread, its own layout)." }
            li { "AFU: " (counted(s.scpus.into(), "SCPU")) ", " (s.profile) " arithmetic, " (s.shell) " shell. The Verilog was simulated for "
                "every point. Up to 1000 collisions, a point is the average of " (s.transactions) " transactions; above, one "
                "transaction." }
        }
        pre { (s.command) }
        p.soft { "Verilog SHA-256 " code { (s.rtl_sha256) } ", seed " (s.seed) "." }
    }
}

fn points(results: &Experiment) -> Markup {
    let heading = [
        "collisions",
        "ODE, rule",
        "ODE, loop",
        "f32 batch",
        "f32 records",
        "AFU cycles",
        "AFU",
        "AFU with set-up",
        "link limit",
    ];
    let row = |p: &&Joined| {
        let us = |ns: f64| format!("{:.2}", ns / 1000.0);
        let times = [p.ode_rule_ns, p.ode_loop_ns, p.batch_ns, p.records_ns].map(us);
        let afu = [p.afu_ns, p.afu_total_ns, p.link_limit_ns].map(us);
        let mut row = vec![grouped(p.collisions as u64)];
        row.extend(times);
        row.push(format!("{:.1}", p.afu_cycles));
        row.extend(afu);
        row
    };
    let all: Vec<_> = results.points.iter().collect();
    html! {
        details {
            summary { (all.len()) " points, in µs; also in figure6.csv, figure7.csv and results.json" }
            (table("", &heading, 0, &all.iter().map(row).collect::<Vec<_>>()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::claims;
    use super::super::results::tests::example;
    use super::*;

    #[test]
    fn the_page_has_everything_and_loads_nothing() {
        let page = page(&example(), &claims(&Published::PAPER), &Published::PAPER);
        // Each of the three figures is drawn for a wide and for a narrow screen.
        assert_eq!(page.matches("<svg class=\"plot\"").count(), 6);
        for text in ["4.98 ×", "15.7 % less time", "a &lt;processor&gt;", "afu paper --out", "90 000"] {
            assert!(page.contains(text), "{text}");
        }
        for load in ["http:", "https:", "<script", "<link", "src=", "@import"] {
            assert!(!page.contains(load), "{load}");
        }
    }
}
