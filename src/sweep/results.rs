//! The results of a sweep, in a folder that grows.

use std::fs;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::row::HostSeconds;
use super::{Job, PairsRow, Row, SpheresRow, Swept, Task, page, spheres_page};
use crate::config::{Config, Search};
use crate::report::table::table;
use crate::report::{folder, manifest};
use crate::store::sha256;

/// The schema of a sweep's `manifest.json`.
pub const SCHEMA: &str = "contact-afu/sweep/2";
/// The rows alone, in a sweep's folder.
const CSV: &str = "sweep.csv";
/// Seconds on the machine that simulated: the only file of a sweep that differs from run to run.
const HOST: &str = "host.csv";
/// For people: a page, and its first plot alone.
const PAGE: &str = "report.html";
const PICTURE: &str = "throughput.svg";

/// A sweep: what every AFU was given, and the rows so far. Its folder has `manifest.json`, by which it is known,
/// the rows alone as `sweep.csv`, the page `report.html`, its plot `throughput.svg`, and `host.csv`, the seconds that
/// models and simulations took.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepResults {
    pub(super) schema: String,
    pub(super) version: String,
    /// The pairs: a set's name, or a file. Empty if spheres are sent.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub pairs: String,
    /// SHA-256 of the pairs' words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub pairs_sha256: String,
    /// The spheres: a set's name, or files. Empty if pairs are sent.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub spheres: String,
    /// SHA-256 of the spheres' words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub spheres_sha256: String,
    /// The link's name, or its file.
    pub link: String,
    /// SHA-256 of the link model; empty in results of older versions.
    #[serde(default)]
    pub link_sha256: String,
    /// Seed of pairs or spheres, and of the link.
    pub seed: u64,
    /// The configuration; the swept options are in [`Swept`].
    pub config: Config,
    /// The requested values; there is one row for each combination.
    #[serde(default)]
    pub swept: Swept,
    /// The rows, in the order asked for.
    pub rows: Vec<Row>,
    /// The points that are missing, or that failed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<String>,
    #[serde(skip)]
    pub(super) host: Vec<HostSeconds>,
}

impl SweepResults {
    /// A sweep of `task` without rows. `given` and `link` are the names of what the task has.
    pub fn new(given: &str, link: &str, task: &Task, config: &Config, swept: Swept) -> Self {
        let (name, sha256_of_all) = (given.to_owned(), task.job.fingerprint());
        let nothing = (String::new(), String::new());
        let ((pairs, pairs_sha256), (spheres, spheres_sha256)) = match task.job {
            Job::Pairs(_) => ((name, sha256_of_all), nothing),
            Job::Spheres(_) => (nothing, (name, sha256_of_all)),
        };
        Self {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            pairs,
            pairs_sha256,
            spheres,
            spheres_sha256,
            link: link.to_owned(),
            // A link is plain values: it has JSON.
            link_sha256: sha256(serde_json::to_string(task.link).unwrap_or_default().as_bytes()),
            seed: task.seed,
            config: config.clone(),
            swept,
            rows: Vec::new(),
            missing: Vec::new(),
            host: Vec::new(),
        }
    }

    /// The name of what is sent, and its SHA-256.
    pub(super) fn given(&self) -> (&str, &str) {
        if self.spheres.is_empty() { (&self.pairs, &self.pairs_sha256) } else { (&self.spheres, &self.spheres_sha256) }
    }

    /// The rows of AFUs that were sent pairs.
    pub fn of_pairs(&self) -> impl Iterator<Item = &PairsRow> {
        self.rows.iter().filter_map(|row| if let Row::Pairs(row) = row { Some(row) } else { None })
    }

    /// The rows of AFUs that were sent spheres.
    pub fn of_spheres(&self) -> impl Iterator<Item = &SpheresRow> {
        self.rows.iter().filter_map(|row| if let Row::Spheres(row) = row { Some(row) } else { None })
    }

    /// Whether `folder` may hold this sweep: it is not there, holds an earlier run of the same sweep, or `force`
    /// replaces what is there.
    ///
    /// # Errors
    /// Returns an error if the folder is not ours, or holds another sweep or rows that this one does not ask for,
    /// without `force`; if it cannot be read.
    pub fn check(&self, folder: &Path, force: bool) -> Result<(), folder::Error> {
        folder::check(folder, force)?;
        let path = folder.join(manifest::NAME);
        let text = match fs::read(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            Err(error) => return Err(folder::Error::Io { path, error }),
        };
        let differences = match serde_json::from_slice::<Self>(&text) {
            Ok(there) => self.differences(&there),
            Err(_) => vec![format!("results that are no sweep of version {}", self.version)],
        };
        if force || differences.is_empty() {
            return Ok(());
        }
        Err(folder::Error::Other { folder: folder.to_owned(), differences })
    }

    /// What `there` is of, where that is not what this sweep is of.
    fn differences(&self, there: &Self) -> Vec<String> {
        let mut differences = Vec::new();
        let mut compare = |what: &str, there: &str, here: &str| {
            if there != here {
                differences.push(format!("a sweep {what} {there}, not {here}"));
            }
        };
        compare("of schema", &there.schema, &self.schema);
        compare("by version", &there.version, &self.version);
        let ((given, sha256), (given_there, sha256_there)) = (self.given(), there.given());
        compare("of", given_there, given);
        compare("over", &there.link, &self.link);
        compare("with seed", &there.seed.to_string(), &self.seed.to_string());
        let options = |config: &Config| {
            let Config { scpus, interval, .. } = Config::default();
            let search = Search { table: config.search.table, ..Search::default() };
            let flags = Config { scpus, interval, search, ..config.clone() }.flags();
            // Rows have their own SCPUs and intervals, which are always named.
            let of_rows = |flag: &[String]| matches!(flag[0].as_str(), "--scpus" | "--interval");
            let rest: Vec<_> = flags.chunks(2).filter(|flag| !of_rows(flag)).flatten().cloned().collect();
            if rest.is_empty() { "the default options".to_owned() } else { rest.join(" ") }
        };
        compare("with", &options(&there.config), &options(&self.config));
        if given_there == given && there.seed == self.seed && sha256_there != sha256 {
            differences.push(format!("a sweep of {given_there} as it was before it changed"));
        }
        let is_known = !there.link_sha256.is_empty() && there.link == self.link;
        if is_known && there.config.clock_mhz == self.config.clock_mhz && there.link_sha256 != self.link_sha256 {
            differences.push(format!("a sweep over {} as it was before it changed", there.link));
        }
        let lost = there.rows.iter().map(Row::size).filter(|size| !self.swept.has(size));
        let lost: Vec<String> = lost.map(|size| size.short()).collect();
        if !lost.is_empty() {
            let (what, between) = if self.spheres.is_empty() { ("SCPUs: ", ", ") } else { ("", "; ") };
            differences.push(format!("rows that are not asked for now ({what}{})", lost.join(between)));
        }
        differences
    }

    /// Writes the folder as it is now; each file is replaced whole.
    ///
    /// # Errors
    /// Returns an error if the file system refuses.
    pub fn save(&self, folder: &Path) -> Result<(), folder::Error> {
        folder::create(folder)?;
        folder::replace_json(&folder.join(manifest::NAME), self)?;
        folder::replace_csv(&folder.join(CSV), |out| self.rows.iter().try_for_each(|row| out.serialize(row)))?;
        folder::replace_csv(&folder.join(HOST), |out| self.host.iter().try_for_each(|row| out.serialize(row)))?;
        let (picture, page) = if self.spheres.is_empty() {
            (page::throughput(self), page::page(self))
        } else {
            (spheres_page::times(self), spheres_page::page(self))
        };
        folder::replace_file(&folder.join(PICTURE), picture.svg().as_bytes())?;
        folder::replace_file(&folder.join(PAGE), page.as_bytes())
    }

    /// The table for people.
    pub fn table(&self) -> String {
        let title = format!(
            "{} over link {}, seed {}, {} arithmetic, {} MHz",
            self.given().0,
            self.link,
            self.seed,
            self.config.profile,
            self.config.clock_mhz
        );
        let heading: &[&str] = if self.spheres.is_empty() { &PairsRow::HEADING } else { &SpheresRow::HEADING };
        format!("{title}\n{}", table(heading, self.rows.iter().map(Row::cells)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::LinkModel;
    use crate::query::PairRecord;

    fn row(scpus: u32) -> Row {
        Row::Pairs(PairsRow {
            scpus,
            interval: 1,
            scpu_luts: None,
            scpu_ffs: None,
            scpu_dsps: None,
            pairs: 10,
            contacts: 3,
            mismatches: 0,
            failed_checks: 0,
            cycles: 100,
            cycles_per_pair: Some(10.0),
            pairs_per_second: Some(2e7),
            efficiency: Some(0.05),
            bytes_read: 320,
            bytes_written: 320,
            latency_cycles: None,
            clock_mhz: 200.0,
            rtl_sha256: "00".to_owned(),
        })
    }

    #[test]
    fn the_same_sweep_is_resumed_and_another_is_not() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let folder = room.path().join("out");
        let pairs = [PairRecord::default()];
        let task = Task { job: Job::Pairs(&pairs), link: &LinkModel::ideal(), seed: 1, counts: false };
        let swept = Swept { scpus: vec![1, 2], interval: vec![1], ..Swept::default() };
        let mut results = SweepResults::new("diamond:3", "ideal", &task, &Config::default(), swept);
        results.check(&folder, false).expect("nothing there");
        results.rows = vec![row(1), row(2)];
        results.save(&folder).expect("written");
        results.check(&folder, false).expect("ours");
        let csv = fs::read_to_string(folder.join(CSV)).expect("written");
        assert!(csv.starts_with("scpus,interval,pairs,contacts,mismatches,") && csv.lines().count() == 3, "{csv}");

        let manifest = fs::read(folder.join(manifest::NAME)).expect("written");
        let swept = |scpus: &[u32]| Swept { scpus: scpus.to_vec(), interval: vec![1, 2], ..Swept::default() };
        let more = SweepResults { swept: swept(&[4, 2, 1]), ..results.clone() };
        more.check(&folder, false).expect("the same and more");
        let paper = Config { profile: "paper".parse().expect("a profile"), ..Config::default() };
        let base = results.clone();
        for (other, words) in [
            (SweepResults { pairs: "diamond:4".to_owned(), ..base.clone() }, "a sweep of diamond:3, not diamond:4;"),
            (SweepResults { pairs_sha256: "ab".to_owned(), ..base.clone() }, "diamond:3 as it was before it changed;"),
            (SweepResults { link: "late".to_owned(), ..base.clone() }, "a sweep over ideal, not late;"),
            (SweepResults { link_sha256: "ab".to_owned(), ..base.clone() }, "over ideal as it was before it changed;"),
            (SweepResults { seed: 2, ..base.clone() }, "a sweep with seed 1, not 2;"),
            (SweepResults { version: "9".to_owned(), ..base.clone() }, "a sweep by version 0.1.0, not 9;"),
            (SweepResults { config: paper, ..base.clone() }, "not --profile paper;"),
            (SweepResults { swept: swept(&[1, 4]), ..base.clone() }, "not asked for now (SCPUs: 2 at interval 1);"),
        ] {
            let refused = other.check(&folder, false).expect_err("another").to_string();
            assert!(refused.contains(words) && refused.contains("--force"), "{words}: {refused}");
            other.check(&folder, true).expect("forced");
            assert_eq!(
                fs::read(folder.join(manifest::NAME)).expect("written"),
                manifest,
                "nothing is replaced by asking"
            );
        }

        fs::write(folder.join(manifest::NAME), r#"{"schema": "contact-afu/manifest/1"}"#).expect("written");
        let refused = results.check(&folder, false).expect_err("Verilog").to_string();
        assert!(refused.contains("results that are no sweep"), "{refused}");
        fs::write(folder.join(manifest::NAME), "{}").expect("written");
        assert!(matches!(results.check(&folder, false), Err(folder::Error::Foreign(_))));
        results.check(&folder, true).expect("forced");
    }
}
