//! The report of `afu cosim` as JUnit, which CI systems show: one test case per job.

use std::time::Duration;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::cosim::Run;

/// Why the XML could not be written.
#[derive(Debug, thiserror::Error)]
#[error("JUnit: {0}")]
pub struct Error(#[from] quick_junit::SerializeError);

/// The XML. `details` holds, for each job, the text of its mismatches.
///
/// # Errors
/// Returns an error if the XML cannot be written.
pub fn xml(run: &Run, details: &[String]) -> Result<String, Error> {
    let mut suite = TestSuite::new("afu cosim");
    suite.add_property(("seed", run.seed.to_string().as_str()));
    suite.add_property(("replay", run.replay.as_str()));
    for (number, job) in run.jobs.iter().enumerate() {
        let tally = &job.tally;
        let mut status = TestCaseStatus::success();
        if !job.passed() {
            status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            let differ = format!("{} of {} records differ from the reference", tally.mismatches, tally.pairs);
            status.set_message(job.failures.first().unwrap_or(&differ).as_str());
            status.set_type(if tally.mismatches > 0 { "mismatch" } else { "unmet" });
            let details = details.get(number).map_or("", String::as_str);
            status.set_description(format!("{}\n{details}\nreplay: {}", job.failures.join("\n"), run.replay));
        }
        let mut case = TestCase::new(job.name.as_str(), status);
        case.set_classname("afu.cosim");
        case.set_time(Duration::from_secs_f64(tally.host_seconds.max(0.0)));
        suite.add_test_case(case);
    }
    let mut report = Report::new("contact-afu");
    report.add_test_suite(suite);
    Ok(report.to_string()?)
}

#[cfg(test)]
mod tests {
    use super::super::cosim::{Job, Run};
    use super::super::tally::Tally;
    use super::*;

    #[test]
    fn a_mismatch_is_a_failed_case() {
        let job = |name: &str, mismatches, failures: &[&str]| Job {
            name: name.to_owned(),
            tally: Tally { pairs: 5, mismatches, ..Tally::default() },
            failures: failures.iter().map(|text| (*text).to_owned()).collect(),
            mismatches: vec![],
        };
        let run = Run {
            config: crate::config::Config::default(),
            seed: 9,
            replay: "afu cosim --seed 9".into(),
            tools: Default::default(),
            rtl_sha256: String::new(),
            link: "ideal".into(),
            jobs: vec![job("good.csv", 0, &[]), job("bad.csv", 2, &[]), job("late.csv", 0, &["did not finish"])],
        };
        let xml = xml(&run, &[String::new(), "pair 3 <differs>".into()]).expect("written");
        assert!(xml.contains(r#"tests="3""#) && xml.contains(r#"failures="2""#), "{xml}");
        assert!(xml.contains("2 of 5 records differ") && xml.contains("pair 3 &lt;differs&gt;"), "{xml}");
        assert!(xml.contains("did not finish"), "{xml}");
        assert!(xml.contains("replay: afu cosim --seed 9"), "{xml}");
    }
}
