//! The files, and the tables in Markdown.

use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::columns::{COLUMNS, Kind, filled};
use super::figures::{Family, figure};
use super::page::page;
use super::{Goal, Row, Settings, Times};
use crate::report::folder::{self, create, replace_csv, replace_file, replace_json};

/// The schema of results.json.
const SCHEMA: &str = "contact-afu/spheres-times/1";

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    version: &'static str,
    settings: &'a Settings,
    goals: Vec<Goal>,
    rows: Vec<Map<String, Value>>,
}

/// A table: the set, with `with_counts` its spheres and contacts, and the columns of these kinds.
pub(super) fn cells(rows: &[Row], with_counts: bool, kinds: &[Kind]) -> (Vec<&'static str>, Vec<Vec<String>>) {
    let counts: &[&str] = if with_counts { &["spheres", "contacts"] } else { &[] };
    let columns: Vec<_> = filled(rows, kinds).collect();
    let heading = ["set"].iter().chain(counts).copied().chain(columns.iter().map(|column| column.heading));
    let line = |row: &Row| {
        let counts = [row.spheres, row.contacts].map(|count| count.to_string()).into_iter().take(counts.len());
        let first = [row.set.clone()].into_iter().chain(counts);
        first.chain(columns.iter().map(|column| column.cell(row))).collect()
    };
    (heading.collect(), rows.iter().map(line).collect())
}

/// The goals as a table: its heading, and its rows.
pub(super) fn goal_cells(goals: &[Goal]) -> ([&'static str; 5], Vec<Vec<String>>) {
    let line = |goal: &Goal| {
        let met = if goal.met { "met" } else { "missed" };
        let found = if goal.found < 1.0 { format!("{:.4}", goal.found) } else { format!("{:.2}", goal.found) };
        vec![goal.set.clone(), goal.what.to_owned(), goal.most.to_string(), found, met.to_owned()]
    };
    (["set", "the AFU", "goal: at most", "this run", ""], goals.iter().map(line).collect())
}

/// A table in Markdown, whose first column is code.
fn markdown(heading: &[&str], rows: Vec<Vec<String>>) -> String {
    let mut text = format!("| {} |\n|{}\n", heading.join(" | "), "---|".repeat(heading.len()));
    for mut row in rows {
        row[0] = format!("`{}`", row[0]);
        text += &format!("| {} |\n", row.join(" | "));
    }
    text
}

impl Times {
    /// The tables in Markdown: times, and, if the AFU was simulated, its shares and the goals.
    pub fn markdown(&self) -> String {
        let (heading, rows) = cells(&self.rows, true, &[Kind::Measured, Kind::Simulated]);
        let mut text = markdown(&heading, rows);
        let (heading, rows) = cells(&self.rows, false, &[Kind::Share]);
        if heading.len() > 1 {
            text += &format!("\n{}", markdown(&heading, rows));
        }
        let goals = self.goals();
        if !goals.is_empty() {
            let (heading, rows) = goal_cells(&goals);
            text += &format!("\n{}", markdown(&heading, rows));
        }
        text
    }

    /// Writes spheres.csv, results.json, the pictures, table.md and report.html into a folder, which is created if it
    /// does not exist. Each file is replaced as a whole.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), folder::Error> {
        create(folder)?;
        replace_csv(&folder.join("spheres.csv"), |out| {
            out.write_record(
                ["set", "spheres", "contacts"].into_iter().chain(COLUMNS.iter().map(|column| column.key)),
            )?;
            for row in &self.rows {
                let first = [row.set.clone(), row.spheres.to_string(), row.contacts.to_string()];
                let values = COLUMNS.iter().map(|column| (column.value)(row));
                let texts = values.map(|value| value.map_or_else(String::new, |value| value.to_string()));
                out.write_record(first.into_iter().chain(texts))?;
            }
            Ok(())
        })?;
        let values = |row: &Row| {
            let first = [
                ("set", Value::from(row.set.clone())),
                ("spheres", row.spheres.into()),
                ("contacts", row.contacts.into()),
            ];
            let others = COLUMNS.iter().map(|column| (column.key, Value::from((column.value)(row))));
            first.into_iter().chain(others).map(|(key, value)| (key.to_owned(), value)).collect()
        };
        let document = Document {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            settings: &self.settings,
            goals: self.goals(),
            rows: self.rows.iter().map(values).collect(),
        };
        replace_json(&folder.join("results.json"), &document)?;
        for family in Family::ALL {
            if let Some(plot) = figure(self, family) {
                replace_file(&folder.join(family.file()), plot.svg().as_bytes())?;
            }
        }
        replace_file(&folder.join("table.md"), self.markdown().as_bytes())?;
        replace_file(&folder.join("report.html"), page(self).as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;
    use super::*;

    #[test]
    fn tables_tell_simulated_times_by_their_heading_and_leave_out_a_missing_peer() {
        let text = example().markdown();
        let expected = expect_test::expect![[r"
            | set | spheres | contacts | sorting | search, numbers | search, contacts | cells, numbers | cells, contacts | ODE, hash | ODE, sweep and prune | *AFU, numbers* | *AFU, contacts* | *AFU, pairs* |
            |---|---|---|---|---|---|---|---|---|---|---|---|---|
            | `diamond:10` | 1159 | 2318 | 140 | 380 | 390 | 80 | 120 | 4000 | 2000 | 12.0 | 18.0 | 30.0 |
        "]];
        expected.assert_eq(&text.lines().take(3).fold(String::new(), |text, line| text + line + "\n"));
        for line in [
            "| `diamond:30` | 10.0 % | 15.0 % | 0.40 % | 0.90 % | 50.0 % | 90.0 % |",
            "| `diamond:30` | numbers, ns per sphere | 8.5 | 8.00 | met |",
            "| `gas:32768:0.3` | numbers, ns per sphere | 5 | 6.00 | missed |",
            "| `diamond:30` | numbers, time over that of ODE's best space | 0.02 | 0.0040 | met |",
        ] {
            assert!(text.contains(line), "{line}: {text}");
        }
        let mut measured = example();
        measured.rows.iter_mut().for_each(|row| row.simulated = None);
        assert!(!measured.markdown().contains("AFU"), "only what was measured");
    }

    #[test]
    fn every_file_is_written_and_has_every_row() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let folder = room.path().join("out/spheres");
        example().write(&folder).expect("written");
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("written");
        let mut names: Vec<_> = std::fs::read_dir(&folder).expect("there").map(|file| file.expect("a file")).collect();
        names.sort_by_key(std::fs::DirEntry::file_name);
        let names: Vec<_> = names.iter().map(|file| file.file_name().into_string().expect("UTF-8")).collect();
        let all = ["diamond.svg", "gas.svg", "report.html", "results.json", "spheres.csv", "table.md"];
        assert_eq!(names, all);

        let csv = read("spheres.csv");
        let mut lines = csv.lines();
        let heading: Vec<_> = lines.next().expect("a heading").split(',').collect();
        let row: Vec<_> = lines.nth(1).expect("a diamond").split(',').collect();
        assert_eq!((csv.lines().count(), heading.len(), row.len()), (5, 23, 23), "{csv}");
        let value = |key: &str| row[heading.iter().position(|name| *name == key).expect("a column")];
        let keys = ["set", "cells_numbers_ns", "parry_ns", "afu_numbers_ns", "afu_numbers_over_cells"];
        assert_eq!(keys.map(value), ["diamond:30", "80", "", "8", "0.1"]);

        let json: Value = serde_json::from_str(&read("results.json")).expect("JSON");
        assert_eq!((&json["schema"], &json["rows"][3]["set"]), (&SCHEMA.into(), &"gas:32768:0.3".into()));
        assert_eq!(json["rows"][3]["afu_numbers_ns"], 6.0);
        assert_eq!((&json["rows"][0]["parry_ns"], &json["goals"][4]["met"]), (&Value::Null, &false.into()));
        assert_eq!(read("table.md"), example().markdown());
    }
}
