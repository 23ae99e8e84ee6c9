//! The report of `afu cosim --input spheres`.

use serde::Serialize;

use super::{Run, percent};
use crate::report::table::{counted, figure, grouped, table};
use crate::verify::SpheresVerdict;

/// One job: its spheres, and the verdict on it or why there is none.
#[derive(Clone, Debug)]
pub struct SpheresJob {
    /// The spheres: a set's name, or a file.
    pub name: String,
    /// The verdict, or why the job did not finish.
    pub verdict: Result<SpheresVerdict, String>,
}

#[derive(Serialize)]
struct JobFigures<'a> {
    name: &'a str,
    passed: bool,
    failures: Vec<String>,
    #[serde(flatten)]
    figures: Option<Figures<'a>>,
}

#[derive(Serialize)]
struct Figures<'a> {
    spheres: u64,
    jobs: u64,
    invalid: u32,
    candidates: u64,
    contacts: u32,
    mismatches: u64,
    cycles: u64,
    cycles_per_sphere: Option<f64>,
    ns_per_sphere: Option<f64>,
    link: LinkFigures<'a>,
    host_seconds: f64,
}

#[derive(Serialize)]
struct LinkFigures<'a> {
    name: &'a str,
    bytes_read: u64,
    bytes_written: u64,
    efficiency: f64,
}

/// A quotient by a number of spheres; `None` without spheres.
fn each(value: f64, verdict: &SpheresVerdict) -> Option<f64> {
    (verdict.spheres > 0).then(|| value / verdict.spheres as f64)
}

impl SpheresJob {
    /// What failed; empty if all checks passed.
    pub fn failures(&self) -> Vec<String> {
        match &self.verdict {
            Ok(verdict) => verdict.failed_checks.clone(),
            Err(failure) => vec![failure.clone()],
        }
    }
}

impl Run<SpheresJob> {
    /// The jobs that failed.
    pub fn bad(&self) -> Vec<&str> {
        self.jobs.iter().filter(|job| !job.failures().is_empty()).map(|job| job.name.as_str()).collect()
    }

    /// The verdict: a line that begins with PASS or FAIL.
    pub fn verdict(&self) -> String {
        let (jobs, bad) = (counted(self.jobs.len() as u64, "job"), self.bad());
        if bad.is_empty() {
            let spheres =
                self.jobs.iter().filter_map(|job| job.verdict.as_ref().ok()).map(|verdict| verdict.spheres).sum();
            format!("PASS: {jobs}, {}, every contact as in software", counted(spheres, "sphere"))
        } else {
            format!("FAIL: {} of {jobs}: {}", bad.len(), bad.join(", "))
        }
    }

    /// The table for people: what ran, then one column per job.
    pub fn table(&self) -> String {
        let ns = self.config.cycle_ns();
        type Show<'a> = Box<dyn Fn(&SpheresVerdict) -> String + 'a>;
        let rows: Vec<(&str, Show<'_>)> = vec![
            ("spheres", Box::new(|v| grouped(v.spheres))),
            ("jobs of tiles", Box::new(|v| grouped(v.jobs))),
            ("invalid spheres", Box::new(|v| grouped(v.outcome.invalid.into()))),
            ("candidates: boxes that meet", Box::new(|v| grouped(v.outcome.candidates.unwrap_or_default().into()))),
            ("contacts", Box::new(|v| grouped(v.outcome.contacts.into()))),
            ("mismatches with the software", Box::new(|v| grouped(v.mismatches))),
            ("cycles", Box::new(|v| grouped(v.outcome.cycles))),
            ("cycles per sphere", Box::new(|v| figure(each(v.outcome.cycles as f64, v), 3))),
            ("ns per sphere", Box::new(move |v| figure(each(v.outcome.cycles as f64 * ns, v), 2))),
            ("share of the link limit", Box::new(|v| percent(Some(v.outcome.efficiency())))),
            ("bytes per sphere, in", Box::new(|v| figure(each(v.outcome.bytes_read as f64, v), 2))),
            ("bytes per sphere, out", Box::new(|v| figure(each(v.outcome.bytes_written as f64, v), 2))),
            ("simulation time, seconds", Box::new(|v| format!("{:.1}", v.seconds))),
        ];
        let is_cut = self.jobs.iter().filter_map(|job| job.verdict.as_ref().ok()).any(|verdict| verdict.jobs > 1);
        let rows = rows.into_iter().filter(|(title, _)| is_cut || *title != "jobs of tiles");
        let heading: Vec<&str> = [""].into_iter().chain(self.jobs.iter().map(|job| job.name.as_str())).collect();
        let cell = |show: &Show<'_>, job: &SpheresJob| job.verdict.as_ref().map_or_else(|_| "-".to_owned(), show);
        let row = |(title, show): (&str, Show<'_>)| {
            [title.to_owned()].into_iter().chain(self.jobs.iter().map(|job| cell(&show, job))).collect::<Vec<_>>()
        };
        let (c, search) = (&self.config, &self.config.search);
        let title = format!(
            "table of {} spheres, {} lanes, {}, boxes of {} bits, {} arithmetic, {} MHz; link {}, seed {}",
            grouped(search.table.into()),
            search.lanes,
            counted(search.deciders.into(), "decider"),
            search.box_bits,
            c.profile,
            c.clock_mhz,
            self.link,
            self.seed
        );
        format!("{title}\n{}", table(&heading, rows.map(row)))
    }

    /// The report for programs.
    pub fn json(&self) -> impl Serialize {
        let ns = self.config.cycle_ns();
        let figures = |verdict: &SpheresVerdict| {
            let outcome = &verdict.outcome;
            let cycles = outcome.cycles as f64;
            Figures {
                spheres: verdict.spheres,
                jobs: verdict.jobs,
                invalid: outcome.invalid,
                candidates: outcome.candidates.unwrap_or_default().into(),
                contacts: outcome.contacts,
                mismatches: verdict.mismatches,
                cycles: outcome.cycles,
                cycles_per_sphere: each(cycles, verdict),
                ns_per_sphere: each(cycles * ns, verdict),
                link: LinkFigures {
                    name: &self.link,
                    bytes_read: outcome.bytes_read,
                    bytes_written: outcome.bytes_written,
                    efficiency: outcome.efficiency(),
                },
                host_seconds: verdict.seconds,
            }
        };
        let job =
            |job: &'_ SpheresJob| job.failures().into_iter().map(|text| format!("{}: {text}", job.name)).collect();
        let failures: Vec<Vec<String>> = self.jobs.iter().map(job).collect();
        let jobs = self.jobs.iter().map(|job| JobFigures {
            name: &job.name,
            passed: job.failures().is_empty(),
            failures: job.failures(),
            figures: job.verdict.as_ref().ok().map(figures),
        });
        self.document(failures.concat(), None::<()>, jobs.collect())
    }
}
