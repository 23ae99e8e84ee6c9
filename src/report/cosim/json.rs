//! The report of `afu cosim` for programs.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Job, Run, SCHEMA};
use crate::config::Config;
use crate::query::ContactRecord;
use crate::report::tally::{Flows, Tally};
use crate::verify::Mismatch;
/// What a report begins with, and its jobs.
#[derive(Serialize)]
struct Document<'a, A: Serialize, J: Serialize> {
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
    /// Sums over all jobs, if there are any.
    #[serde(flatten)]
    all: Option<A>,
    jobs: Vec<J>,
}

impl<J> Run<J> {
    /// The report with these figures. The run passed if there are no failures.
    pub(super) fn document<'a, A: Serialize + 'a, F: Serialize + 'a>(
        &'a self,
        failures: Vec<String>,
        all: Option<A>,
        jobs: Vec<F>,
    ) -> impl Serialize + 'a {
        Document {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            seed: self.seed,
            replay: &self.replay,
            tools: &self.tools,
            rtl_sha256: &self.rtl_sha256,
            config: &self.config,
            clock_mhz: self.config.clock_mhz,
            passed: failures.is_empty(),
            failures,
            all,
            jobs,
        }
    }
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
    /// The input words, field by field.
    sent: BTreeMap<&'static str, String>,
    /// The words that differ.
    words: Vec<WordFigures>,
}

#[derive(Serialize)]
struct WordFigures {
    /// The place of the word in a contact record.
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
    /// The report for programs. The figures at the top are sums over all jobs; `jobs` has each of them.
    pub fn json(&self) -> impl Serialize {
        let jobs = self.jobs.iter().map(|job| self.job_figures(job)).collect();
        self.document(self.failures(), Some(self.figures(&self.total())), jobs)
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
}

#[cfg(test)]
mod tests {
    use super::super::tests::run;
    use super::*;
    use crate::query::{PairRecord, Query};

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
}
