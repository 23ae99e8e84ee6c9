//! The report of `afu cosim`: JSON for programs, a table for people.

mod json;
mod spheres;

use std::collections::BTreeMap;

use super::table::{counted, figure, grouped, table};
use super::tally::Tally;
use crate::config::{Config, Results};
use crate::query::Flow;
use crate::verify::Mismatch;

pub use spheres::SpheresJob;

/// The schema of the JSON. `CHANGELOG.md` says when its number changes.
pub const SCHEMA: &str = "contact-afu/cosim/1";

/// One job: its pairs and its results.
#[derive(Clone, Debug)]
pub struct Job {
    /// The pairs: a set's name, or a file.
    pub name: String,
    /// The counts.
    pub tally: Tally,
    /// Failed checks, or why the job did not finish. Empty if all checks passed.
    pub failures: Vec<String>,
    /// The first records that differ from the reference's.
    pub mismatches: Vec<Mismatch>,
}

impl Job {
    /// All failures: the number of mismatches, then the other failures.
    pub(crate) fn all_failures(&self) -> Vec<String> {
        let Tally { pairs, mismatches, .. } = self.tally;
        let differ = format!("{mismatches} of {pairs} records differ from the reference");
        Some(differ).filter(|_| mismatches > 0).into_iter().chain(self.failures.iter().cloned()).collect()
    }

    /// True if there is neither a mismatch nor another failure.
    pub fn passed(&self) -> bool {
        self.tally.mismatches == 0 && self.failures.is_empty()
    }
}

/// Everything about a run of one or more jobs through one AFU.
#[derive(Clone, Debug)]
pub struct Run<J = Job> {
    /// The AFU.
    pub config: Config,
    /// Seed of random pairs and of the link.
    pub seed: u64,
    /// The command that repeats the run.
    pub replay: String,
    /// The version that each tool reports, by the tool's name.
    pub tools: BTreeMap<String, String>,
    /// SHA-256 of the Verilog, in hex.
    pub rtl_sha256: String,
    /// The link model.
    pub link: String,
    /// The jobs, in the order in which they ran.
    pub jobs: Vec<J>,
}

impl Run {
    /// The sum over all jobs.
    pub fn total(&self) -> Tally {
        self.jobs.iter().fold(Tally::default(), |sum, job| sum.plus(&job.tally))
    }

    /// True if every job passed.
    pub fn passed(&self) -> bool {
        self.jobs.iter().all(Job::passed)
    }

    /// The failures of all jobs, each with the name of its job.
    fn failures(&self) -> Vec<String> {
        let of =
            |job: &Job| job.all_failures().into_iter().map(|text| format!("{}: {text}", job.name)).collect::<Vec<_>>();
        self.jobs.iter().flat_map(of).collect()
    }

    /// The verdict: a line that begins with PASS or FAIL.
    pub fn verdict(&self) -> String {
        let jobs = counted(self.jobs.len() as u64, "job");
        let bad: Vec<&str> = self.jobs.iter().filter(|job| !job.passed()).map(|job| job.name.as_str()).collect();
        if bad.is_empty() {
            let pairs = counted(self.total().pairs, "pair");
            format!("PASS: {jobs}, {pairs}, every bit as in the reference")
        } else {
            format!("FAIL: {} of {jobs}: {}", bad.len(), bad.join(", "))
        }
    }

    /// The table for people: what ran, then one column per job.
    pub fn table(&self) -> String {
        let heading: Vec<&str> = [""].into_iter().chain(self.jobs.iter().map(|job| job.name.as_str())).collect();
        let ns = self.config.cycle_ns();
        type Show<'a> = Box<dyn Fn(&Tally) -> String + 'a>;
        let mut rows: Vec<(&str, Show<'_>)> = vec![
            ("pairs", Box::new(|t| grouped(t.pairs))),
            ("contacts", Box::new(|t| grouped(t.flows.contacts()))),
            ("  real", Box::new(|t| grouped(t.flows.real))),
            ("  coincident centres", Box::new(|t| grouped(t.flows.coincident))),
            ("no contact (fake)", Box::new(|t| grouped(t.flows.fake))),
            ("invalid pairs", Box::new(|t| grouped(t.flows.invalid))),
            ("mismatches with the reference", Box::new(|t| grouped(t.mismatches))),
            ("cycles", Box::new(|t| grouped(t.cycles))),
            ("cycles per pair", Box::new(|t| figure(t.cycles_per_pair(), 3))),
            ("ns per pair", Box::new(move |t| figure(t.cycles_per_pair().map(|c| c * ns), 2))),
            ("latency, line in to line out, cycles", Box::new(|t| t.latency_cycles.map_or("-".into(), grouped))),
            ("link limit, ns per pair", Box::new(move |t| figure(t.limit_per_pair().map(|c| c * ns), 2))),
            ("share of the link limit", Box::new(|t| percent(t.efficiency()))),
            ("bytes per pair, in", Box::new(|t| figure(t.read_per_pair(), 2))),
            ("bytes per pair, out", Box::new(|t| figure(t.written_per_pair(), 2))),
            ("simulation time, seconds", Box::new(|t| format!("{:.1}", t.host_seconds))),
        ];
        if self.config.profile.is_exact() {
            rows.insert(6, ("unsettled, resolved by the host", Box::new(|t| grouped(t.unsettled))));
        }
        if !self.config.query.shape().flows.contains(&Flow::Coincident) {
            rows.retain(|(title, _)| *title != "  coincident centres");
        }
        let row = |(title, show): (&str, Show<'_>)| {
            [title.to_owned()].into_iter().chain(self.jobs.iter().map(|job| show(&job.tally))).collect::<Vec<_>>()
        };
        let c = &self.config;
        let only_hits = if c.results == Results::Hits { " of hits" } else { "" };
        let query = if c.query.is_default() { String::new() } else { format!("{}, ", c.query) };
        let title = format!(
            "{}, {query}{} arithmetic, {}{only_hits}, {} MHz; link {}, seed {}",
            counted(c.scpus.into(), "SCPU"),
            c.profile,
            c.contact,
            c.clock_mhz,
            self.link,
            self.seed
        );
        format!("{title}\n{}", table(&heading, rows.into_iter().map(row)))
    }
}

fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "-".to_owned(), |share| format!("{:.1} %", 100.0 * share))
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::report::tally::Flows;
    use expect_test::expect;

    pub(super) fn run() -> Run {
        let tally = Tally {
            pairs: 12_354,
            flows: Flows { fake: 9_420, coincident: 0, real: 2_934, invalid: 0 },
            unsettled: 0,
            mismatches: 0,
            cycles: 6_300,
            limit_cycles: 6_177.0,
            latency_cycles: Some(83),
            bytes_read: 395_328,
            bytes_written: 395_328,
            host_seconds: 0.25,
        };
        let jobs = vec![
            Job { name: "diamond:10".into(), tally, failures: vec![], mismatches: vec![] },
            Job {
                name: "empty.csv".into(),
                tally: Tally { cycles: 9, ..Tally::default() },
                failures: vec![],
                mismatches: vec![],
            },
        ];
        Run {
            config: Config::default(),
            seed: 1,
            replay: "afu cosim".into(),
            tools: BTreeMap::new(),
            rtl_sha256: "00".into(),
            link: "ideal".into(),
            jobs,
        }
    }

    #[test]
    fn the_table_has_one_column_per_job() {
        expect![[r#"
            10 SCPUs, wide arithmetic, hit,depth,normal,position, 200 MHz; link ideal, seed 1
            ───────────────────────────────────────────────────────────────
                                                    diamond:10   empty.csv
            ───────────────────────────────────────────────────────────────
             pairs                                      12 354           0
             contacts                                    2 934           0
               real                                      2 934           0
               coincident centres                            0           0
             no contact (fake)                           9 420           0
             invalid pairs                                   0           0
             mismatches with the reference                   0           0
             cycles                                      6 300           9
             cycles per pair                             0.510           -
             ns per pair                                  2.55           -
             latency, line in to line out, cycles           83           -
             link limit, ns per pair                      2.50           -
             share of the link limit                    98.0 %           -
             bytes per pair, in                          32.00           -
             bytes per pair, out                         32.00           -
             simulation time, seconds                      0.2         0.0
            ───────────────────────────────────────────────────────────────"#]]
        .assert_eq(&run().table());
    }
}
