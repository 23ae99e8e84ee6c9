//! The core's ports for its host: the inputs that start a job, and the outputs of a job.

use super::interface;
use crate::afu::{ADDRESS_BITS, EPOCH_BITS, Spec};
use crate::config::{Input, Results};
use crate::record::{COUNT_BITS, Capability, JobError};

/// Bits of `mode`.
const MODE_BITS: u32 = 4;
/// Bits of a cycle counter.
const CYCLE_BITS: u32 = 64;

interface! {
    /// The inputs that start and stop a job.
    JobInputs(spec) {
        start: T => 1, "one cycle high starts a job; ignored while busy";
        source: T => ADDRESS_BITS, "line address of the first source line";
        destination: T => ADDRESS_BITS, "line address of the first destination line";
        destination_lines: Option<T> => COUNT_BITS,
            "lines there is room for at the destination; those beyond are not written",
            if spec.config.results == Results::Hits;
        count: T => COUNT_BITS, match spec.config.input {
            Input::Direct => "pairs of the job; 0 is a job",
            Input::Spheres => "spheres of the first set, at most as many as the table holds; 0 is a job",
        };
        others: Option<T> => COUNT_BITS, "spheres of the second set, at most 65 536",
            if spec.config.input == Input::Spheres;
        mode: T => MODE_BITS, match spec.config.input {
            Input::Direct => format!("0; anything else ends the job with error {}", JobError::Mode.code()),
            Input::Spheres => format!(
                "0: one set, each pair once; 1: the first set against the second; 2: the first set of the last job, \
                 which is still in the table, against the second; anything else ends the job with error {}",
                JobError::Mode.code()
            ),
        };
        epoch: T => EPOCH_BITS,
            "upper part of the job's tags: change it from job to job, so that late responses are known";
        watchdog: T => COUNT_BITS, format!(
            "cycles without a response, while a request stands on the port or waits for its response, that end the job \
             with error {}; 0: never, but for an aborted or failed job, which ends after 65 536 such cycles",
            JobError::Watchdog.code()
        );
        abort_job: T => 1, format!(
            "high ends the job with error {}, when every outstanding request has its response; `watchdog` says what ends \
             it if one never comes",
            JobError::Aborted.code()
        );
    }
}

interface! {
    /// The outputs about a job and about the AFU.
    JobOutputs(spec) {
        busy: T => 1, "a job is running or ending";
        done: T => 1, "the last job has ended; low from the next start on";
        error: T => JobError::BITS, errors(spec);
        contacts: T => COUNT_BITS, match spec.config.results {
            Results::All => "contacts of the job so far",
            Results::Hits if spec.config.input == Input::Spheres => {
                "contacts of the job so far: as many records, each beginning with the numbers of two spheres"
            }
            Results::Hits => "contacts of the job so far: as many records, each beginning with its pair's number",
        };
        candidates: Option<T> => COUNT_BITS, "pairs of spheres of the job so far whose boxes meet",
            if spec.config.input == Input::Spheres;
        invalid: T => COUNT_BITS, match spec.config.input {
            Input::Direct => "invalid pairs of the job so far",
            Input::Spheres => "invalid spheres of the job so far",
        };
        first_invalid: T => COUNT_BITS, match spec.config.input {
            Input::Direct => "number of the first invalid pair, all ones if there is none",
            Input::Spheres => "number of the first invalid sphere, counted through both sets, all ones if there is none",
        };
        cycles_busy: T => CYCLE_BITS, "cycles of the job so far";
        cycles_input: T => CYCLE_BITS, match spec.config.input {
            Input::Direct => "of these, cycles in which the SCPUs waited for pairs",
            Input::Spheres => "of these, cycles in which no line of spheres was there",
        };
        cycles_output: T => CYCLE_BITS, match spec.config.input {
            Input::Direct => "of these, cycles in which pairs waited for room for their results",
            Input::Spheres => "of these, cycles in which hits waited for room in a line",
        };
        capability: T => 64, capability(spec);
    }
}

/// The errors that this core can report.
fn errors(spec: &Spec) -> String {
    let is_told = |error: &JobError| match error {
        JobError::Room => false,
        JobError::Table => spec.config.input == Input::Spheres,
        JobError::Overflow => spec.config.results == Results::Hits,
        _ => true,
    };
    let errors = JobError::ALL.into_iter().filter(is_told);
    let list: String = errors.map(|error| format!(", {} {}", error.code(), error.what())).collect();
    format!("how: 0 well{list}")
}

fn capability(spec: &Spec) -> String {
    Capability::describe(Capability::new(&spec.config, 0).bits())
}
