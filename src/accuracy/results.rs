//! Results of contenders on hard pairs: one row per category and contender, in a folder that grows.

use super::{ErrorStatistics, Tally, Task, matrix};
use crate::query::Query;
use crate::report::table::{grouped, table};
use crate::report::{folder, manifest};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The schema of a study's `manifest.json`.
pub const SCHEMA: &str = "contact-afu/hard/1";
const CSV: &str = "hard.csv";
const PICTURE: &str = "hard.svg";

/// The result of one contender on one category.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The name of the category, or of the set of pairs.
    pub category: String,
    /// The contender's name.
    pub contender: String,
    /// SHA-256 of the inputs: version, contender, pairs.
    pub key: String,
    /// The counts of wrong answers.
    pub tally: Tally,
    /// The statistics of the errors.
    pub errors: ErrorStatistics,
}

impl Row {
    pub(super) fn new(category: &str, contender: &str, key: String) -> Self {
        let (category, contender) = (category.to_owned(), contender.to_owned());
        Self { category, contender, key, tally: Tally::default(), errors: ErrorStatistics::default() }
    }
}

/// A study: its inputs and the results of every contender. Its folder has them as `manifest.json`, the rows as
/// `hard.csv`, and gross failures as the picture `hard.svg`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HardResults {
    schema: String,
    version: String,
    /// The query of the pairs.
    #[serde(default, skip_serializing_if = "Query::is_default")]
    pub query: Query,
    /// The number of pairs in all categories together.
    pub pairs: u64,
    /// Seed of the pairs.
    pub seed: u64,
    /// Contenders that are missing, and what installs them.
    pub absent: Vec<String>,
    /// The rows, category by category.
    pub rows: Vec<Row>,
}

impl HardResults {
    /// A study without rows.
    pub fn new(task: Task, absent: &[&str]) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            query: task.query,
            pairs: task.pairs,
            seed: task.seed,
            absent: absent.iter().map(|&what| what.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// Writes the folder in its present state. Each file is replaced as a whole.
    pub(super) fn save(&self, folder: &Path) -> Result<(), folder::Error> {
        folder::create(folder)?;
        folder::replace_json(&folder.join(manifest::NAME), self)?;
        folder::replace_csv(&folder.join(CSV), |out| self.csv(out))?;
        folder::replace_file(&folder.join(PICTURE), matrix::svg(self).as_bytes())
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> Result<(), csv::Error> {
        let heading = ["category", "contender", "pairs", "contacts"].into_iter().chain(Tally::HEADING);
        out.write_record(heading.chain(["depth_ulps", "normal_ulps", "position_ulps"]))?;
        for Row { category, contender, tally, .. } in &self.rows {
            let counts = tally.counts().map(|count| count.to_string());
            let ulps = [tally.depth_ulps, tally.normal_ulps, tally.position_ulps].map(|ulps| ulps.to_string());
            let names = [category.clone(), contender.clone()];
            out.write_record(names.into_iter().chain(counts).chain(ulps))?;
        }
        Ok(())
    }

    /// The tally of a contender over all categories.
    pub fn total(&self, contender: &str) -> Tally {
        let rows = self.rows.iter().filter(|row| row.contender == contender);
        rows.fold(Tally::default(), |sum, row| sum.plus(&row.tally))
    }

    /// The contenders, each once, in their order.
    pub fn contenders(&self) -> Vec<&str> {
        distinct(self.rows.iter().map(|row| row.contender.as_str()))
    }

    /// The categories, each once, in their order.
    pub(super) fn categories(&self) -> Vec<&str> {
        distinct(self.rows.iter().map(|row| row.category.as_str()))
    }

    /// The number of pairs in a category, as text: two numbers if the last categories have one pair less.
    pub(super) fn per_category(&self) -> String {
        let pairs = |of: fn(u64, u64) -> u64| {
            self.rows.iter().map(|row| row.tally.pairs).reduce(of).map_or_else(String::new, grouped)
        };
        let (least, most) = (pairs(u64::min), pairs(u64::max));
        if least == most { most } else { format!("{least} or {most}") }
    }

    /// The tables for people: each contender by category, and at the end all of them by their gross failures.
    pub fn tables(&self) -> String {
        let mut text = String::new();
        for contender in self.contenders() {
            let rows = self.rows.iter().filter(|row| row.contender == contender);
            let line = |name: &str, tally: &Tally| {
                [name.to_owned()].into_iter().chain(tally.counts().map(grouped)).collect::<Vec<_>>()
            };
            let total = line("all", &self.total(contender));
            let lines = rows.map(|row| line(&row.category, &row.tally)).chain([total]);
            let heading: Vec<&str> = [contender, "pairs", "contacts"].into_iter().chain(Tally::HEADING).collect();
            text += &format!("{}\n\n", table(&heading, lines));
        }
        let of = if self.query.is_default() { String::new() } else { format!(" of {}", self.query) };
        text += &format!("gross failures, hard:{}{of} with seed {}\n{}", self.pairs, self.seed, self.summary());
        self.absent.iter().fold(text, |text, what| format!("{text}\n{what}"))
    }

    fn summary(&self) -> String {
        let contenders = self.contenders();
        let categories = self.categories();
        let heading: Vec<&str> = ["", "pairs"].into_iter().chain(contenders.iter().copied()).collect();
        let line = |name: &str, tallies: Vec<Tally>| {
            let pairs = tallies.first().map_or(0, |tally| tally.pairs);
            let bad = tallies.into_iter().map(|tally| grouped(tally.bad));
            [name.to_owned(), grouped(pairs)].into_iter().chain(bad).collect::<Vec<_>>()
        };
        let of =
            |category: &str| self.rows.iter().filter(|row| row.category == category).map(|row| row.tally).collect();
        let total = line("all", contenders.iter().map(|contender| self.total(contender)).collect());
        table(&heading, categories.into_iter().map(|category| line(category, of(category))).chain([total]))
    }
}

fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen: Vec<&str> = Vec::new();
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}
