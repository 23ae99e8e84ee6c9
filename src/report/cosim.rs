//! The report of `afu cosim`: JSON for programs, one table for people.

use std::collections::BTreeMap;

use serde::Serialize;

use super::table::{figure, grouped, table};
use super::tally::{Flows, Tally};
use crate::config::{Config, Results};
use crate::query::{ContactRecord, Flow};
use crate::verify::Mismatch;

/// The JSON's schema. Within a number keys are only added: `CHANGELOG.md` has the rule.
pub const SCHEMA: &str = "contact-afu/cosim/1";

/// One job: what was sent, and what it came to.
#[derive(Clone, Debug)]
pub struct Job {
    /// The pairs: a set's name, or a file.
    pub name: String,
    /// The counts.
    pub tally: Tally,
    /// What else went wrong: failed checks, or why the job did not finish. Empty in a good job.
    pub failures: Vec<String>,
    /// The first records that differ from the reference's.
    pub mismatches: Vec<Mismatch>,
}

impl Job {
    /// Everything that went wrong, in words.
    pub fn all_failures(&self) -> Vec<String> {
        let Tally { pairs, mismatches, .. } = self.tally;
        let differ = format!("{mismatches} of {pairs} records differ from the reference");
        Some(differ).filter(|_| mismatches > 0).into_iter().chain(self.failures.iter().cloned()).collect()
    }

    /// Whether every record is right and nothing else went wrong.
    pub fn passed(&self) -> bool {
        self.tally.mismatches == 0 && self.failures.is_empty()
    }
}

/// Everything about a run of one or more jobs through one AFU.
#[derive(Clone, Debug)]
pub struct Run {
    /// The AFU.
    pub config: Config,
    /// Seed of random pairs and of the link.
    pub seed: u64,
    /// The command that does all of it again.
    pub replay: String,
    /// Tools and what they say of themselves.
    pub tools: BTreeMap<String, String>,
    /// SHA-256 of the Verilog, in hex.
    pub rtl_sha256: String,
    /// The link model.
    pub link: String,
    /// The jobs, in the order they ran.
    pub jobs: Vec<Job>,
}

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    version: &'static str,
    seed: u64,
    replay: &'a str,
    tools: &'a BTreeMap<String, String>,
    rtl_sha256: &'a str,
    config: &'a Config,
    clock_mhz: f64,
    passed: bool,
    failures: Vec<String>,
    #[serde(flatten)]
    all: Figures<'a>,
    jobs: Vec<JobFigures<'a>>,
}

#[derive(Serialize)]
struct JobFigures<'a> {
    name: &'a str,
    passed: bool,
    failures: Vec<String>,
    first_mismatches: Vec<MismatchFigures>,
    #[serde(flatten)]
    figures: Figures<'a>,
}

/// A record that differs, its words in hex.
#[derive(Serialize)]
struct MismatchFigures {
    /// The pair's number in its job, from 0.
    pair: usize,
    /// The cycle of the job in which its line was last written.
    cycle: Option<u64>,
    /// What went in, field by field.
    sent: BTreeMap<&'static str, String>,
    /// The words that differ.
    words: Vec<WordFigures>,
}

#[derive(Serialize)]
struct WordFigures {
    /// Its place in a contact record.
    word: usize,
    field: &'static str,
    expected: String,
    got: Option<String>,
}

impl From<&Mismatch> for MismatchFigures {
    fn from(mismatch: &Mismatch) -> Self {
        let hex = |bits: u32| format!("{bits:08x}");
        let word = |(word, expected, got): (usize, u32, Option<u32>)| WordFigures {
            word,
            field: ContactRecord::NAMES[word],
            expected: hex(expected),
            got: got.map(hex),
        };
        Self {
            pair: mismatch.number,
            cycle: mismatch.cycle,
            sent: mismatch.query.shape().names().zip(mismatch.pair.0.map(hex)).collect(),
            words: mismatch.differences().map(word).collect(),
        }
    }
}

#[derive(Serialize)]
struct Figures<'a> {
    pairs: u64,
    contacts: u64,
    flows: Flows,
    unsettled: u64,
    mismatches: u64,
    cycles: u64,
    cycles_per_pair: Option<f64>,
    ns_per_pair: Option<f64>,
    latency_cycles: Option<u64>,
    link: LinkFigures<'a>,
    host_seconds: f64,
}

#[derive(Serialize)]
struct LinkFigures<'a> {
    name: &'a str,
    bytes_read: u64,
    bytes_written: u64,
    limit_ns_per_pair: Option<f64>,
    efficiency: Option<f64>,
}

impl Run {
    /// All jobs together.
    pub fn total(&self) -> Tally {
        self.jobs.iter().fold(Tally::default(), |sum, job| sum.plus(&job.tally))
    }

    /// Whether every job passed.
    pub fn passed(&self) -> bool {
        self.jobs.iter().all(Job::passed)
    }

    /// Everything that went wrong, each with its job's name.
    fn failures(&self) -> Vec<String> {
        let of =
            |job: &Job| job.all_failures().into_iter().map(|text| format!("{}: {text}", job.name)).collect::<Vec<_>>();
        self.jobs.iter().flat_map(of).collect()
    }

    /// How it went: a line that begins with PASS or FAIL.
    pub fn verdict(&self) -> String {
        let (jobs, pairs) = (self.jobs.len(), grouped(self.total().pairs));
        let bad: Vec<&str> = self.jobs.iter().filter(|job| !job.passed()).map(|job| job.name.as_str()).collect();
        if bad.is_empty() {
            let jobs = if jobs == 1 { "1 job".to_owned() } else { format!("{jobs} jobs") };
            format!("PASS: {jobs}, {pairs} pairs, every bit as in the reference")
        } else {
            format!("FAIL: {} of {jobs} jobs: {}", bad.len(), bad.join(", "))
        }
    }

    /// The report for programs. The figures at the top are those of all jobs together; `jobs` has each.
    pub fn json(&self) -> impl Serialize {
        Document {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            seed: self.seed,
            replay: &self.replay,
            tools: &self.tools,
            rtl_sha256: &self.rtl_sha256,
            config: &self.config,
            clock_mhz: self.config.clock_mhz,
            passed: self.passed(),
            failures: self.failures(),
            all: self.figures(&self.total()),
            jobs: self.jobs.iter().map(|job| self.job_figures(job)).collect(),
        }
    }

    fn job_figures<'a>(&'a self, job: &'a Job) -> JobFigures<'a> {
        JobFigures {
            name: &job.name,
            passed: job.passed(),
            failures: job.all_failures(),
            first_mismatches: job.mismatches.iter().map(MismatchFigures::from).collect(),
            figures: self.figures(&job.tally),
        }
    }

    fn figures(&self, tally: &Tally) -> Figures<'_> {
        let ns = |cycles: Option<f64>| cycles.map(|cycles| cycles * self.config.cycle_ns());
        Figures {
            pairs: tally.pairs,
            contacts: tally.flows.contacts(),
            flows: tally.flows,
            unsettled: tally.unsettled,
            mismatches: tally.mismatches,
            cycles: tally.cycles,
            cycles_per_pair: tally.cycles_per_pair(),
            ns_per_pair: ns(tally.cycles_per_pair()),
            latency_cycles: tally.latency_cycles,
            link: LinkFigures {
                name: &self.link,
                bytes_read: tally.bytes_read,
                bytes_written: tally.bytes_written,
                limit_ns_per_pair: ns(tally.limit_per_pair()),
                efficiency: tally.efficiency(),
            },
            host_seconds: tally.host_seconds,
        }
    }

    /// The table for people: what ran, and a column a job.
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
            ("cycles a pair", Box::new(|t| figure(t.cycles_per_pair(), 3))),
            ("ns a pair", Box::new(move |t| figure(t.cycles_per_pair().map(|c| c * ns), 2))),
            ("latency, line in to line out, cycles", Box::new(|t| t.latency_cycles.map_or("-".into(), grouped))),
            ("link allows, ns a pair", Box::new(move |t| figure(t.limit_per_pair().map(|c| c * ns), 2))),
            ("share of that reached", Box::new(|t| percent(t.efficiency()))),
            ("bytes a pair, in", Box::new(|t| figure(t.read_per_pair(), 2))),
            ("bytes a pair, out", Box::new(|t| figure(t.written_per_pair(), 2))),
            ("simulated in, seconds", Box::new(|t| format!("{:.1}", t.host_seconds))),
        ];
        if self.config.profile.is_exact() {
            rows.insert(6, ("unsettled, settled by the host", Box::new(|t| grouped(t.unsettled))));
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
            "{} SCPUs, {query}{} arithmetic, {}{only_hits}, {} MHz; link {}, seed {}",
            c.scpus, c.profile, c.contact, c.clock_mhz, self.link, self.seed
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
    use crate::query::{PairRecord, Query};
    use expect_test::expect;

    fn run() -> Run {
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
    fn json_has_the_keys_of_its_schema() {
        let json = serde_json::to_value(run().json()).expect("plain values");
        let keys: Vec<_> = json.as_object().expect("an object").keys().map(String::as_str).collect();
        for key in [
            "schema",
            "version",
            "seed",
            "replay",
            "tools",
            "rtl_sha256",
            "config",
            "pairs",
            "contacts",
            "flows",
            "unsettled",
            "mismatches",
            "cycles",
            "cycles_per_pair",
            "latency_cycles",
            "clock_mhz",
            "ns_per_pair",
            "link",
            "host_seconds",
            "passed",
            "failures",
            "jobs",
        ] {
            assert!(keys.contains(&key), "{key} is missing from {keys:?}");
        }
        assert_eq!(json["link"]["bytes_read"], 395_328);
        assert_eq!(json["contacts"], 2_934);
        assert_eq!(json["jobs"][1]["cycles_per_pair"], serde_json::Value::Null);
        assert_eq!(json["jobs"][0]["link"]["limit_ns_per_pair"], 2.5);
    }

    #[test]
    fn failures_are_text_and_mismatches_words() {
        assert_eq!(run().verdict(), "PASS: 2 jobs, 12 354 pairs, every bit as in the reference");
        let mut run = run();
        let expected = ContactRecord([0, 0, 0, 0, 0, 0, 0x3f80_0000, 7]);
        let wrong = ContactRecord([0, 0, 0, 0, 0, 0, 0x3f80_0001, 7]);
        let pair = PairRecord::from_spheres([0.0, 0.0, 0.0, 0.5], [1.0, 0.0, -0.0, 0.5]);
        let of = |number, cycle, got| Mismatch { query: Query::SphereSphere, number, cycle, pair, expected, got };
        run.jobs[0].tally.mismatches = 2;
        run.jobs[0].mismatches = vec![of(3, Some(99), Some(wrong)), of(4, None, None)];
        run.jobs[1].failures = vec!["did not finish".to_owned()];
        assert_eq!(run.verdict(), "FAIL: 2 of 2 jobs: diamond:10, empty.csv");
        let json = serde_json::to_value(run.json()).expect("plain values");
        assert_eq!(json["passed"], false);
        let all = ["diamond:10: 2 of 12354 records differ from the reference", "empty.csv: did not finish"];
        assert_eq!(json["failures"], serde_json::json!(all));
        assert_eq!(json["jobs"][0]["failures"], serde_json::json!(["2 of 12354 records differ from the reference"]));
        let [first, second] = [0, 1].map(|i| &json["jobs"][0]["first_mismatches"][i]);
        assert_eq!(
            (&first["pair"], &first["cycle"], &first["sent"]["x2"]),
            (&3.into(), &99.into(), &"3f800000".into())
        );
        let word = serde_json::json!([{"word": 6, "field": "depth", "expected": "3f800000", "got": "3f800001"}]);
        assert_eq!(first["words"], word);
        assert_eq!((&second["cycle"], second["words"].as_array().map(Vec::len)), (&serde_json::Value::Null, Some(8)));
        assert_eq!(second["words"][6]["got"], serde_json::Value::Null);
    }

    #[test]
    fn the_table_has_a_column_a_job() {
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
             cycles a pair                               0.510           -
             ns a pair                                    2.55           -
             latency, line in to line out, cycles           83           -
             link allows, ns a pair                       2.50           -
             share of that reached                      98.0 %           -
             bytes a pair, in                            32.00           -
             bytes a pair, out                           32.00           -
             simulated in, seconds                         0.2         0.0
            ───────────────────────────────────────────────────────────────"#]]
        .assert_eq(&run().table());
    }
}
