//! The files of the experiment, and its table for people.

use super::{Claim, Experiment, Joined, Published, SCHEMA, Settings, Summary};
use super::{claims, figure6, figure7, page, per_collision};
use crate::report::folder::{self, replace_csv, replace_file, replace_json};
use crate::report::table::{grouped, table};
use serde::Serialize;
use std::path::Path;

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    version: &'static str,
    settings: &'a Settings,
    summary: Option<Summary>,
    claims: &'a [Claim],
    points: &'a [Joined],
}

/// Writes the figures, their points, results.json and report.html into a folder. Each file is replaced as a whole.
///
/// # Errors
/// Returns an error if a file cannot be written.
pub fn write(results: &Experiment, folder: &Path) -> Result<(), folder::Error> {
    let claims = claims(&Published::PAPER);
    let figures = [
        ("figure6.svg", figure6(results)),
        ("figure7.svg", figure7(results)),
        ("per-collision.svg", per_collision(results)),
    ];
    for (name, figure) in figures {
        replace_file(&folder.join(name), figure.svg().as_bytes())?;
    }
    for (name, points) in [("figure6.csv", results.figure6()), ("figure7.csv", results.figure7())] {
        replace_csv(&folder.join(name), |out| points.iter().try_for_each(|point| out.serialize(point)))?;
    }
    let document = Document {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        settings: &results.settings,
        summary: results.summary(),
        claims: &claims,
        points: &results.points,
    };
    replace_json(&folder.join("results.json"), &document)?;
    replace_file(&folder.join("report.html"), page(results, &claims, &Published::PAPER).as_bytes())
}

impl Summary {
    /// The table for people.
    pub fn table(&self) -> String {
        let from = |at: Option<usize>| at.map_or("never".to_owned(), |at| grouped(at as u64));
        let row = |who: &str, ns: f64, gain: f64, at: Option<usize>| {
            [who.to_owned(), format!("{ns:.2}"), format!("{gain:.2}"), from(at)]
        };
        let afu = "AFU with set-up (simulated)".to_owned();
        let rows = [
            [afu, format!("{:.2}", self.afu_ns), "1.00".to_owned(), "-".to_owned()],
            row("ODE, paper's rule (measured)", self.ode_rule_ns, self.speed_up_over_rule, self.crossover_over_rule),
            row("ODE, loop of calls (measured)", self.ode_loop_ns, self.speed_up_over_loop, self.crossover_over_loop),
            row("f32 kernel in batch (measured)", self.batch_ns, self.speed_up_over_batch, self.crossover_over_batch),
        ];
        let title = format!(
            "{} collisions; link limit {:.2} ns each, of which the AFU reaches {:.1} % without set-up",
            grouped(self.collisions as u64),
            self.link_limit_ns,
            100.0 * self.link_share
        );
        format!("{title}\n{}", table(&["engine", "ns per collision", "time over the AFU's", "AFU faster from"], rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::results::tests::example;

    #[test]
    fn every_file_is_written_and_a_csv_has_a_line_per_point() {
        let room = tempfile::tempdir().expect("a temporary folder");
        write(&example(), room.path()).expect("written");
        assert_eq!(std::fs::read_dir(room.path()).expect("there").count(), 7);
        let csv = std::fs::read_to_string(room.path().join("figure7.csv")).expect("written");
        assert_eq!(csv.lines().count(), 5);
        assert!(csv.starts_with("collisions,ode_rule_ns,ode_loop_ns,"), "{csv}");
        assert!(csv.contains("\n90000,5400000.0,4500000.0,"), "{csv}");
    }
}
